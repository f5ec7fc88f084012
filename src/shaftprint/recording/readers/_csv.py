"""Text with one row a sample: a header such as ``time [s];M_s [V]``, then numbers with point or comma."""

import contextlib
import gzip
import io
import zlib
from collections.abc import Iterator, Sequence
from datetime import datetime
from itertools import islice
from pathlib import Path
from typing import IO, TextIO, cast

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording, sha256_of
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import uniform_clock
from shaftprint.recording.readers._csv_dates import dates, seconds_from
from shaftprint.recording.readers._csv_header import Header, looks_like_a_table, read_header
from shaftprint.recording.readers._epoch import from_second_zero
from shaftprint.recording.readers._hints import expect_hints

NAME = "CSV"

_ENDINGS = (".csv", ".tsv", ".txt", ".asc")
_GZIP = b"\x1f\x8b"
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_FIRST_BYTES = 4096
_FIRST_ROWS = 1000
_LONGEST_LINE = 1_000_000
_BLOCK_CHARACTERS = 8_000_000


def is_mine(path: Path) -> bool:
    """Return whether the file is text, packed or not, that ends as a text file or begins as a table."""
    name = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    try:
        with _binary(path) as file:
            begin = file.read(_FIRST_BYTES)
    except (EOFError, zlib.error, gzip.BadGzipFile):
        # too damaged to tell: the name decides
        return name.suffix.lower() in _ENDINGS
    if b"\0" in begin and not begin.startswith(_UTF_16):
        return False
    if name.suffix.lower() in _ENDINGS:
        return True
    lines = begin.decode("utf-8-sig", "replace").splitlines()
    return looks_like_a_table(lines[:-1])


def read(path: Path, **hints: object) -> Recording:
    """Read a text file, packed with gzip or not, into temporary files, one a column; closing deletes them.

    Hints: ``delimiter`` and ``decimal`` where the file leaves it open, ``encoding`` if it is not UTF-8.
    Empty fields become values that are not numbers.

    Raises
    ------
    RecordingError
        If header, a row or the clock cannot be used.
    """
    expect_hints(path, hints, {"delimiter": str, "decimal": str, "encoding": str})
    encoding = cast(str, hints.get("encoding", _encoding(path)))
    try:
        with _text(path, encoding) as file:
            header = read_header(
                path,
                list(islice(_lines(path, file), _FIRST_ROWS)),
                delimiter=cast("str | None", hints.get("delimiter")),
                decimal=cast("str | None", hints.get("decimal")),
            )
        spool = Spool(path, header.names)
        try:
            with _text(path, encoding) as file:
                count, began = _unpack(path, file, header, spool)
            return _recording(path, header, spool, count, began)
        except BaseException:
            spool.close()
            raise
    except (UnicodeError, LookupError) as error:
        raise RecordingError(f"{path}: expected text in {encoding}, found {error}; pass encoding=.") from None
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise RecordingError(
            f"{path}: expected a whole gzip file, found a damaged or truncated one ({error})."
        ) from None


def _binary(path: Path) -> IO[bytes]:
    with path.open("rb") as file:
        packed = file.read(len(_GZIP)) == _GZIP
    return cast("IO[bytes]", gzip.open(path, "rb")) if packed else path.open("rb")


@contextlib.contextmanager
def _text(path: Path, encoding: str) -> Iterator[TextIO]:
    with _binary(path) as binary, io.TextIOWrapper(binary, encoding=encoding) as text:
        yield text


def _encoding(path: Path) -> str:
    try:
        with _binary(path) as file:
            return "utf-16" if file.read(2) in _UTF_16 else "utf-8-sig"
    except (EOFError, zlib.error, gzip.BadGzipFile):
        return "utf-8-sig"


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    """Yield lines, and refuse one without an end: a binary file, perhaps."""
    while line := file.readline(_LONGEST_LINE):
        if len(line) == _LONGEST_LINE:
            raise RecordingError(f"{path}: expected lines of text, found one of over {_LONGEST_LINE} characters.")
        yield line


def _unpack(path: Path, file: TextIO, header: Header, spool: Spool) -> tuple[int, datetime | None]:
    """Put every row into the columns; return how many there are and the date of the first, where rows have dates."""
    for _ in range(header.lines):
        file.readline()
    count = 0
    began: np.datetime64 | None = None
    while lines := file.readlines(_BLOCK_CHARACTERS):
        if header.decimal == ",":
            lines = [line.replace(",", ".") for line in lines]
        rows = [line for line in lines if not line.isspace()]
        if header.second is None and rows:
            rows, found = _without_dates(path, rows, header)
            began = found[0] if began is None else began
        block = _numbers(path, rows, header, count)
        if header.second is None and began is not None and rows:
            block[:, header.time_column] = seconds_from(began, found)
        elif header.second not in (None, 1.0):
            block[:, header.time_column] *= header.second
        spool.append(block)
        count += block.shape[0]
    spool.finish()
    return count, None if began is None else cast("datetime", began.item())


def _without_dates(
    path: Path, rows: Sequence[str], header: Header
) -> "tuple[list[str], np.ndarray[tuple[int], np.dtype[np.datetime64]]]":
    """Return rows with zeros in place of their dates, and the dates."""
    plain, texts = [], []
    for row in rows:
        fields = row.rstrip("\r\n").split(header.delimiter)
        texts.append(fields[header.time_column].strip().strip('"') if header.time_column < len(fields) else "")
        fields[min(header.time_column, len(fields) - 1)] = "0"
        plain.append(header.delimiter.join(fields))
    return plain, dates(path, texts)


def _numbers(path: Path, lines: Sequence[str], header: Header, before: int) -> FloatArray:
    """Return rows of text as numbers, shape (rows, columns); slower where fields are empty."""
    width = len(header.names)
    if not lines:
        return np.empty((0, width))
    try:
        block = _parse(lines, header.delimiter)
    except ValueError:
        block = np.empty((len(lines), width))
        for number, line in enumerate(lines):
            fields = [field.strip() or "nan" for field in line.rstrip("\n").split(header.delimiter)]
            try:
                block[number] = _exactly(width, fields)
            except ValueError:
                raise RecordingError(
                    f"{path}, row {before + number + 1}: expected {width} numbers, "
                    f'found "{line.strip()[:80]}"; is the file cut off?'
                ) from None
    if block.shape[1] != width:
        raise RecordingError(
            f"{path}, row {before + 1}: expected {width} numbers, found {block.shape[1]}; "
            "is the decimal sign also the delimiter?"
        )
    return block


def _parse(lines: Sequence[str], delimiter: str) -> FloatArray:
    return np.loadtxt(lines, dtype=np.float64, delimiter=delimiter, comments=None, ndmin=2)


def _exactly(width: int, fields: Sequence[str]) -> list[float]:
    if len(fields) != width:
        raise ValueError(f"{len(fields)} fields")
    return [float(field) for field in fields]


def _recording(path: Path, header: Header, spool: Spool, count: int, began: datetime | None) -> Recording:
    time = header.time_column
    clock = uniform_clock(path, f"column {header.names[time]}", count, spool.source(time))
    channels = {
        name: Channel(
            name=name,
            unit=unit,
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=count,
            source=spool.source(number),
        )
        for number, (name, unit) in enumerate(zip(header.names, header.units, strict=True))
        if number != time
    }
    moved, epoch = from_second_zero(channels)
    return Recording(
        path=path, sha256=sha256_of(path), format=NAME, channels=moved, began=began or epoch, release=spool.close
    )
