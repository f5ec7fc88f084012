"""Frames of a CAN bus in an MDF 4 file (bus logging), as blocks for what takes them apart."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording.readers._mdf_records import MdfRecords
from shaftprint.recording.readers.can._frames import EXTENDED, FILL, FrameLog, Frames

# ASAM MDF 4.1, block CG: the records are events of a bus.
_BUS_EVENT = 2
_DATA, _OTHERS = "CAN_DataFrame", {"CAN_ErrorFrame": "error frames", "CAN_RemoteFrame": "remote frames"}
_BLOCK_FRAMES = 1 << 18
_MOST_BUSES = 0xFF
_MARK_BIT, _IDENTIFIER_BITS = 31, (1 << 29) - 1


def is_bus_logging(group: Any) -> bool:
    """Return whether a group of an open MDF file holds raw messages."""
    return bool(int(getattr(group.channel_group, "flags", 0)) & _BUS_EVENT)


def holds_frames(group: Any) -> bool:
    """Return whether raw messages are the data frames of a CAN bus, with or without any in it."""
    return is_bus_logging(group) and f"{_DATA}.ID" in _names(group)


def holds_no_values(group: Any) -> bool:
    """Return whether raw messages are errors or requests on a CAN bus."""
    return bool(_event_kind(group))


def frames_of(file: Any, records: MdfRecords) -> FrameLog:
    """Return the frames of an open file, group by group."""
    log = FrameLog(blocks=iter(()), kind="MDF")
    for group in file.groups:
        if kind := _event_kind(group):
            log.count(kind, int(group.channel_group.cycles_nr))
    log.blocks = _blocks(file, records)
    return log


def _blocks(file: Any, records: MdfRecords) -> Iterator[Frames]:
    for number, group in enumerate(file.groups):
        if not holds_frames(group):
            continue
        indices = _names(group)
        count = int(group.channel_group.cycles_nr)
        for start in range(0, count, _BLOCK_FRAMES):
            stop = min(start + _BLOCK_FRAMES, count)
            yield _block(file, records, number, indices, start, stop)


def _block(file: Any, records: MdfRecords, group: int, indices: dict[str, int], start: int, stop: int) -> Frames:
    def field(name: str) -> NDArray[Any] | None:
        index = indices.get(f"{_DATA}.{name}")
        return None if index is None else records.samples(group, index, start, stop, raw=False)[0]

    def numbers(name: str) -> NDArray[np.int64] | None:
        values = field(name)
        return None if values is None or values.dtype.kind not in "iuf" else values.astype(np.int64)

    times = file.get_master(group, record_offset=start, record_count=stop - start)
    identifier, is_long, bus = numbers("ID"), numbers("IDE"), numbers("BusChannel")
    content, length = field("DataBytes"), numbers("DataLength")
    if content is not None and content.dtype.kind == "S":
        # bytes of their own length, filled up with zeros
        content = np.frombuffer(content.tobytes(), dtype=np.uint8).reshape(len(content), content.dtype.itemsize)
    if identifier is None or content is None or content.ndim != 2:
        raise ValueError("frames without identifiers or bytes")
    if is_long is None:
        is_long = identifier >> _MARK_BIT & 1
    if length is None:
        # without the length the code of the frame tells it, up to eight bytes
        code = numbers("DLC")
        length = np.full(len(identifier), content.shape[1]) if code is None else np.minimum(code, content.shape[1])
    length = np.minimum(length, content.shape[1])
    width = -(-max(content.shape[1], 1) // 8) * 8
    whole = np.full((len(identifier), width), FILL, dtype=np.uint8)
    whole[:, : content.shape[1]] = content
    whole[np.arange(width) >= length[:, None]] = FILL
    return Frames(
        time_s=np.asarray(times, dtype=np.float64),
        bus=np.zeros(len(identifier), dtype=np.int64) if bus is None else bus & _MOST_BUSES,
        identifier=(identifier & _IDENTIFIER_BITS) | np.where(is_long != 0, EXTENDED, 0),
        length=length,
        content=whole,
    )


def _event_kind(group: Any) -> str:
    """Return which events without values the raw messages of a group are; empty of other groups."""
    names = _names(group) if is_bus_logging(group) else {}
    return next((kind for name, kind in _OTHERS.items() if name in names), "")


def _names(group: Any) -> dict[str, int]:
    """Return the number of each channel of a group by its name."""
    return {str(channel.name): index for index, channel in enumerate(group.channels)}
