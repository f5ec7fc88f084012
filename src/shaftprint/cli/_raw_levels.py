"""What the raw channels of a recording hold, before a vessel file says what they are."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording import Channel

BLOCK_SAMPLES = 262_144

# A pick-up's pulse rises within a sample or two, of which it has four to thirty.
BETWEEN = (0.2, 0.8)
MOST_BETWEEN = 0.15
FEWEST_CROSSINGS = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class Levels:
    """Levels of one channel in its unit."""

    lowest: float
    """Smallest value [unit]; not a number where there is none."""
    mean: float
    """Mean [unit]; not a number where there is none."""
    highest: float
    """Largest value [unit]; not a number where there is none."""
    not_numbers: int
    """How many samples are not finite."""
    is_pulses: bool
    """Whether almost all values lie near the lowest or the highest, and few of them near one of these."""


def levels_of(channel: Channel) -> Levels:
    """Return the levels of a channel, read once in blocks.

    Raises
    ------
    RecordingError
        If the file cannot be read.
    """
    lowest, highest, total, count = np.inf, -np.inf, 0.0, 0
    first: FloatArray | None = None
    for start in range(0, channel.count, BLOCK_SAMPLES):
        values = channel.values(start, min(start + BLOCK_SAMPLES, channel.count))
        finite = values[np.isfinite(values)]
        if finite.size:
            first = finite if first is None else first
            lowest, highest = min(lowest, float(finite.min())), max(highest, float(finite.max()))
            total, count = total + float(finite.sum()), count + finite.size
    if not count or first is None:
        return Levels(lowest=np.nan, mean=np.nan, highest=np.nan, not_numbers=channel.count, is_pulses=False)
    return Levels(
        lowest=lowest,
        mean=total / count,
        highest=highest,
        not_numbers=channel.count - count,
        is_pulses=_are_pulses(first),
    )


def _are_pulses(values: FloatArray) -> bool:
    """Return whether values stand at two levels, and cross the middle between them at least four times."""
    low, high = (float(level) for level in np.percentile(values, [0.5, 99.5]))
    if not high > low:
        return False
    share = (values - low) / (high - low)
    between = float(np.mean((share > BETWEEN[0]) & (share < BETWEEN[1])))
    crossings = int(np.count_nonzero(np.diff(share > 0.5)))
    return between < MOST_BETWEEN and crossings >= FEWEST_CROSSINGS
