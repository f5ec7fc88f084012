"""Where the crests of a channel are cut off, whatever full scale a file states.

A channel with noise comes to its highest and its lowest value once or twice. One that is cut off comes there many times
more often than to the values beside it, or stays there each time.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import Counts
from shaftprint.signals.conditioning._outliers import GOOD, HOLD, SPIKE

# The value at an end is held against so many beside it, of which it is visited so many times more often.
_BESIDE, _TIMES, _LEAST_VISITS = 10, 5.0, 20
# A telemetry that lost its value may hold it at the highest there is: once, not three times.
_LEAST_HOLDS = 3


@dataclass(slots=True)
class CutOff:
    """The values at one end of a channel and how often it comes to them; samples go by in blocks."""

    side: int
    """1: the highest values; -1: the lowest."""
    _levels: FloatArray = field(default_factory=lambda: np.empty(0), init=False)
    _visits: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64), init=False)
    _samples: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, dtype=np.int64), init=False)
    _before: float = field(default=np.nan, init=False)

    def add(self, counts: Counts, codes: NDArray[np.uint8]) -> None:
        """Take the next samples; those that cannot be true do not count, but for held ones."""
        near = codes != SPIKE
        if self._levels.size > _BESIDE:
            end = counts.dtype.type(self.side * self._levels[0])
            near &= counts >= end if self.side > 0 else counts <= end
        index = np.flatnonzero(near)
        index = index[(codes[index] == GOOD) | (codes[index] == HOLD)]
        values, previous = (self.side * counts[where].astype(np.float64) for where in (index, index - 1))
        if index.size and index[0] == 0:
            previous[0] = self._before
        if counts.size:
            self._before = self.side * float(counts[-1])
        levels, where = np.unique(np.concatenate([self._levels, values]), return_inverse=True)
        old, new = where[: self._levels.size], where[self._levels.size :]
        visits, samples = np.bincount(new, minlength=levels.size), np.bincount(new, minlength=levels.size)
        visits -= np.bincount(new[values == previous], minlength=levels.size)
        visits[old] += self._visits
        samples[old] += self._samples
        keep = slice(-(_BESIDE + 1), None)
        self._levels, self._visits, self._samples = levels[keep], visits[keep], samples[keep]

    def level(self, hold_samples: int) -> float | None:
        """Return the value at which crests are cut off; None where they are not.

        ``hold_samples``: smallest number of equal samples in a row that is a hold; 0 where holds are not looked for.
        """
        if self._levels.size <= _BESIDE:
            return None
        visits, samples = int(self._visits[-1]), int(self._samples[-1])
        often = visits >= _LEAST_VISITS and visits > _TIMES * float(np.median(self._visits[:-1]))
        long = visits >= _LEAST_HOLDS and 0 < hold_samples * visits <= samples
        return self.side * float(self._levels[-1]) if often or long else None
