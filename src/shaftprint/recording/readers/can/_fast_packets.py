"""Fast packets of NMEA 2000: messages of up to 223 bytes in several frames, put together again."""

from collections.abc import Hashable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.recording.readers.can._frames import FILL
from shaftprint.recording.readers.can._messages import MOST_BYTES

LONGEST_S = 0.75
"""Time within which a packet is whole [s]; the counter of packets comes round again later."""


@dataclass(slots=True)
class _Packet:
    """A packet that is coming in."""

    begin_s: float
    length: int
    content: bytearray
    frames: int = 1


@dataclass(slots=True)
class FastPackets:
    """Puts frames together by bus, sender and the counter in their first byte."""

    lost: dict[Hashable, int] = field(default_factory=dict)
    """How many packets were not whole, by their origin."""
    _open: dict[tuple[Hashable, int], _Packet] = field(default_factory=dict)

    def add(
        self, origin: Hashable, time_s: FloatArray, content: NDArray[np.uint8]
    ) -> tuple[FloatArray, NDArray[np.int64], NDArray[np.uint8]]:
        """Return the packets that a block of frames makes whole: times of their first frames, lengths, bytes.

        ``origin``: bus, message and sender. ``time_s``: when the frames came [s]. ``content``: their bytes, shape
        (frames, 8).
        """
        times, packets = [], []
        for now, row in zip(time_s.tolist(), content[:, :8], strict=True):
            packet = self._take(origin, now, row.tobytes())
            if packet is not None:
                times.append(packet.begin_s)
                packets.append(packet.content)
        lengths = np.array([len(one) for one in packets], dtype=np.int64)
        width = -(-int(lengths.max(initial=8)) // 8) * 8
        whole = np.full((len(packets), width), FILL, dtype=np.uint8)
        for place, one in enumerate(packets):
            whole[place, : len(one)] = one
        return np.array(times), lengths, whole

    def finish(self) -> None:
        """Count what has not become whole."""
        for origin, _ in self._open:
            self._lose(origin)
        self._open.clear()

    def _take(self, origin: Hashable, now: float, row: bytes) -> _Packet | None:
        key, number = (origin, row[0] >> 5), row[0] & 0x1F
        packet = self._open.get(key)
        if packet is not None and now - packet.begin_s > LONGEST_S:
            self._lose(origin)
            del self._open[key]
            packet = None
        if number == 0:
            first = row[2 : 2 + row[1]]
            if packet is not None and packet.frames == 1 and packet.length == row[1] and packet.content == first:
                # a gateway hands on some frames twice
                return None
            if packet is not None:
                self._lose(origin)
            if row[1] > MOST_BYTES:
                self._lose(origin)
                self._open.pop(key, None)
                return None
            packet = self._open[key] = _Packet(now, row[1], bytearray(first))
        elif packet is None:
            return None
        elif number == packet.frames:
            packet.content += row[1:]
            packet.frames += 1
        elif number != packet.frames - 1:
            self._lose(origin)
            del self._open[key]
            return None
        if len(packet.content) < packet.length:
            return None
        del self._open[key]
        del packet.content[packet.length :]
        return packet

    def _lose(self, origin: Hashable) -> None:
        self.lost[origin] = self.lost.get(origin, 0) + 1
