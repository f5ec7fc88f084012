"""LabVIEW's measurement text (.lvm): a head, then one or more segments with a head, titles and rows of their own."""

import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel, Source
from shaftprint.recording._recording import Recording
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import on_clock
from shaftprint.recording.readers._epoch import LATER_THAN_ANY_TEST_S
from shaftprint.recording.readers._gather import Gathered, told_apart
from shaftprint.recording.readers._hints import OF_HINT, expect_one_rate, rate_hint
from shaftprint.recording.readers._packed import CANNOT_BE_UNPACKED, damaged_gzip, first_bytes, open_unpacked
from shaftprint.recording.readers._printed_rate import rate_of_step
from shaftprint.recording.readers._segment_clock import clock_of_segments
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._rows import LONGEST_LINE, Unpacked, unpack
from shaftprint.units import plain_unit

NAME = "LabVIEW LVM"

_MARK = b"LabVIEW Measurement"
_END_OF_HEAD, _SPECIAL, _END_OF_SPECIAL = "***End_of_Header***", "***Start_Special***", "***End_Special***"
_SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";", "space": " "}
_COMMENT = "comment"
_TIMES = "X_Value"
# Damaged counts may be longer than a text of digits that Python takes for a number.
_MOST_DIGITS = 18
_DATE = re.compile(r"(\d{4})[/.-](\d\d?)[/.-](\d\d?)")
_TIME = re.compile(r"(\d\d?):(\d\d):(\d\d)(?:[.,](\d+))?")


@dataclass(slots=True)
class _Segment:
    """Rows below one head."""

    head: dict[str, list[str]]
    titles: list[str]
    line: int
    begin: int
    end: int = 0
    count: int = 0


def is_mine(path: Path) -> bool:
    """Return whether the file begins as LabVIEW's text does."""
    return (first_bytes(path) or b"").startswith(_MARK)


def read(path: Path, **hints: object) -> Recording:
    """Read LabVIEW's text into temporary files, one a column; closing deletes them.

    Hints: ``sample_rate_hz``, where neither times nor a step are in the file. Comments and special blocks are left out.
    Segments follow each other by their times: what is missing between them becomes values that are not numbers.

    Raises RecordingError if a head or a row cannot be used.
    """
    rate_hz = rate_hint(path, hints)
    try:
        with open_unpacked(path) as file:
            general, separator, segments = _scanned(path, file)
            if not segments:
                raise RecordingError(f"{path}: expected segments with titles X_Value ..., found none.")
            with kept_open(Spool(path, [])) as spool:
                return _recording(path, file, general, separator, segments, spool, rate_hz)
    except CANNOT_BE_UNPACKED as error:
        raise damaged_gzip(path, error) from None


def _scanned(path: Path, file: IO[bytes]) -> tuple[dict[str, list[str]], str, list[_Segment]]:
    """Return the general head, what separates columns, and where the segments are."""
    general: dict[str, list[str]] = {}
    head: dict[str, list[str]] = {}
    segments: list[_Segment] = []
    separator, in_head, in_special, position, number = "\t", True, False, 0, 0
    while raw := file.readline(LONGEST_LINE):
        number += 1
        position += len(raw)
        is_row = raw[:1] in b"\t,;-+.0123456789" or not raw.strip()
        if is_row and not in_head and not in_special:
            continue
        line = _decoded(raw).strip("\r\n")
        fields = [one.strip() for one in line.split(separator)]
        if in_special or line.startswith(_SPECIAL):
            in_special = not line.startswith(_END_OF_SPECIAL)
        elif raw.startswith(_TIMES.encode()):
            _end_last(segments, position - len(raw))
            head = head or (segments[-1].head if segments else {})
            segments.append(_Segment(head=head, titles=fields, line=number, begin=position))
            head, in_head = {}, False
        elif line.startswith(_END_OF_HEAD):
            general = general or head
            head = {} if head is general else head
        elif fields[0]:
            _end_last(segments, position - len(raw))
            in_head = True
            head[fields[0]] = fields[1:]
            if line.startswith("Separator") and not general:
                separator = _SEPARATORS.get(re.split(r"[\t,; ]", line.strip("\t,; "))[-1].lower(), "\t")
    _end_last(segments, position)
    return general, separator, segments


def _end_last(segments: Sequence[_Segment], position: int) -> None:
    """Note where the last segment ends, unless that is known."""
    if segments and not segments[-1].end:
        segments[-1].end = position


def _decoded(raw: bytes) -> str:
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", "replace")


def _recording(
    path: Path,
    file: IO[bytes],
    general: Mapping[str, list[str]],
    separator: str,
    segments: list[_Segment],
    spool: Spool,
    hint_hz: float | None,
) -> Recording:
    titles = segments[0].titles
    other = next((segment for segment in segments if segment.titles != titles), None)
    if other is not None:
        raise RecordingError(
            f"{path}, line {other.line}: expected the titles of the first segment, found others; save each group of "
            "channels in a file of its own."
        )
    values = [place for place, title in enumerate(titles) if title.lower() not in ("x_value", _COMMENT, "")]
    places = sorted([*values, *(place for place, title in enumerate(titles) if title == _TIMES)])
    decimal = (general.get("Decimal_Separator") or [""])[0]
    header = Header(
        delimiter=separator,
        decimal=decimal if decimal in (",", ".") else _decimal(file, segments[0], separator),
        names=tuple(f"{titles[place]} {place}" for place in places),
        units=("",) * len(places),
        places=tuple(places),
        width=len(titles),
        lines=0,
        time_column=None,
        time_unit=None,
    )
    gathered = Gathered(path=path)
    columns = {place: spool.add_column(titles[place]) for place in places}
    wordy: dict[int, str] = {}
    for segment in segments:
        done = _rows(path, file, segment, header, spool)
        segment.count = done.count
        gathered.remarks.extend(done.remarks)
        said = max(
            (int(one) for one in segment.head.get("Samples", ()) if one.isdecimal() and len(one) <= _MOST_DIGITS),
            default=0,
        )
        if said > done.count:
            gathered.remarks.append(f"Line {segment.line}: {said} samples are said to follow, {done.count} do.")
        wordy = {places[header.names.index(name)]: reason for name, reason in done.left_out.items()} | wordy
    _note_comments(gathered, file, segments[0], separator)
    source = _Source(
        path=path,
        segments=tuple(segments),
        sources={place: spool.source(column) for place, column in columns.items()},
        wordy=wordy,
        hint_hz=hint_hz,
        remarks=gathered.remarks,
    )
    names = told_apart([printable(titles[place].replace("/", "|")) for place in values])
    for place, name in zip(values, names, strict=True):
        gathered.add(name, partial(source.channel, place, name))
    return gathered.recording(NAME, spool.close, _moment(segments[0].head, values[0] if values else 1))


def _decimal(file: IO[bytes], segment: _Segment, separator: str) -> str:
    """Return the decimal sign of the first rows, where no head says it."""
    file.seek(segment.begin)
    rows = file.read(min(segment.end - segment.begin, 4096))
    return "," if separator != "," and b"," in rows and b"." not in rows else "."


def _rows(path: Path, file: IO[bytes], segment: _Segment, header: Header, spool: Spool) -> Unpacked:
    file.seek(segment.begin)
    piece = io.BufferedReader(_Piece(file, segment.end - segment.begin))
    return unpack(path, piece, replace(header, first_line=segment.line + 1), spool)


class _Piece(io.RawIOBase):
    """The next bytes of a file, so many."""

    def __init__(self, file: IO[bytes], count: int) -> None:
        self._file, self._left = file, count

    def readable(self) -> bool:
        """Return that it can be read."""
        return True

    def readinto(self, target: "memoryview") -> int:  # type: ignore[override]
        """Fill a piece of memory; return how many bytes there were."""
        content = self._file.read(min(len(target), max(self._left, 0)))
        target[: len(content)] = content
        self._left -= len(content)
        return len(content)


def _note_comments(gathered: Gathered, file: IO[bytes], segment: _Segment, separator: str) -> None:
    if segment.titles[-1].lower() != _COMMENT:
        return
    file.seek(segment.begin)
    width = len(segment.titles)
    for raw in file.read(min(segment.end - segment.begin, 65_536)).splitlines():
        fields = _decoded(raw).split(separator)
        if len(fields) >= width and fields[width - 1].strip():
            gathered.left_out["Comment"] = f'it holds text, such as "{printable(fields[width - 1].strip())[:30]}"'
            return


@dataclass(frozen=True, kw_only=True, slots=True)
class _Source:
    """The unpacked segments of a file while its channels are gathered."""

    path: Path
    segments: Sequence[_Segment]
    sources: Mapping[int, Source]
    """What gives the rows of each column of the file."""
    wordy: Mapping[int, str]
    """Why columns are no numbers."""
    hint_hz: float | None
    remarks: list[str]

    def channel(self, place: int, name: str) -> Channel:
        """Return a channel with its segments one behind the other, each at its time."""
        head = self.segments[0].head
        titles = self.segments[0].titles
        times_place = max((before for before in range(place) if titles[before] == _TIMES), default=None)
        for column in (place, times_place):
            if column is not None and column in self.wordy:
                raise RecordingError(self.wordy[column])
        count = sum(segment.count for segment in self.segments)
        values = self.sources[place]
        has_value = np.isfinite(values(0, count))
        printed = None if times_place is None else self.sources[times_place](0, count)
        printed = printed if printed is not None and np.isfinite(printed).any() else None
        if not has_value.any():
            raise RecordingError("it has no value in any row")
        filled = self._filled(has_value if printed is None else np.isfinite(printed))
        rows = np.concatenate([np.arange(first, last) for first, last in filled])
        if printed is not None:
            printed = printed[rows]
        if rows.size < int(rows[-1]) + 1:
            values = partial(_picked, values, rows)
        rates = [rate_of_step(_of(segment.head, "Delta_X", place)) for segment in self.segments]
        rate_hz = self.hint_hz or rates[0]
        if printed is None and rate_hz is None:
            raise RecordingError("expected times or a Delta_X, found neither; pass sample_rate_hz= (--sample-rate)")
        if printed is None and any(rate is not None and rate != rates[0] for rate in rates):
            raise RecordingError("expected one Delta_X for all segments, found several")
        pieces = self._seconds(place, [stop - start for start, stop in filled], printed, rate_hz)
        clock = clock_of_segments(self.path, name, pieces, rate_hz, self.remarks)
        if self.hint_hz is not None:
            expect_one_rate(self.path, {"its times": clock.rate_hz, OF_HINT: self.hint_hz}, 0.0)
        if printed is None and self.hint_hz is None and rate_hz is not None:
            step = _of(head, "Delta_X", place)
            if rate_hz == 1.0:
                self.remarks.append(
                    "Delta_X is 1 s, which LabVIEW also writes where nobody sets it. State the rate (--sample-rate) "
                    "where it is not one sample a second."
                )
            if abs(rate_hz * float(step.replace(",", ".")) - 1.0) > 1e-9:
                self.remarks.append(
                    f"The rate of {rate_hz:g} Hz is the roundest one whose step is printed as {step} (Delta_X)."
                )
        channel = Channel(
            name=name,
            unit=plain_unit(_of(head, "Y_Unit_Label", place)),
            rate_hz=clock.rate_hz,
            start_s=clock.start_s,
            count=rows.size,
            source=values,
        )
        return on_clock(channel, clock)

    def _filled(self, is_row: NDArray[np.bool_]) -> list[tuple[int, int]]:
        """Return first and last of the rows that a channel fills in each segment; one of a lower rate has fewer."""
        filled, first = [], 0
        for segment in self.segments:
            of_segment = np.flatnonzero(is_row[first : first + segment.count])
            filled.append((first, first + int(of_segment[-1]) + 1 if of_segment.size else first))
            first += segment.count
        return filled

    def _seconds(
        self, place: int, counts: Sequence[int], printed: FloatArray | None, rate_hz: float | None
    ) -> list[FloatArray]:
        """Return the times of so many rows of every segment from the date of the first on [s]."""
        pieces: list[FloatArray] = []
        first = _moment(self.segments[0].head, place)
        row, end_s, zero_s = 0, -np.inf, 0.0
        for segment, count in zip(self.segments, counts, strict=True):
            if not count:
                continue
            if printed is None:
                rate = rate_hz or 1.0
                seconds = _number(_of(segment.head, "X0", place)) + np.arange(count) / rate
            else:
                seconds = np.array(printed[row : row + count])
            # seconds since 1904 are no seconds of a test
            if not pieces and abs(seconds[0]) > LATER_THAN_ANY_TEST_S:
                zero_s = float(seconds[0])
            seconds = seconds - zero_s
            if pieces and not seconds[0] > end_s:
                # its times begin anew: those of its head say when
                when = _moment(segment.head, place)
                passed = (when - first).total_seconds() if when is not None and first is not None else 0.0
                step = 1.0 / rate_hz if rate_hz else float(np.median(np.diff(seconds))) if seconds.size > 1 else 0.0
                shift = passed if seconds[0] + passed > end_s else end_s + step - float(seconds[0])
                if shift != passed:
                    self.remarks.append(
                        f"Line {segment.line}: the head of the segment does not say when it begins; it was put right "
                        "behind the one before."
                    )
                seconds = seconds + shift
            pieces.append(seconds)
            end_s = float(np.nanmax(seconds)) if np.isfinite(seconds).any() else end_s
            row += count
        return pieces


def _picked(values: Source, rows: NDArray[np.int64], start: int, stop: int) -> FloatArray:
    """Return the values of some rows of a column."""
    if start == stop:
        return values(0, 0)
    first, last = int(rows[start]), int(rows[stop - 1]) + 1
    picked: FloatArray = values(first, last)[rows[start:stop] - first]
    return picked


def _of(head: dict[str, list[str]], key: str, place: int) -> str:
    fields = head.get(key, [])
    return fields[place - 1] if 0 < place <= len(fields) else ""


def _number(text: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return 0.0


def _moment(head: dict[str, list[str]], place: int) -> datetime | None:
    """Return the date and time of a head."""
    date, time = _DATE.fullmatch(_of(head, "Date", place)), _TIME.fullmatch(_of(head, "Time", place))
    if date is None or time is None:
        return None
    try:
        year, month, day = map(int, date.groups())
        hour, minute, second = map(int, time.groups()[:3])
        microsecond = int((time[4] or "")[:6].ljust(6, "0"))
        return datetime(year, month, day, hour, minute, second, microsecond)  # noqa: DTZ001 - the file says no zone
    except ValueError:
        return None
