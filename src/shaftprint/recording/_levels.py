"""What levels the raw channels of a recording reach, before a vessel file says what they are."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.recording._channel import Channel

BLOCK_SAMPLES = 262_144

# A pick-up's pulse rises within a sample or two, of which it has four to thirty: up to 15 % of the samples of the
# simulated tug's pick-ups are between their levels. Of a sine 41 % are (2 / pi * arcsin(0.6)), of noise more.
BETWEEN = (0.2, 0.8)
MOST_BETWEEN = 0.25
FEWEST_CROSSINGS = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class Levels:
    """Levels of one raw channel in its unit."""

    unit: str
    """Unit of the channel; empty where the file does not say."""
    lowest: float
    """Smallest value [unit]; not a number where there is none."""
    mean: float
    """Mean [unit]; not a number where there is none."""
    highest: float
    """Largest value [unit]; not a number where there is none."""
    at_lowest: float
    """Share of the samples at the smallest value."""
    at_highest: float
    """Share of the samples at the largest value."""
    missing: int
    """Number of samples that are no number."""
    is_pulses: bool
    """Whether almost all values lie near the lowest or the highest, and few of them near one of these."""


class Tally:
    """What has been seen of a channel so far; it counts along while something else reads the channel."""

    def __init__(self, channel: Channel) -> None:
        self.channel = channel
        self.watched = replace(channel, source=self._read)
        self._lowest, self._highest, self._total, self._count = np.inf, -np.inf, 0.0, 0
        self._at_lowest = self._at_highest = self._seen = 0
        self._is_pulses = False

    def read_on(self, stop: int) -> None:
        """Read what nobody has read before a sample."""
        while self._seen < min(stop, self.channel.count):
            self.watched.read(self._seen, min(self._seen + BLOCK_SAMPLES, self.channel.count))

    def levels(self) -> Levels:
        """Return the levels of the whole channel; what nobody has read is read now."""
        self.read_on(self.channel.count)
        has_samples = self._count > 0
        ends = [self._value(self._lowest), self._value(self._highest)] if has_samples else [np.nan, np.nan]
        at_ends = [share / self._count if has_samples else 0.0 for share in (self._at_lowest, self._at_highest)]
        if self.channel.scale < 0.0:
            ends, at_ends = ends[::-1], at_ends[::-1]
        return Levels(
            unit=self.channel.unit,
            lowest=ends[0],
            mean=self._value(self._total / self._count) if has_samples else np.nan,
            highest=ends[1],
            at_lowest=at_ends[0],
            at_highest=at_ends[1],
            missing=self.channel.count - self._count,
            is_pulses=self._is_pulses,
        )

    def _value(self, counts: float) -> float:
        return counts * self.channel.scale + self.channel.offset

    def _read(self, start: int, stop: int) -> NDArray[Any]:
        counts = self.channel.source(start, stop)
        # whoever looks at a few samples only comes again for the rest
        if start == self._seen and (stop - start >= BLOCK_SAMPLES or stop == self.channel.count):
            self._add(counts)
            self._seen = stop
        return counts

    def _add(self, counts: NDArray[Any]) -> None:
        is_finite = np.isfinite(counts) if counts.dtype.kind == "f" else None
        finite = counts if is_finite is None or is_finite.all() else counts[is_finite]
        if not finite.size:
            return
        self._is_pulses = _are_pulses(finite) if self._count == 0 else self._is_pulses
        low, high = finite.min(), finite.max()
        lowest, highest = min(self._lowest, float(low)), max(self._highest, float(high))
        # what was lowest so far counts no longer where something lower has come
        self._at_lowest = self._at_lowest if lowest == self._lowest else 0
        self._at_highest = self._at_highest if highest == self._highest else 0
        if low == lowest:
            self._at_lowest += int(np.count_nonzero(finite == low))
        if high == highest:
            self._at_highest += int(np.count_nonzero(finite == high))
        self._lowest, self._highest = lowest, highest
        exact = np.int64 if counts.dtype == np.int16 else np.float64
        self._total, self._count = self._total + float(finite.sum(dtype=exact)), self._count + finite.size


def levels_of(channels: Sequence[Channel], *, reach: Callable[[float], None] | None = None) -> list[Levels]:
    """Return the levels of channels, read once, block by block: some formats have all channels in one record.

    ``channels``: the channels of a recording. ``reach``: is told the share that is done, 0 to 1. Raises RecordingError
    if the file cannot be read.
    """
    tallies = [Tally(channel) for channel in channels]
    read_on(tallies, reach=reach)
    return [tally.levels() for tally in tallies]


def read_on(tallies: Sequence[Tally], *, reach: Callable[[float], None] | None = None) -> None:
    """Read what nobody has read of some channels, block by block."""
    most = max((tally.channel.count for tally in tallies), default=0)
    for start in range(0, most, BLOCK_SAMPLES):
        for tally in tallies:
            tally.read_on(start + BLOCK_SAMPLES)
        if reach is not None:
            reach(min((start + BLOCK_SAMPLES) / most, 1.0))


def _are_pulses(counts: NDArray[Any]) -> bool:
    """Return whether counts stand at two levels, and cross the middle between them at least four times."""
    low, high = (float(level) for level in np.percentile(counts, [0.5, 99.5]))
    if not high > low:
        return False
    share = (counts - low) / (high - low)
    between = float(np.mean((share > BETWEEN[0]) & (share < BETWEEN[1])))
    crossings = int(np.count_nonzero(np.diff(share > 0.5)))
    return between < MOST_BETWEEN and crossings >= FEWEST_CROSSINGS
