"""Text with one row a sample, or an edge: a header such as ``time [s];M_s [V]``, then numbers with point or comma."""

import contextlib
import io
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from itertools import islice
from pathlib import Path
from typing import IO, TextIO, cast

from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._recording import Recording, sha256_of
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers import _uff
from shaftprint.recording.readers._gather import reasons_in_words
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._packed import CANNOT_BE_UNPACKED, damaged_gzip, first_bytes, open_unpacked
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._unread import what_lines_are
from shaftprint.recording.readers.can._log import begins_as_log
from shaftprint.recording.readers.csv._dates import dates, has_offset, is_date
from shaftprint.recording.readers.csv._edge_list import edge_channels
from shaftprint.recording.readers.csv._header import Header, looks_like_a_table, read_header
from shaftprint.recording.readers.csv._long_form import expect_no_frames
from shaftprint.recording.readers.csv._marks import first_row_of_zeros
from shaftprint.recording.readers.csv._row_clocks import sampled, scale_of_rows
from shaftprint.recording.readers.csv._rows import LONGEST_LINE, Unpacked, unpack
from shaftprint.recording.readers.csv._validity import invalid_rows
from shaftprint.recording.readers.imc._blocks import BEGIN as BEGIN_OF_IMC

NAME = "CSV"

_ENDINGS = (".csv", ".tsv", ".txt", ".asc", ".lvm")
_UTF_16 = (b"\xff\xfe", b"\xfe\xff")
# the first two bytes of a mark are those of UTF-16
_UTF_32 = (b"\xff\xfe\0\0", b"\0\0\xfe\xff")
# text with a grammar of its own
_LABVIEW = b"LabVIEW Measurement"
# no row of a table begins so; a fingerprint or the truth of a simulated recording does
_JSON = b"{"
_WINDOWS = "cp1252"
_SEEN = 65_536
_FIRST_ROWS, _SHOWN = 1000, 5
# Where a name does not say that a file is text: so many lines.
_HEAD = 100


def is_mine(path: Path) -> bool:
    """Return whether the file is text, packed or not, that ends as a text file or begins as a table."""
    name = path.with_suffix("") if path.suffix.lower() == ".gz" else path
    begin = first_bytes(path)
    if begin is None:
        # too damaged to tell: the name decides
        return name.suffix.lower() in _ENDINGS
    if begin.startswith((_LABVIEW, _JSON, BEGIN_OF_IMC)) or begins_as_log(path, begin) or _uff.is_mine(path):
        return False
    # a logger that lost its supply leaves NUL bytes behind its rows
    if b"\0" in begin.rstrip(b"\0") and not begin.startswith((*_UTF_16, *_UTF_32)):
        return False
    if name.suffix.lower() in _ENDINGS:
        return True
    return _begins_as_table(begin) or _begins_as_table(first_bytes(path, _SEEN) or b"")


def _begins_as_table(content: bytes) -> bool:
    return looks_like_a_table(content.decode("utf-8-sig", "replace").splitlines()[:-1][:_HEAD])


def read(path: Path, **hints: object) -> Recording:
    """Read a text file, packed with gzip or not, into temporary files, one a column; closing deletes them.

    Hints: ``columns``, titles such as ``time [s],M_s [N m]``, where the file has none or others; ``sample_rate_hz``
    where it has no times; ``time_unit`` of a column of times without a unit; ``delimiter`` and ``decimal`` where it
    leaves them open; ``encoding`` if it is not UTF-8.
    Empty fields become values that are not numbers. A list of edges becomes pulses.

    Raises RecordingError if header, a row or the clock cannot be used.
    """
    expect_no_frames(path, (first_bytes(path) or b"").decode("utf-8", "replace").splitlines())
    lines = what_lines_are(first_bytes(path) or b"")
    if lines:
        raise RecordingError(f"{path}: expected columns of values, found {lines}.")
    texts = ("columns", "delimiter", "decimal", "encoding", "time_unit")
    rate_hz = rate_hint(path, hints, dict.fromkeys(texts, str))
    time_unit = expect_time_unit(path, hints.get("time_unit"))
    encoding, guessed = _encoding(path) if hints.get("encoding") is None else (cast(str, hints["encoding"]), "")
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
        with kept_open(Spool(path, header.names)) as spool:
            # the hash takes as long as the reading: both at once
            with _numbers(path, encoding) as content, ThreadPoolExecutor(1) as pool:
                digest = pool.submit(sha256_of, path)
                done = unpack(path, content, header, spool)
                sha256 = digest.result()
            if 0 < done.full < done.count and done.stamps is None:
                done.remarks.append(f"{done.count - done.full} rows at the end without any value were left out.")
                done.count = done.full
            done.remarks += [guessed] if guessed else []
            if header.status:
                read = {name: number for number, name in enumerate(header.names)}
                with _text(path, encoding) as file:
                    rows = islice(_lines(path, file), header.lines, None)
                    done.invalid = invalid_rows(
                        rows, header.delimiter, header.status, read, header.titles, spool, done.count, done.left_out
                    )
            return _recording(path, sha256, header, spool, done, rate_hz or header.rate_hz, time_unit)
    except (UnicodeError, LookupError) as error:
        raise RecordingError(
            f"{path}: expected text in {encoding}, found {error}; pass encoding= (--encoding, such as cp1252)."
        ) from None
    except CANNOT_BE_UNPACKED as error:
        raise damaged_gzip(path, error) from None


@contextlib.contextmanager
def _text(path: Path, encoding: str) -> Iterator[TextIO]:
    with open_unpacked(path) as binary, io.TextIOWrapper(binary, encoding=encoding) as text:
        yield text


@contextlib.contextmanager
def _numbers(path: Path, encoding: str) -> Iterator[IO[bytes]]:
    """Open a file as bytes whose digits and line ends are those of ASCII."""
    with open_unpacked(path) as binary:
        begin = binary.read(_SEEN)
        binary.seek(0)
        has_line_feeds = begin.count(b"\r") == begin.count(b"\r\n")
        if has_line_feeds and "12;".encode(encoding).endswith(b"12;"):
            yield binary
            return
        with io.TextIOWrapper(binary, encoding=encoding) as text:
            yield cast("IO[bytes]", io.BufferedReader(_InUtf8(text), _SEEN))


class _InUtf8(io.RawIOBase):
    """Text as UTF-8 with line feeds."""

    def __init__(self, text: TextIO) -> None:
        self._text, self._rest = text, b""

    def readable(self) -> bool:
        """Return that it can be read."""
        return True

    def readinto(self, target: "memoryview") -> int:  # type: ignore[override]
        """Fill a piece of memory; return how many bytes there were."""
        self._rest = self._rest or self._text.read(_SEEN).encode()
        count = min(len(target), len(self._rest))
        target[:count], self._rest = self._rest[:count], self._rest[count:]
        return count


def _encoding(path: Path) -> tuple[str, str]:
    """Return the encoding that a file has by its mark or its first lines, and what has to be said of that."""
    try:
        with open_unpacked(path) as file:
            begin = b"".join(islice(iter(lambda: file.readline(LONGEST_LINE), b""), _FIRST_ROWS))
    except CANNOT_BE_UNPACKED:
        return "utf-8-sig", ""
    if begin[:4] in _UTF_32:
        return "utf-32", ""
    if begin[:2] in _UTF_16:
        return "utf-16", ""
    try:
        begin.decode("utf-8-sig")
    except UnicodeDecodeError:
        return _WINDOWS, f"The text is no UTF-8 and was read as {_WINDOWS} (--encoding)."
    return "utf-8-sig", ""


def _lines(path: Path, file: TextIO) -> Iterator[str]:
    """Yield lines, and refuse one without an end: a binary file, perhaps."""
    while line := file.readline(LONGEST_LINE):
        if len(line) == LONGEST_LINE:
            raise RecordingError(f"{path}: expected lines of text, found one of over {LONGEST_LINE} characters.")
        yield line


def _recording(
    path: Path, sha256: str, header: Header, spool: Spool, done: Unpacked, rate_hz: float | None, time_unit: str
) -> Recording:
    scale = scale_of_rows(path, header, spool, done.count, time_unit)
    read = None if header.time_column is None else scale.reading(spool.source(header.time_column))
    edges = edge_channels(path, header, spool, done.count, read) if rate_hz is None else None
    left_out = {**header.left_out, **done.left_out}
    channels, remarks = edges, list[str]()
    if channels is None:
        channels, remarks = sampled(path, header, spool, done, rate_hz, scale, time_unit, left_out)
    left_out |= {name: "it has no value in any row" for name in done.empty if name in channels}
    channels = {name: channel for name, channel in channels.items() if name not in left_out}
    if not channels:
        reasons = reasons_in_words(left_out, most=_SHOWN)
        raise RecordingError(
            f"{path}: expected a channel with numbers, found none in {done.count} rows: {reasons} (numbers from 9.9e37 "
            "on stand for an overload)."
        )
    recording = Recording(
        path=path,
        sha256=sha256,
        format=NAME if edges is None else f"{NAME}, list of edges",
        channels=channels,
        left_out=left_out,
        began=(scale.began or header.began) if done.stamps is None else done.stamps.began,
        remarks=tuple(one for one in (*header.remarks, scale.remark, *remarks, *done.remarks) if one),
        release=spool.close,
    )
    return _with_more(recording, header, done)


def _with_more(recording: Recording, header: Header, done: Unpacked) -> Recording:
    """Return a recording with what is said of a clock without a date, and of titles that come again."""
    remarks, began = list(recording.remarks), recording.began
    if done.stamps is not None and done.stamps.day_time_s is not None:
        stated = done.stamps.ambiguous_date
        of_day = f"{stated}, of which day and month cannot be told apart" if stated else "a day that is not said"
        remarks.append(f"Second 0 is {timedelta(seconds=round(done.stamps.day_time_s, 6))} of {of_day}.")
    first = next(iter(recording.channels.values()), None)
    for line, row in done.titles_again:
        if first is None:
            break
        end_s = first.start_s + row / first.rate_hz
        remarks.append(
            f"Line {line}: the titles come again, the program was started anew; what is before it ends at second "
            f"{end_s:.9g} (--to {end_s:.9g})."
        )
    zeros = first_row_of_zeros(list(recording.channels.values()))
    remarks += [zeros] if zeros else []
    if began is None and first is not None and is_date(done.date_beside):
        day = cast("datetime", dates(recording.path, [done.date_beside])[0].item())
        began = (day.replace(tzinfo=UTC) if has_offset(done.date_beside) else day) - timedelta(seconds=first.start_s)
    return replace(recording, remarks=tuple(remarks), began=began)
