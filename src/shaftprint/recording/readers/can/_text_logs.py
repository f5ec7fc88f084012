"""Text logs of a CAN bus, read by python-can: Vector ASC, PEAK TRC, what candump writes, and rows of other programs."""

import re
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from itertools import chain, pairwise
from pathlib import Path
from typing import Any, TextIO

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._epoch import LATER_THAN_ANY_TEST_S
from shaftprint.recording.readers.can._asc_lines import AscLines, Lines, begins_as_asc
from shaftprint.recording.readers.can._frames import EXTENDED, FILL, FrameLog, Frames
from shaftprint.recording.readers.can._row_logs import Rows, row_kind

_BLOCK_FRAMES = 1 << 16
_CLASSIC, _LONG = 8, 64
_ASC, _TRC = "ASC", "TRC"

_TRC_VERSION = re.compile(r";\$FILEVERSION\s*=\s*(?P<version>\S+)", re.IGNORECASE)
_TRC_VERSIONS = ("1.0", "1.1", "1.3", "2.0", "2.1")
_CANDUMP = re.compile(r"\(\d+\.\d+\)\s+\S+\s+[0-9A-Fa-f]+#")
# what candump shows on a terminal, with or without times: (1780308000.25)  can0  0CF00400   [8]  F0 A5 9B
_SHOWN = re.compile(
    r"\s*(?:\((?P<time>\d+\.\d+|\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d+)\)\s+)?"
    r"(?P<bus>[a-z]\w*)\s+(?:[TR]X\s+\S+\s+\S+\s+|[TR]X\s+)?(?P<id>[0-9A-F]{3,8})\s+"
    r"\[(?P<length>\d+)\]\s+(?P<data>(?:[0-9A-F]{2}\s*)+|remote request)"
)
_FLAGS = re.compile(r"##[A-Fa-f]")
_FIRST_LINES, _REMARK = 12, "#"
# So many lines tell whether times are steps; stamps of several buses may go back here and there.
_SEEN_LINES, _STEPS, _BACK = 1000, 3, 0.1
_CUT = "rows at the cut end of the file"
# How a row with a frame, or a part of one, begins.
_ROW_BEGINS = re.compile(r"\s*(?:[\d(]|A\d)")


def kind_of(path: Path, begin: str) -> str:
    """Return which text log a file is, by its first letters; empty of others."""
    lines = [line for line in begin.splitlines() if line.strip() and not line.startswith(_REMARK)][:_FIRST_LINES]
    if not lines:
        return ""
    if rows := row_kind(lines):
        return rows
    if _CANDUMP.match(lines[0]) or _SHOWN.match(lines[0]):
        return "candump"
    if any(_TRC_VERSION.match(line) for line in lines) or (path.suffix.lower() == ".trc" and lines[0][0] == ";"):
        return _TRC
    if begins_as_asc(lines):
        return _ASC
    return ""


def open_text_log(path: Path, kind: str, file: TextIO, library: Any) -> FrameLog:
    """Return the frames of a text log.

    ``path``: the file, for messages. ``kind``: what `kind_of` said. ``file``: it, at its beginning. ``library``: the
    package python-can. Raises RecordingError if its times cannot be told, or nothing in it can be read.
    """
    log = FrameLog(blocks=iter(()), kind=kind)
    lines = _LINES[kind](path, file) if kind in _LINES else _RowLines(path, file, kind)
    reader = {_ASC: library.ASCReader, _TRC: library.TRCReader}.get(kind, library.CanutilsLogReader)(lines)
    if kind == _TRC:
        _expect_version(path, file)
    messages = _whole(iter(reader), lines, log)
    first = next(messages, None)
    if first is None:
        raise RecordingError(f"{path}: expected frames of a CAN bus, found none.")
    zero_s, first_bus = 0.0, 1 if kind == _ASC else 0
    if kind == _TRC and reader.start_time is not None:
        # PEAK counts days by the clock of the computer, whose zone the file does not state
        zero_s, log.began = reader.start_time.timestamp(), reader.start_time.replace(tzinfo=None)
    elif kind not in (_ASC, _TRC) and first.timestamp > LATER_THAN_ANY_TEST_S:
        zero_s, log.began = first.timestamp, datetime.fromtimestamp(first.timestamp, UTC)
        if not lines.has_zone:
            log.began = log.began.replace(tzinfo=None)
    elif isinstance(lines, AscLines):
        log.began = lines.began
    buses: dict[str, int] = {}

    def bus_of(channel: Any) -> int:
        if not isinstance(channel, str):
            return first_bus + int(channel or 0)
        number = buses.setdefault(channel, len(buses))
        log.bus_names[number] = channel
        return number

    log.blocks = _blocks(chain([first], messages), log, zero_s, bus_of, lines)
    return log


class _CandumpLines(Lines):
    """Lines of candump, those that it shows on a terminal as those that it logs."""

    def __init__(self, path: Path, file: TextIO) -> None:
        super().__init__(path, file)
        begin = file.tell()
        shown = [_SHOWN.match(file.readline()) for _ in range(_SEEN_LINES)]
        file.seek(begin)
        times = [one["time"] for one in shown if one is not None and one["time"] is not None]
        self.has_zone = not any("-" in time for time in times)
        self._is_of_steps = self.has_zone and _are_steps([float(time) for time in times])
        self._last_s = 0.0

    def _seconds(self, time: str) -> str:
        """Return the time in front of a row, which may be a date of the computer or a step from the row before."""
        if "-" in time:
            return f"{datetime.fromisoformat(time).replace(tzinfo=UTC).timestamp():.6f}"
        if self._is_of_steps:
            self._last_s += float(time)
            return f"{self._last_s:.6f}"
        return time

    def changed(self, line: str) -> str:
        shown = _SHOWN.match(line)
        if shown is None:
            # the flags of CAN FD are a digit of base 16, of which the library reads 0 to 9
            return "" if line.startswith(_REMARK) else _FLAGS.sub(r"##0", line)
        if shown["time"] is None:
            raise RecordingError(
                f"{self._path}: expected times in front of the frames, found none; log with candump -L, or -t a."
            )
        data = "R" if shown["data"].startswith("r") else "".join(shown["data"].split())
        mark = "##0" if int(shown["length"]) > _CLASSIC else "#"
        return f"({self._seconds(shown['time'])}) {shown['bus']} {shown['id']}{mark}{data}\n"


def _are_steps(times: list[float]) -> bool:
    """Return whether times are those since the row before (-t d): they go back all the time, or stay."""
    back = sum(later < before for before, later in pairwise(times[1:]))
    stays = len(times) > _STEPS and times[1] > 0.0 and len(set(times[1:])) == 1
    return stays or back > _BACK * len(times)


class _RowLines(Lines):
    """Rows of other programs, as lines of candump."""

    def __init__(self, path: Path, file: TextIO, kind: str) -> None:
        super().__init__(path, file)
        self._of = Rows(kind)
        self._frames: list[str] = []
        self.has_zone = False

    def __next__(self) -> str:
        return self._frames.pop(0) if self._frames else super().__next__()

    def changed(self, line: str) -> str:
        lines = self._of.lines_of(line)
        self.has_zone = self._of.has_zone
        is_remark = not line.strip() or line.startswith(_REMARK)
        self.rows += len(lines) or not is_remark
        self._frames = lines[1:]
        return lines[0] if lines else ""


_LINES: Mapping[str, type[Lines]] = {_ASC: AscLines, _TRC: Lines, "candump": _CandumpLines}


def _expect_version(path: Path, file: TextIO) -> None:
    begin = file.tell()
    version = next(filter(None, (_TRC_VERSION.match(file.readline()) for _ in range(_FIRST_LINES))), None)
    file.seek(begin)
    if version is not None and version["version"] not in _TRC_VERSIONS:
        raise RecordingError(
            f"{path}: expected a TRC file of version {', '.join(_TRC_VERSIONS)}, found {version['version']}; convert "
            "it with PEAK's converter."
        )


def _whole(messages: Iterator[Any], lines: Lines, log: FrameLog) -> Iterator[Any]:
    """Yield messages up to a last line that is cut, which the library may take for a shorter frame, or pass over."""
    has_given_last = False
    while True:
        try:
            message = next(messages)
        except StopIteration:
            if lines.is_cut and not has_given_last and _ROW_BEGINS.match(lines.last):
                log.count(_CUT)
                # counted once
                lines.rows -= lines.last_is_row
            return
        except (ValueError, IndexError, KeyError):
            if not lines.is_at_end:
                raise
            log.count(_CUT)
            lines.rows -= lines.last_is_row
            return
        has_given_last = lines.is_at_end
        if has_given_last and lines.is_cut and not _is_whole(message, lines.last, log.kind):
            log.count(_CUT)
            lines.rows -= lines.last_is_row
            return
        yield message


def _is_whole(message: Any, row: str, kind: str) -> bool:
    """Return whether a row that does not end with its line has all bytes that it announces; candump announces none."""
    if kind not in (_ASC, _TRC):
        return False
    is_short = not message.is_remote_frame and len(message.data) < message.dlc
    return not is_short and len(row.split()[-1]) != 1


def _blocks(
    messages: Iterator[Any], log: FrameLog, zero_s: float, bus_of: Callable[[Any], int], lines: Lines
) -> Iterator[Frames]:
    data_frames: list[Any] = []
    number = 0
    for message in messages:
        number += 1
        if message.is_error_frame:
            log.count("error frames")
        elif message.is_remote_frame:
            log.count("remote frames")
        else:
            data_frames.append(message)
        if len(data_frames) == _BLOCK_FRAMES:
            yield _block(data_frames, zero_s, bus_of)
            data_frames = []
    if data_frames:
        yield _block(data_frames, zero_s, bus_of)
    if lines.rows:
        log.count("rows of other kinds than frames", lines.rows - number)


def _block(messages: list[Any], zero_s: float, bus_of: Callable[[Any], int]) -> Frames:
    length = np.array([len(message.data) for message in messages])
    width = 8 if length.max() <= 8 else _LONG
    filling = bytes([FILL]) * width
    whole = b"".join((bytes(message.data) + filling)[:width] for message in messages)
    return Frames(
        time_s=np.array([message.timestamp for message in messages]) - zero_s,
        bus=np.array([bus_of(message.channel) for message in messages]),
        identifier=np.array(
            [message.arbitration_id | (EXTENDED if message.is_extended_id else 0) for message in messages],
            dtype=np.uint64,
        ),
        length=length,
        content=np.frombuffer(whole, dtype=np.uint8).reshape(-1, width),
    )
