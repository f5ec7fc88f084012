"""Text with one row a sample: a header such as ``time [s];M_s [V]``, then numbers with point or comma."""

from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import TextIO, cast

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._recording import Channel, Recording, sha256_of
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import uniform_clock
from shaftprint.recording.readers._csv_header import TIME, Header, read_header
from shaftprint.recording.readers._hints import expect_hints

NAME = "CSV"

_ENDINGS = (".csv", ".tsv", ".txt")
_FIRST_ROWS = 1000
_BLOCK_CHARACTERS = 8_000_000


def is_mine(path: Path) -> bool:
    """Return whether the file name ends as one of a text file."""
    return path.suffix.lower() in _ENDINGS


def read(path: Path, **hints: object) -> Recording:
    """Read a text file into temporary files, one a column; they are deleted when it is closed.

    Hints: ``delimiter`` and ``decimal`` where the file leaves it open, ``encoding`` if it is not UTF-8.
    Empty fields become values that are not numbers.

    Raises
    ------
    RecordingError
        If header, a row or the clock cannot be used.
    """
    expect_hints(path, hints, {"delimiter": str, "decimal": str, "encoding": str})
    encoding = cast(str, hints.get("encoding", "utf-8-sig"))
    try:
        with path.open(encoding=encoding) as file:
            line, rows = file.readline(), list(islice(file, _FIRST_ROWS))
        header = read_header(
            path,
            line,
            rows,
            delimiter=cast("str | None", hints.get("delimiter")),
            decimal=cast("str | None", hints.get("decimal")),
        )
        spool = Spool(path, header.names)
        try:
            with path.open(encoding=encoding) as file:
                count = _unpack(path, file, header, spool)
            return _recording(path, header, spool, count)
        except BaseException:
            spool.close()
            raise
    except (UnicodeDecodeError, LookupError) as error:
        raise RecordingError(f"{path}: expected text in {encoding}, found {error}; pass encoding=.") from None


def _unpack(path: Path, file: TextIO, header: Header, spool: Spool) -> int:
    """Put every row into the columns and return how many there are."""
    file.readline()
    count = 0
    while lines := file.readlines(_BLOCK_CHARACTERS):
        if header.decimal == ",":
            lines = [line.replace(",", ".") for line in lines]
        block = _numbers(path, [line for line in lines if not line.isspace()], header, count)
        spool.append(block)
        count += block.shape[0]
    spool.finish()
    return count


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


def _recording(path: Path, header: Header, spool: Spool, count: int) -> Recording:
    time = header.time_column
    clock = uniform_clock(path, f"column {TIME}", count, spool.source(time))
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
    return Recording(path=path, sha256=sha256_of(path), format=NAME, channels=channels, release=spool.close)
