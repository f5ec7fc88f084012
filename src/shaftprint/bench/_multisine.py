"""A planned input: sines in octaves, as large as the limits of a bench allow."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray

# Lines in an octave, and the highest as a share of the rate.
LINES_AN_OCTAVE, HIGHEST_SHARE = 4, 0.1
# Sets of phases of which the one with the lowest peaks is taken.
PHASES = 40


@dataclass(frozen=True, kw_only=True, slots=True)
class Lines:
    """Lines of a period, in octaves of one amplitude each."""

    period: int
    """Samples a period."""
    orders: IntArray
    """Periods of each line in one period, ascending, shape (lines,)."""
    octaves: IntArray
    """Octave of each line, shape (lines,)."""

    @classmethod
    def of(cls, period: int) -> "Lines":
        """Return odd lines up to a tenth of the rate: what a gain that depends on direction adds falls beside them."""
        highest = max(HIGHEST_SHARE * period, 1.0)
        count = math.floor(LINES_AN_OCTAVE * math.log2(highest)) + 1
        spaced = 2.0 ** (np.arange(count) / LINES_AN_OCTAVE)
        orders = np.unique(2 * (spaced // 2).astype(np.int64) + 1)
        orders = orders[orders <= highest]
        return cls(period=period, orders=orders, octaves=np.floor(np.log2(orders)).astype(np.int64))

    @property
    def count(self) -> int:
        """Number of octaves."""
        return int(self.octaves[-1]) + 1

    def shape(self, weights: Sequence[float], fastest: float | None, rate_hz: float) -> FloatArray:
        """Return a period with the lowest peak that was found, in value or rate, whichever binds; shape (samples,).

        ``weights``: amplitude of each octave. ``fastest``: largest change in a second where the largest value is 1.
        """
        sizes = np.asarray(weights, dtype=np.float64)[self.octaves]
        # lines of one octave share its amplitude
        sizes = sizes / np.sqrt(np.bincount(self.octaves)[self.octaves])
        turn = 2.0 * math.pi * np.outer(self.orders, np.arange(self.period)) / self.period
        rng = np.random.default_rng(1)
        best, lowest = np.zeros(self.period), math.inf
        power = np.cumsum(sizes**2) / np.sum(sizes**2)
        for draw in range(PHASES):
            # the first are those of Schroeder, which sweep through the lines by their power
            phases = (
                -2.0 * math.pi * np.cumsum(np.concatenate([[0.0], power[:-1]]) * np.diff(self.orders, prepend=0))
                if draw == 0
                else rng.uniform(0.0, 2.0 * math.pi, self.orders.size)
            )
            values = sizes @ np.cos(turn + phases[:, None])
            peak = float(np.abs(values).max())
            if fastest is not None:
                peak = max(peak, float(np.abs(np.diff(values, append=values[:1])).max()) * rate_hz / fastest)
            if peak < lowest:
                best, lowest = values / peak, peak
        # begins where it passes the middle
        return np.roll(best, -int(np.argmin(np.abs(best))))
