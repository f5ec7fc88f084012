"""Channels as what a bus carries: counts in the bytes of messages, each at its time."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording.readers._gather import told_apart
from shaftprint.recording.readers.can._frames import FILL
from shaftprint.recording.readers.can._messages import Message, Signal

Frame: TypeAlias = tuple[float, int, bytes]
"""Time [s], identifier and bytes."""

BITS = 16
NO_VALUE, _LAST_VALUE = 0xFFFF, 0xFAFF
"""Counts of 16 bits: "not available", and the last one that is a value, as SAE J1939-71 has them."""
_INT16 = np.iinfo(np.int16)
# Steps that senders use, where the values lie within 16 bits of them: SAE J1939-71, SPN 190.
_USUAL_STEPS = {"rpm": 0.125}
_LONGEST_NAME = 32
_NOT_IN_NAMES = re.compile(r"\W", re.ASCII)
# Frames of one packet follow each other at this distance [s].
_FRAME_S = 0.0005
_ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Sent:
    """A message and the channels in it."""

    message: Message
    """What it holds; each signal stands at whole bytes, lowest first."""
    channels: tuple[Channel, ...]
    """The channel of each signal."""
    sent_s: FloatArray | None = None
    """When it is sent, with the newest samples then [s]; at the times of the samples, which all channels share, where
    there is none."""
    fixed: Mapping[int, int] = field(default_factory=dict)
    """Bytes that hold something else than channels, by their places."""
    least_bytes: int = 0
    """How many bytes it has at least."""

    @property
    def length(self) -> int:
        """How many bytes it has."""
        return max(self.message.last_byte + 1, self.least_bytes)

    @property
    def count(self) -> int:
        """How often it is sent."""
        return self.channels[0].count if self.sent_s is None else self.sent_s.size

    def frames(self) -> Iterator[Frame]:
        """Yield the frames in order of time."""
        identifier, width = self.message.identifier, self.length
        for start in range(0, self.count, CHUNK_SAMPLES):
            time_s, content = self._block(start, min(start + CHUNK_SAMPLES, self.count))
            whole = content.tobytes()
            for place, time in enumerate(time_s.tolist()):
                data = whole[place * width : (place + 1) * width]
                if self.message.is_fast:
                    yield from _packet(time, identifier, data, start + place)
                else:
                    yield time, identifier, data

    def times_s(self, start: int, stop: int) -> FloatArray:
        """Return when the messages [start, stop) are sent [s], shape (stop - start,)."""
        return self.channels[0].stamps_s(start, stop) if self.sent_s is None else self.sent_s[start:stop]

    def _block(self, start: int, stop: int) -> tuple[FloatArray, NDArray[np.uint8]]:
        content = np.full((stop - start, self.length), FILL, dtype=np.uint8)
        for place, value in self.fixed.items():
            content[:, place] = value
        time_s = self.times_s(start, stop)
        for signal, channel in zip(self.message.signals, self.channels, strict=True):
            if self.sent_s is None:
                counts = counts_of(channel, signal, start, stop)
            else:
                counts = _newest(channel, signal, time_s)
            first, width = signal.start // 8, signal.bits // 8
            content[:, first : first + width] = counts.astype("<u8").view(np.uint8).reshape(-1, 8)[:, :width]
        return time_s, content


def _newest(channel: Channel, signal: Signal, time_s: FloatArray) -> NDArray[np.int64]:
    """Return the counts of the newest samples at some times, which ascend; none before the first."""
    if channel.stamps is not None:
        rows = np.searchsorted(channel.stamps_s(0, channel.count), time_s, side="right") - 1
    else:
        rows = np.floor((time_s - channel.start_s) * channel.rate_hz + _ROUNDING).astype(np.int64)
    first, last = int(np.clip(rows[0], 0, None)), int(np.clip(rows[-1], 0, channel.count - 1))
    if not channel.count or last < first:
        return np.full(time_s.size, none_of(signal), dtype=np.int64)
    counts = counts_of(channel, signal, first, last + 1)
    return np.where(rows < 0, none_of(signal), counts[np.clip(rows, first, last) - first])


def counts_of(channel: Channel, signal: Signal, start: int, stop: int) -> NDArray[np.int64]:
    """Return the samples [start, stop) of a channel as counts of a signal; none beyond its counts."""
    if _are_its_counts(channel, signal):
        return channel.read(start, stop).astype(np.int64)
    last = _last_count(signal)
    exact = np.rint((channel.values(start, stop) - signal.offset) / signal.factor)
    is_value = (exact >= (-last - 1 if signal.is_signed else 0)) & (exact <= last)
    return np.where(is_value, exact, none_of(signal)).astype(np.int64)


def _are_its_counts(channel: Channel, signal: Signal) -> bool:
    """Return whether the counts of a channel are those of the signal."""
    return channel.holds_counts and (channel.scale, channel.offset) == (signal.factor, signal.offset)


def none_of(signal: Signal) -> int:
    """Return the count that says "not available"."""
    return (1 << signal.bits - (1 if signal.is_signed else 0)) - 1


def _last_count(signal: Signal) -> int:
    """Return the last count that is a value under both standards; NMEA 2000 keeps three of a sign."""
    return (1 << signal.bits - 1) - 4 if signal.is_signed else _LAST_VALUE >> (BITS - signal.bits)


def own_signal(channel: Channel, name: str, *, start: int) -> Signal:
    """Return the signal of 16 bits in which a channel loses the least.

    Counts of 16 bits stay what they are. Other values get the step that senders use, or the smallest power of two with
    which all of them have a count.

    ``name``: its name in the message. ``start``: first bit.
    """
    is_counts = channel.holds_counts
    lowest_count, highest_count = (_INT16.min, _INT16.max) if is_counts else (0, _LAST_VALUE)
    factor, offset = (channel.scale, channel.offset) if is_counts else _step_of(channel)
    ends = (offset + factor * lowest_count, offset + factor * highest_count)
    return Signal(
        name=name,
        start=start,
        bits=BITS,
        unit=channel.unit,
        is_signed=is_counts,
        factor=factor,
        offset=offset,
        lowest=min(ends),
        highest=max(ends),
        comment=channel.long_name,
        texts={} if is_counts else {NO_VALUE: "not available"},
    )


def _step_of(channel: Channel) -> tuple[float, float]:
    """Return the value of a count, and that of count zero."""
    lowest, highest = np.inf, -np.inf
    for block in channel.blocks(CHUNK_SAMPLES):
        values = channel.values(*block)
        values = values[np.isfinite(values)]
        if values.size:
            lowest, highest = min(lowest, float(values.min())), max(highest, float(values.max()))
    usual = _USUAL_STEPS.get(channel.unit)
    if usual is not None and lowest >= 0.0 and highest <= usual * _LAST_VALUE:
        return usual, 0.0
    if not highest > lowest:
        return 1.0, lowest if np.isfinite(lowest) else 0.0
    # one count is left for the offset, which is a multiple of the step
    step = 2.0 ** np.ceil(np.log2((highest - lowest) / (_LAST_VALUE - 1)))
    return float(step), float(step * np.floor(lowest / step))


def rounding_of(channel: Channel, signal: Signal) -> str:
    """Return in a sentence what a channel loses as a signal; empty where it loses nothing."""
    if _are_its_counts(channel, signal):
        return ""
    unit = f" {channel.unit}" if channel.unit else ""
    return f"{channel.name} is rounded to steps of {signal.factor:.6g}{unit}, counts of {signal.bits} bits."


def names_in_messages(channels: Sequence[Channel]) -> dict[Channel, str]:
    """Return the name of each channel's signal: letters, digits and underscores, 32 at most, each once."""
    names = told_apart([_plain_name(channel.name) for channel in channels], numbered=_numbered)
    return dict(zip(channels, names, strict=True))


def _plain_name(name: str) -> str:
    plain = _NOT_IN_NAMES.sub("_", name)[:_LONGEST_NAME] or "_"
    return f"_{plain}"[:_LONGEST_NAME] if plain[0].isdigit() else plain


def _numbered(name: str, number: int) -> str:
    ending = f"_{number}"
    return name[: _LONGEST_NAME - len(ending)] + ending


def first_time_s(sent: Iterable[Sent]) -> float:
    """Return the time of the first frame [s]; 0 without any."""
    return min((float(one.times_s(0, 1)[0]) for one in sent if one.count), default=0.0)


def _packet(time_s: float, identifier: int, data: bytes, number: int) -> Iterator[Frame]:
    """Yield the frames of a fast packet of NMEA 2000: 6 bytes behind their number, then 7 in each."""
    mark = number % 8 << 5
    contents = [bytes([len(data)]) + data[:6], *(data[first : first + 7] for first in range(6, len(data), 7))]
    for place, content in enumerate(contents):
        yield time_s + _FRAME_S * place, identifier, (bytes([mark | place]) + content).ljust(8, bytes([FILL]))
