"""What levels the raw channels of a recording reach, before a vessel file says what they are."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
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


class _Counted:
    """What has been seen of a channel so far."""

    def __init__(self, channel: Channel) -> None:
        self.channel = channel
        self.lowest, self.highest, self.total, self.count = np.inf, -np.inf, 0.0, 0
        self.at_lowest = self.at_highest = 0
        self.is_pulses = False

    def add(self, start: int) -> None:
        """Look at the block that begins at a sample."""
        values = self.channel.values(start, min(start + BLOCK_SAMPLES, self.channel.count))
        finite = values[np.isfinite(values)]
        if not finite.size:
            return
        self.is_pulses = _are_pulses(finite) if self.count == 0 else self.is_pulses
        lowest, highest = min(self.lowest, float(finite.min())), max(self.highest, float(finite.max()))
        # what was lowest so far counts no longer where something lower has come
        self.at_lowest = (self.at_lowest if lowest == self.lowest else 0) + int(np.count_nonzero(finite == lowest))
        self.at_highest = (self.at_highest if highest == self.highest else 0) + int(np.count_nonzero(finite == highest))
        self.lowest, self.highest = lowest, highest
        self.total, self.count = self.total + float(finite.sum()), self.count + finite.size

    def levels(self) -> Levels:
        """Return the levels of all blocks."""
        has_samples = self.count > 0
        return Levels(
            lowest=self.lowest if has_samples else np.nan,
            mean=self.total / self.count if has_samples else np.nan,
            highest=self.highest if has_samples else np.nan,
            at_lowest=self.at_lowest / self.count if has_samples else 0.0,
            at_highest=self.at_highest / self.count if has_samples else 0.0,
            missing=self.channel.count - self.count,
            is_pulses=self.is_pulses,
        )


def levels_of(channels: Sequence[Channel], *, reach: Callable[[float], None] | None = None) -> list[Levels]:
    """Return the levels of channels, read once, block by block: some formats have all channels in one record.

    Parameters
    ----------
    channels
        The channels of a recording.
    reach
        Is told the share that is done, 0 to 1.

    Raises
    ------
    RecordingError
        If the file cannot be read.
    """
    counted = [_Counted(channel) for channel in channels]
    most = max((channel.count for channel in channels), default=0)
    for start in range(0, most, BLOCK_SAMPLES):
        for item in counted:
            if start < item.channel.count:
                item.add(start)
        if reach is not None:
            reach(min((start + BLOCK_SAMPLES) / most, 1.0))
    return [item.levels() for item in counted]


def _are_pulses(values: FloatArray) -> bool:
    """Return whether values stand at two levels, and cross the middle between them at least four times."""
    low, high = (float(level) for level in np.percentile(values, [0.5, 99.5]))
    if not high > low:
        return False
    share = (values - low) / (high - low)
    between = float(np.mean((share > BETWEEN[0]) & (share < BETWEEN[1])))
    crossings = int(np.count_nonzero(np.diff(share > 0.5)))
    return between < MOST_BETWEEN and crossings >= FEWEST_CROSSINGS
