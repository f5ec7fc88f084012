"""What the raw channels of a recording hold, before a vessel file says what they are."""

from dataclasses import dataclass

import numpy as np

from shaftprint.recording import Channel

BLOCK_SAMPLES = 262_144


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


def levels_of(channel: Channel) -> Levels:
    """Return the levels of a channel, read once in blocks.

    Raises
    ------
    RecordingError
        If the file cannot be read.
    """
    lowest, highest, total, count = np.inf, -np.inf, 0.0, 0
    for start in range(0, channel.count, BLOCK_SAMPLES):
        values = channel.values(start, min(start + BLOCK_SAMPLES, channel.count))
        finite = values[np.isfinite(values)]
        if finite.size:
            lowest, highest = min(lowest, float(finite.min())), max(highest, float(finite.max()))
            total, count = total + float(finite.sum()), count + finite.size
    if not count:
        return Levels(lowest=np.nan, mean=np.nan, highest=np.nan, not_numbers=channel.count)
    return Levels(lowest=lowest, mean=total / count, highest=highest, not_numbers=channel.count - count)
