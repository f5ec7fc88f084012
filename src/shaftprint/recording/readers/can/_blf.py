"""Vector BLF: objects in packed containers, read by the array; their layout is that of python-can's reader."""

import struct
import zlib
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording.readers.can._frames import FILL, FrameLog, Frames

NAME = "BLF"
SIGNATURE = b"LOGG"

_FILE_HEADER = struct.Struct("<4sL32x8H8H")
_OBJECT = struct.Struct("<4sHHLL")
_CONTAINER = struct.Struct("<H6xL4x")
_MARK = b"LOBJ"
_LOG_CONTAINER, _STORED, _DEFLATED = 10, 0, 2
_MESSAGES, _FD_MESSAGE, _FD_MESSAGE_64, _ERRORS = (1, 86), 100, 101, (2, 73)
# header of the second version, and where the body begins
_VERSION_2, _BODY, _BODY_2 = 2, 32, 40
_FD_BODY, _FD_64_BODY = 20, 40
_TEN_MICROSECONDS = 1
_REMOTE, _FD_REMOTE = 0x80, 0x10
_LONG = 64
# Containers are unpacked until so many bytes are together; one holds 128 KiB, and no more than this.
_BLOCK_BYTES, _MOST_BYTES = 1 << 23, 1 << 26
# Objects are filled up with a few bytes.
_FILLING = 8
# Objects that are looked at together, how few of them are worth it, and how many are then looked at one by one.
_FIRST_RUN, _SHORT_RUN, _SINGLES = 64, 8, 256


def open_blf(path: Path, file: BinaryIO) -> FrameLog:
    """Return the frames of a BLF file.

    ``path``: the file, for messages. ``file``: it, at its beginning. Raises RecordingError if its header is damaged.
    """
    header = file.read(_FILE_HEADER.size)
    if len(header) < _FILE_HEADER.size:
        raise RecordingError(f"{path}: expected a whole BLF file, found one that is cut; copy it again.")
    _, size, *dates = _FILE_HEADER.unpack(header)
    file.seek(max(size, _FILE_HEADER.size))
    log = FrameLog(blocks=iter(()), kind=NAME, began=_date(dates[:8]))
    log.blocks = _blocks(path, file, log)
    return log


def _date(parts: list[int]) -> datetime | None:
    """Return when the measurement began, by the clock of the computer, whose zone the file does not state."""
    year, month, _, day, hour, minute, second, milli = parts
    try:
        return datetime(year, month, day, hour, minute, second, 1000 * milli)  # noqa: DTZ001
    except ValueError:
        return None


def _blocks(path: Path, file: BinaryIO, log: FrameLog) -> Iterator[Frames]:
    parts: list[bytes] = []
    together, cut = 0, b""
    for content in _containers(path, file, log):
        parts.append(content)
        together += len(content)
        if together >= _BLOCK_BYTES:
            cut = yield from _frames(path, b"".join([cut, *parts]), log)
            parts, together = [], 0
    cut = yield from _frames(path, b"".join([cut, *parts]), log)
    log.count("objects at the cut end of the file", int(bool(cut.strip(b"\0"))))


def _containers(path: Path, file: BinaryIO, log: FrameLog) -> Iterator[bytes]:
    """Yield what is in each container."""
    while head := file.read(_OBJECT.size):
        if len(head) < _OBJECT.size:
            log.count("containers at the cut end of the file")
            return
        mark, _, _, size, kind = _OBJECT.unpack(head)
        if mark != _MARK or not _OBJECT.size <= size <= _MOST_BYTES:
            raise _damaged(path)
        content = file.read(size - _OBJECT.size)
        file.read(size % 4)
        is_cut = len(content) < size - _OBJECT.size
        log.count("containers at the cut end of the file", int(is_cut))
        if kind != _LOG_CONTAINER:
            log.count("objects of other kinds than containers")
            continue
        if len(content) < _CONTAINER.size:
            return
        method, length = _CONTAINER.unpack_from(content)
        packed = content[_CONTAINER.size :]
        if method == _STORED:
            yield packed
        elif method == _DEFLATED and length <= _MOST_BYTES:
            try:
                yield zlib.decompressobj().decompress(packed, length or _MOST_BYTES)
            except zlib.error:
                if not is_cut:
                    raise _damaged(path) from None
        else:
            raise RecordingError(
                f"{path}: expected containers that are stored or deflated, found the method {method}; save the log "
                "anew with the program that wrote it."
            )


def _frames(path: Path, data: bytes, log: FrameLog) -> Any:
    """Yield the data frames among the objects of some bytes; return what of the last object is still to come."""
    at, end = _objects(path, data)
    if at.size:
        content = np.frombuffer(data, dtype=np.uint8)
        frames = _taken(content, at, log)
        if len(frames.time_s):
            yield frames
    return data[end:]


def _objects(path: Path, data: bytes) -> tuple[NDArray[np.int64], int]:
    """Return where each object begins, and where the first begins that is not whole."""
    place, end, size_of = 0, len(data), _OBJECT.unpack_from
    runs: list[NDArray[np.int64]] = []
    single: list[int] = []
    longest_run, singles = _FIRST_RUN, 0
    while place + _BODY <= end:
        if data[place : place + 4] != _MARK:
            mark = data.find(_MARK, place, place + _FILLING)
            if mark < 0:
                if place + _FILLING + _BODY > end:
                    break
                raise _damaged(path)
            place = mark
            continue
        size = size_of(data, place)[3]
        if size < _BODY:
            raise _damaged(path)
        if place + size > end:
            break
        if singles:
            # neighbours were of different kinds: look at one after the other for a while
            singles -= 1
            single.append(place)
            place += size
            continue
        # objects of one kind and size stand behind each other: see how many their heads, without the rest, are alike
        rows = min((end - place) // size, longest_run)
        heads = np.frombuffer(data, dtype=np.uint8, count=rows * size, offset=place).reshape(rows, size)
        other = np.flatnonzero((heads[:, : _OBJECT.size] != heads[0, : _OBJECT.size]).any(axis=1))
        alike = int(other[0]) if other.size else rows
        runs += [np.array(single, dtype=np.int64), place + size * np.arange(alike)]
        single = []
        place += size * alike
        longest_run = longest_run * 2 if alike == rows else _FIRST_RUN
        singles = _SINGLES if alike < _SHORT_RUN else 0
    return np.concatenate([*runs, np.array(single, dtype=np.int64)]), place


def _taken(content: NDArray[np.uint8], at: NDArray[np.int64], log: FrameLog) -> Frames:
    """Return the data frames of objects."""

    def field(places: NDArray[np.int64], offset: int, kind: str) -> NDArray[Any]:
        width = np.dtype(kind).itemsize
        values: NDArray[Any] = content[places[:, None] + offset + np.arange(width)].view(kind)[:, 0]
        return values

    kind, size = field(at, 12, "<u4"), field(at, 8, "<u4").astype(np.int64)
    body = at + np.where(field(at, 6, "<u2") == _VERSION_2, _BODY_2, _BODY)
    is_classic, is_fd, is_fd_64 = np.isin(kind, _MESSAGES), kind == _FD_MESSAGE, kind == _FD_MESSAGE_64
    # an object that is too short for what it should be holds nothing
    needed = np.where(is_classic, 16, np.where(is_fd, _FD_BODY + _LONG, _FD_64_BODY))
    is_whole = body + needed <= at + size
    log.count("error frames", int(np.count_nonzero(np.isin(kind, _ERRORS))))
    others = ~(is_classic | is_fd | is_fd_64 | np.isin(kind, _ERRORS))
    log.count("objects of other kinds", int(np.count_nonzero(others)))
    log.count("damaged frames", int(np.count_nonzero(~is_whole & (is_classic | is_fd | is_fd_64))))

    ticks = field(at, 24, "<u8").astype(np.float64)
    time_s = ticks * np.where(field(at, 16, "<u4") == _TEN_MICROSECONDS, 1e-5, 1e-9)
    width = 8 if not (is_fd | is_fd_64).any() else _LONG
    bus, identifier = np.zeros(at.size, dtype=np.uint16), np.zeros(at.size, dtype=np.uint32)
    length = np.zeros(at.size, dtype=np.int64)
    data = np.full((at.size, width), FILL, dtype=np.uint8)
    is_data = np.zeros(at.size, dtype=bool)
    for which, begin, most in ((is_classic, 8, 8), (is_fd, _FD_BODY, _LONG), (is_fd_64, _FD_64_BODY, _LONG)):
        here = np.flatnonzero(which & is_whole)
        if not here.size:
            continue
        start = body[here]
        bus[here] = field(start, 0, "u1" if which is is_fd_64 else "<u2")
        identifier[here] = field(start, 4, "<u4")
        if which is is_classic:
            held = np.minimum(field(start, 3, "u1"), 8)
            is_remote = field(start, 2, "u1") & _REMOTE
        elif which is is_fd:
            held, is_remote = np.minimum(field(start, 14, "u1"), _LONG), field(start, 2, "u1") & _REMOTE
        else:
            extra = field(start, 35, "u1").astype(np.int64)
            stored = np.where(extra > 0, extra, size[here]) - (start - at[here]) - _FD_64_BODY
            held = np.clip(np.minimum(field(start, 2, "u1"), stored), 0, _LONG)
            is_remote = field(start, 12, "<u4") & _FD_REMOTE
        length[here] = held
        columns = np.arange(most)
        taken = content[np.minimum(start[:, None] + begin + columns, content.size - 1)]
        data[here, :most] = np.where(columns < held.astype(np.int64)[:, None], taken, FILL)
        is_data[here] = is_remote == 0
        log.count("remote frames", int(np.count_nonzero(is_remote)))
    return Frames(
        time_s=time_s[is_data],
        bus=bus[is_data],
        identifier=identifier[is_data],
        length=length[is_data],
        content=data[is_data],
    )


def _damaged(path: Path) -> RecordingError:
    return RecordingError(f"{path}: expected a whole BLF file, found a damaged one; copy it again from the logger.")
