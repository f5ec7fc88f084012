"""The journal of a live test: blocks as they come, one after the other, each with a check sum.

A program that is killed leaves a journal that is whole to its last block, which a container of HDF5 would not be: its
tables are not on the disk until it is closed. ``RECORD`` is the head of every entry; the first entry says what the
channels are.
"""

import json
import math
import os
import re
import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.files import reason

MARK = b"shaftprint journal 1\n"
"""First bytes of a journal."""
RECORD = struct.Struct("<4sBII")
"""Word, kind, length and CRC-32 of what follows."""
WORD = b"\x00BLK"
"""First bytes of an entry."""
HEAD, BLOCK, EVENT = 1, 2, 3
"""Kinds of an entry."""
_BLOCK = struct.Struct("<qdd")
_COUNT = struct.Struct("<I")
# Power may fail: so often what the system holds is put on the disk [blocks].
_SYNC_EVERY = 20
# A length that no block has; what says so is damage.
_LONGEST = 1 << 28
# Behind a torn entry bytes are looked at so many times.
_MOST_LOOKS = 16
_LONGEST_S = 60.0


@dataclass(frozen=True, kw_only=True, slots=True)
class JournalBlock:
    """Where a block is in a journal."""

    counter: int
    """Number of the block by its sender."""
    source_s: float
    """Time of its first samples by the sender's clock [s]."""
    span_s: float
    """Time that it covers [s]."""
    places: tuple[tuple[int, int], ...]
    """Of each channel the place of its samples in the file, and their number."""


class JournalWriter:
    """Write blocks and events as they come."""

    def __init__(self, path: Path, head: Mapping[str, Any]) -> None:
        """Begin a journal.

        ``head``: what it is of; ``channels`` lists names, units, rates, scales, offsets and types in the order in which
        blocks have them. Raises RecordingError if the file exists or cannot be written.
        """
        self._path = path
        self._since = 0
        try:
            self._file: BinaryIO = path.open("xb", buffering=0)
            self._file.write(MARK)
        except OSError as error:
            raise RecordingError(f"{path}: the journal cannot be written: {reason(error)}.") from None
        self._write(HEAD, json.dumps(head, allow_nan=False).encode("utf-8"))

    def block(self, counter: int, source_s: float, span_s: float, samples: list[NDArray[Any]]) -> None:
        """Write a block: the samples of each channel, in the order of the head."""
        parts = [_BLOCK.pack(counter, source_s, span_s)]
        for one in samples:
            parts += [_COUNT.pack(one.size), one.tobytes()]
        self._write(BLOCK, b"".join(parts))
        self._since += 1
        if self._since >= _SYNC_EVERY:
            self._since = 0
            os.fsync(self._file.fileno())

    def event(self, event: Mapping[str, Any]) -> None:
        """Write an event."""
        self._write(EVENT, json.dumps(event).encode("utf-8"))

    def close(self) -> None:
        """Put all on the disk."""
        if not self._file.closed:
            os.fsync(self._file.fileno())
            self._file.close()

    def __enter__(self) -> Self:
        """Return the journal itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()

    def _write(self, kind: int, content: bytes) -> None:
        # one call: whoever is killed leaves the whole entry or a torn last one
        entry = RECORD.pack(WORD, kind, len(content), zlib.crc32(content)) + content
        try:
            view = memoryview(entry)
            while view:
                view = view[self._file.write(view) :]
        except OSError as error:
            raise RecordingError(f"{self._path}: the journal cannot be written: {reason(error)}.") from None


@dataclass(frozen=True, kw_only=True, slots=True)
class Journal:
    """What is in a journal."""

    head: Mapping[str, Any]
    """What it is of."""
    blocks: tuple[JournalBlock, ...]
    """Its blocks in the order in which they came."""
    events: tuple[Mapping[str, Any], ...]
    """What happened, in order."""
    torn_bytes: int
    """Bytes behind its last whole entry: of a block that was being written when the program ended."""


def read_journal(path: Path) -> Journal:
    """Return what is in a journal, to its last whole entry.

    Raises RecordingError if it has no head, or an entry before the last is damaged.
    """
    head: Mapping[str, Any] | None = None
    sizes: tuple[int, ...] = ()
    blocks: list[JournalBlock] = []
    events: list[Mapping[str, Any]] = []
    end = len(MARK)
    with path.open("rb") as file:
        whole = os.fstat(file.fileno()).st_size
        for kind, place, content in _entries(file, len(MARK)):
            end = place + len(content)
            if kind == HEAD and head is None:
                head, sizes = _head(path, content)
            elif kind == BLOCK and head is not None:
                blocks.append(_block(path, content, place, sizes))
            elif kind == EVENT:
                events.append(_event(content))
        if head is None:
            raise RecordingError(f"{path}: expected the head of a journal, found none; is the file damaged?")
        if _goes_on(file, end):
            raise RecordingError(f"{path}: expected whole blocks, found damage at byte {end}; is the file damaged?")
    return Journal(head=head, blocks=tuple(blocks), events=tuple(events), torn_bytes=whole - end)


def _goes_on(file: BinaryIO, end: int) -> bool:
    """Return whether a whole entry stands behind what is damaged."""
    file.seek(end)
    rest = memoryview(file.read())
    looked, most = 0, _MOST_LOOKS * len(rest)
    for found in re.finditer(re.escape(WORD), rest[1:]):
        start = 1 + found.start()
        if start + RECORD.size > len(rest):
            return False
        _, _, length, check = RECORD.unpack_from(rest, start)
        content = rest[start + RECORD.size : start + RECORD.size + length]
        if length > _LONGEST or len(content) < length:
            continue
        looked += length
        # what says so often that an entry begins is no torn one
        if looked > most or zlib.crc32(content) == check:
            return True
    return False


def _entries(file: BinaryIO, place: int) -> Iterator[tuple[int, int, bytes]]:
    """Yield kind, place and content of whole entries from a place on, up to the first that is not whole."""
    while True:
        file.seek(place)
        start = file.read(RECORD.size)
        if len(start) < RECORD.size:
            return
        word, kind, length, check = RECORD.unpack(start)
        if word != WORD or length > _LONGEST:
            return
        content = file.read(length)
        if len(content) < length or zlib.crc32(content) != check:
            return
        yield kind, place + RECORD.size, content
        place += RECORD.size + length


def _head(path: Path, content: bytes) -> tuple[Mapping[str, Any], tuple[int, ...]]:
    try:
        head = json.loads(content)
        channels = head["channels"]
        sizes = tuple(np.dtype({"int16": "i2", "float64": "f8"}[one["dtype"]]).itemsize for one in channels)
        numbers = [float(one[key]) for one in channels for key in ("rate_hz", "scale", "offset")]
        names = {_text(one["name"]) for one in channels}
        _ = [_text(one["unit"]) for one in channels]
    except (KeyError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise RecordingError(f"{path}: expected channels in the head of the journal, found a fault: {error}.") from None
    if not sizes or len(names) != len(sizes) or not np.isfinite(numbers).all():
        raise RecordingError(f"{path}: expected channels of other names with numbers in the head, found others.")
    return head, sizes


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError("a name or unit that is no text")
    return value


def _event(content: bytes) -> Mapping[str, Any]:
    """Return an event; one that is no text is kept as nothing, for it is beside the samples."""
    try:
        event = json.loads(content)
    except (ValueError, RecursionError):
        return {}
    return event if isinstance(event, dict) else {}


def _block(path: Path, content: bytes, place: int, sizes: tuple[int, ...]) -> JournalBlock:
    try:
        counter, source_s, span_s = _BLOCK.unpack_from(content)
        at, places = _BLOCK.size, []
        for size in sizes:
            (count,) = _COUNT.unpack_from(content, at)
            at += _COUNT.size
            places.append((place + at, count))
            at += count * size
    except struct.error as error:
        raise RecordingError(f"{path}: expected a block at byte {place}, found a fault: {error}.") from None
    if not (math.isfinite(source_s) and 0.0 < span_s <= _LONGEST_S):
        raise RecordingError(f"{path}: expected a block with a time and a length at byte {place}, found none.")
    if at != len(content):
        raise RecordingError(f"{path}: expected a block of {at} bytes at byte {place}, found {len(content)}.")
    return JournalBlock(counter=counter, source_s=source_s, span_s=span_s, places=tuple(places))
