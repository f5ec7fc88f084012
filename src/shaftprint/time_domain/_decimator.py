"""Fewer samples a second, without delay: one low pass for data and for the simulated signals they are compared with.

The step from ``every`` samples to one is in the middle of the filter's slope: the band above half the new rate is not
removed before its mirror image is folded in, so that together they are as strong as before, and the noise of the new
samples has no empty band. A filter that removes all that could fold leaves such a band, and a whitening filter would
multiply what rounding has left there by thousands. The signals have nothing to fold: set points of tests end near
4 Hz, and what a simulation has there is folded as in the data.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from shaftprint.arrays import FloatArray, frozen_float

# Ends of the pass band and beginning of the stop band, as shares of the new rate; -6 dB in their middle.
PASS_SHARE, STOP_SHARE = 0.4, 0.6
ATTENUATION_DB = 70.0
# New samples of one product of matrices: few zeros in it, and few products.
TOGETHER = 8


@dataclass(frozen=True, kw_only=True, slots=True)
class Decimator:
    """A symmetric low pass that is evaluated at every so many samples only."""

    every: int
    """Old samples for a new one; with 1 nothing is done."""

    @property
    def half(self) -> int:
        """Old samples that a new one needs on either side of its own time."""
        if self.every == 1:
            return 0
        width = 2.0 * math.pi * (STOP_SHARE - PASS_SHARE) / self.every
        return math.ceil((ATTENUATION_DB - 7.95) / (2.285 * width) / 2.0)

    @property
    def taps(self) -> FloatArray:
        """Weights of the old samples, shape (2 half + 1,); they add up to 1.

        A sinc with a Kaiser window (Oppenheim and Schafer, Discrete-Time Signal Processing, section 7.5.3).
        """
        return _taps(self.every, self.half)

    def filtered(self, values: FloatArray) -> FloatArray:
        """Return new samples, shape (..., new samples), from old ones, shape (..., old samples).

        The first new sample stands at old sample ``half``; the last where ``half`` old samples still follow it.
        """
        if self.every == 1:
            return values
        rows = values.reshape(-1, values.shape[-1])
        return self.thinned(rows.T).T.reshape(*values.shape[:-1], -1)

    def thinned(self, values: FloatArray) -> FloatArray:
        """Return the same in columns, shape (new samples, channels) from (old samples, channels).

        A few new samples at a time are one product of matrices, with the old samples where they are: a tenth of the
        time of one new sample after the other.
        """
        if self.every == 1:
            return values
        count = max((values.shape[0] - 2 * self.half - 1) // self.every + 1, 0)
        blocks_end = count - count % TOGETHER
        samples = np.empty((count, values.shape[1]))
        self._multiplied(values, samples[:blocks_end].reshape(blocks_end // TOGETHER, TOGETHER, values.shape[1]))
        self._multiplied(values[blocks_end * self.every :], samples[blocks_end:][None])
        return samples

    def _multiplied(self, values: FloatArray, blocks: FloatArray) -> None:
        """Write new samples into blocks of the same length, shape (blocks, new samples of one, channels)."""
        size, taps = blocks.shape[1], self.taps
        if not blocks.size:
            return
        weights = np.zeros((size, (size - 1) * self.every + taps.size))
        for row in range(size):
            weights[row, row * self.every : row * self.every + taps.size] = taps
        windows = sliding_window_view(values, weights.shape[1], axis=0)[:: size * self.every]
        np.matmul(weights, windows[: blocks.shape[0]].swapaxes(1, 2), out=blocks)


@lru_cache(maxsize=64)
def _taps(every: int, half: int) -> FloatArray:
    """Return the weights, which thousands of short records ask for, read-only."""
    if half == 0:
        return frozen_float(np.ones(1))
    sample = np.arange(-half, half + 1)
    window = np.i0(0.1102 * (ATTENUATION_DB - 8.7) * np.sqrt(1.0 - (sample / (half + 1.0)) ** 2))
    taps = np.sinc((PASS_SHARE + STOP_SHARE) / every * sample) * window
    return frozen_float(taps / taps.sum())
