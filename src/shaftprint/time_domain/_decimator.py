"""Fewer samples a second, without delay: one low pass for data and for the simulated signals they are compared with.

The step from ``every`` samples to one is in the middle of the filter's slope: the band above half the new rate is not
removed before its mirror image is folded in, so that together they are as strong as before, and the noise of the new
samples has no empty band. A filter that removes all that could fold leaves such a band, and a whitening filter would
multiply what rounding has left there by thousands. The signals have nothing to fold: set points of tests end near
4 Hz, and what a simulation has there is folded as in the data.
"""

import math
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray

# Ends of the pass band and beginning of the stop band, as shares of the new rate; -6 dB in their middle.
PASS_SHARE, STOP_SHARE = 0.4, 0.6
ATTENUATION_DB = 70.0


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
        half = self.half
        if half == 0:
            return np.ones(1)
        place = np.arange(-half, half + 1)
        window = np.i0(0.1102 * (ATTENUATION_DB - 8.7) * np.sqrt(1.0 - (place / (half + 1.0)) ** 2))
        taps = np.sinc((PASS_SHARE + STOP_SHARE) / self.every * place) * window
        return np.asarray(taps / taps.sum())

    def filtered(self, values: FloatArray) -> FloatArray:
        """Return new samples, shape (..., new samples), from old ones, shape (..., old samples).

        The first new sample stands at old sample ``half``; the last where ``half`` old samples still follow it.
        """
        if self.every == 1:
            return values
        taps = self.taps
        count = (values.shape[-1] - taps.size) // self.every + 1
        rows = -(-taps.size // self.every)
        padded = np.zeros(rows * self.every)
        padded[: taps.size] = taps
        length = (count + rows - 1) * self.every
        short = max(length - values.shape[-1], 0)
        whole = np.concatenate([values, np.zeros((*values.shape[:-1], short))], axis=-1) if short else values
        blocks = whole[..., :length].reshape(*values.shape[:-1], -1, self.every)
        shares = blocks @ padded.reshape(rows, self.every).T
        return np.asarray(sum(shares[..., k : k + count, k] for k in range(rows)))
