"""Text with one row a sample, or an edge: a header such as ``time [s];M_s [V]``, then numbers with point or comma."""

import contextlib
import gzip
import io
import zlib
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import IO, TextIO, cast

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Times
from shaftprint.recording._recording import Recording, sha256_of
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers import can
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._time_scale import TimeScale, expect_time_unit, time_scale
from shaftprint.recording.readers.csv._dates import dates, has_offset, seconds_from
from shaftprint.recording.readers.csv._edge_list import edge_channels
from shaftprint.recording.readers.csv._header import (
    WHITE_SPACE,
    Header,
    looks_like_a_table,
    read_header,
    split_row,
)
from shaftprint.recording.readers.csv._wrong_rows import is_number, wrong_rows

NAME = "CSV"

_ENDINGS = (".csv", ".tsv", ".txt", ".asc", ".lvm")
_GZIP = b"\x1f\x8b"
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
_FIRST_BYTES = 4096
# printed times are rounded
_RATE_AGREEMENT = 1e-3
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
    if (b"\0" in begin and not begin.startswith(_UTF_16)) or can.is_mine(path):
        return False
    if name.suffix.lower() in _ENDINGS:
        return True
    lines = begin.decode("utf-8-sig", "replace").splitlines()
    return looks_like_a_table(lines[:-1])


def read(path: Path, **hints: object) -> Recording:
    """Read a text file, packed with gzip or not, into temporary files, one a column; closing deletes them.

    Hints: ``columns``, titles such as ``time [s],M_s [N m]``, where the file has none or others; ``sample_rate_hz``
    where it has no times; ``time_unit`` of a column of times without a unit; ``delimiter`` and ``decimal`` where it
    leaves them open; ``encoding`` if it is not UTF-8.
    Empty fields become values that are not numbers. A list of edges becomes pulses.

    Raises
    ------
    RecordingError
        If header, a row or the clock cannot be used.
    """
    texts = ("columns", "delimiter", "decimal", "encoding", "time_unit")
    rate_hz = rate_hint(path, hints, dict.fromkeys(texts, str))
    time_unit = expect_time_unit(path, hints.get("time_unit"))
    encoding = cast(str, hints.get("encoding", _encoding(path)))
    try:
        with _text(path, encoding) as file:
            header = read_header(
                path,
                list(islice(_lines(path, file), _FIRST_ROWS)),
                delimiter=cast("str | None", hints.get("delimiter")),
                decimal=cast("str | None", hints.get("decimal")),
                columns=cast("str | None", hints.get("columns")),
                has_rate=rate_hz is not None,
            )
        spool = Spool(path, header.names)
        try:
            with _text(path, encoding) as file:
                count, began = _unpack(path, file, header, spool)
            return _recording(path, header, spool, count, began, rate_hz, time_unit)
        except BaseException:
            spool.close()
            raise
    except (UnicodeError, LookupError) as error:
        raise RecordingError(
            f"{path}: expected text in {encoding}, found {error}; pass encoding= (--encoding of shaftprint convert)."
        ) from None
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
    count, first_line = 0, header.lines + 1
    began: np.datetime64 | None = None
    in_utc = False
    while lines := file.readlines(_BLOCK_CHARACTERS):
        if header.decimal == ",":
            lines = [line.replace(",", ".") for line in lines]
        numbers = [number for number, line in enumerate(lines, start=first_line) if not line.isspace()]
        rows = [line for line in lines if not line.isspace()]
        first_line += len(lines)
        if header.dated and rows:
            rows, dates, in_utc = _without_dates(path, rows, header)
            began = dates[0] if began is None else began
        block = _numbers(path, rows, header, numbers)
        if began is not None and rows:
            block[:, header.time_column] = seconds_from(began, dates)
        spool.append(block)
        count += block.shape[0]
    spool.finish()
    date = None if began is None else cast("datetime", began.item())
    return count, date.replace(tzinfo=UTC) if date is not None and in_utc else date


def _without_dates(
    path: Path, rows: Sequence[str], header: Header
) -> "tuple[list[str], np.ndarray[tuple[int], np.dtype[np.datetime64]], bool]":
    """Return rows with zeros in place of their dates, the dates, and whether these are in UTC."""
    plain, texts = [], []
    time = cast(int, header.time_column)
    for row in rows:
        fields = split_row(row, header.delimiter)
        texts.append(fields[time].strip().strip('"') if time < len(fields) else "")
        fields[min(time, len(fields) - 1)] = "0"
        plain.append(header.delimiter.join(fields))
    return plain, dates(path, texts), has_offset(texts[0])


def _numbers(path: Path, lines: Sequence[str], header: Header, numbers: Sequence[int]) -> FloatArray:
    """Return rows of text as numbers, shape (rows, columns); slower where fields are empty.

    Parameters
    ----------
    numbers
        Number of each line in the file.
    """
    width = len(header.names)
    if not lines:
        return np.empty((0, width))
    try:
        block = _parse(lines, header.delimiter)
    except ValueError:
        rows = [split_row(line, header.delimiter) for line in lines]
        wrong = [row for row in zip(numbers, rows, strict=True) if not _is_whole(row[1], width)]
        if wrong:
            raise wrong_rows(path, wrong, header.names, time=header.time_column) from None
        block = np.array([[float(field.strip() or "nan") for field in row] for row in rows])
    if block.shape[1] != width:
        raise wrong_rows(path, [(numbers[0], split_row(lines[0], header.delimiter))], header.names)
    return block


def _is_whole(fields: Sequence[str], width: int) -> bool:
    return len(fields) == width and all(map(is_number, fields))


def _parse(lines: Sequence[str], delimiter: str) -> FloatArray:
    between = None if delimiter == WHITE_SPACE else delimiter
    return np.loadtxt(lines, dtype=np.float64, delimiter=between, comments=None, ndmin=2)


def _time_scale(path: Path, header: Header, spool: Spool, count: int, asked: str) -> TimeScale:
    """Return what the numbers of the times mean; dates are seconds already."""
    if header.time_column is None or header.time_unit is None:
        return TimeScale()
    name = f"column {header.names[header.time_column]}"
    read = spool.source(header.time_column)
    return time_scale(path, name, count, read, unit=header.time_unit, asked=asked)


def _clock(path: Path, header: Header, read: Times | None, count: int, rate_hz: float | None) -> SampleClock:
    """Return the clock of the times, or that of the rate which the caller knows."""
    if header.time_column is None or read is None:
        return SampleClock(rate_hz=cast(float, rate_hz), start_s=0.0)
    name = f"column {header.names[header.time_column]}"
    clock = clock_of_times(path, name, count, read)
    if rate_hz is not None and abs(clock.rate_hz / rate_hz - 1.0) > _RATE_AGREEMENT:
        raise RecordingError(
            f"{path}: expected one sample rate, found {clock.rate_hz:g} Hz in {name} and {rate_hz:g} Hz in the hint."
        )
    return clock


def _recording(
    path: Path,
    header: Header,
    spool: Spool,
    count: int,
    began: datetime | None,
    rate_hz: float | None,
    time_unit: str,
) -> Recording:
    scale = _time_scale(path, header, spool, count, time_unit)
    read = None if header.time_column is None else scale.reading(spool.source(header.time_column))
    edges = edge_channels(path, header, spool, count, read) if rate_hz is None else None
    channels = _sampled(path, header, spool, count, rate_hz, read) if edges is None else edges
    return Recording(
        path=path,
        sha256=sha256_of(path),
        format=NAME if edges is None else f"{NAME}, list of edges",
        channels=channels,
        began=began or scale.began,
        remarks=(scale.remark,) if scale.remark else (),
        release=spool.close,
    )


def _sampled(
    path: Path, header: Header, spool: Spool, count: int, rate_hz: float | None, read: Times | None
) -> dict[str, Channel]:
    """Return the columns as channels with one row a sample."""
    clock = _clock(path, header, read, count, rate_hz)
    return {
        name: on_clock(
            Channel(
                name=name,
                unit=unit,
                rate_hz=clock.rate_hz,
                start_s=clock.start_s,
                count=count,
                source=spool.source(number),
            ),
            clock,
        )
        for number, (name, unit) in enumerate(zip(header.names, header.units, strict=True))
        if number != header.time_column
    }
