"""From the logger's rate to the grid of the signals: a linear-phase low-pass filter without its delay.

A windowed sinc with a Kaiser window (Oppenheim and Schafer, "Discrete-Time Signal Processing",
section 7.5.3). For 200 Hz out: flat within 1e-4 up to 40 Hz, more than 80 dB down from 100 Hz on, so
that nothing folds. It is evaluated only at the instants of the grid, and directly there: a grid that
falls between the samples, because of a latency or another clock, costs nothing more.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.kernels._compiled import compiled

PASS_SHARE, STOP_SHARE = 0.2, 0.5
"""Ends of the pass band and beginning of the stop band, as shares of the rate of the grid."""

# Measured for 2000 to 200 Hz: 187 taps, ripple 8e-5, stop band 86 dB, 6 ns an incoming sample.
_ATTENUATION_DB = 88.0

# Places between two samples for which taps are kept: the error of the time is below rate / 1024.
_PHASES = 512
_NEGLIGIBLE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class SampleGrid:
    """Instants of an outgoing signal, in samples of the incoming one."""

    first: float
    """Place of the first instant [samples]."""
    step: float
    """From one instant to the next [samples]."""
    count: int
    """Number of instants."""

    @property
    def on_samples(self) -> bool:
        """Whether every instant falls on a sample."""
        return (
            abs(self.first - round(self.first)) < _NEGLIGIBLE
            and abs(self.step - round(self.step)) * self.count < _NEGLIGIBLE * 1e3
        )


def reach_samples(step: float) -> int:
    """Return how many incoming samples on either side one outgoing value depends on."""
    width = 2.0 * math.pi * (STOP_SHARE - PASS_SHARE) / step
    return math.ceil((_ATTENUATION_DB - 7.95) / (2.285 * width) / 2.0)


def low_pass_taps(step: float, phases: int) -> FloatArray:
    """Return the taps of the filter, shape (phases, taps); each row adds up to 1.

    ``step``: incoming samples for one outgoing. ``phases``: row ``k`` gives the value ``k / phases`` of a sample after
    the sample in the middle, which is column ``(taps - 1) // 2``.
    """
    half = reach_samples(step)
    beta = 0.1102 * (_ATTENUATION_DB - 8.7)
    cutoff = (PASS_SHARE + STOP_SHARE) / step
    last = half if phases == 1 else half + 1
    offset = np.arange(-half, last + 1) - np.arange(phases)[:, np.newaxis] / phases
    inside = np.clip(1.0 - (offset / (half + 1.0)) ** 2, 0.0, None)
    taps: FloatArray = np.sinc(cutoff * offset) * np.i0(beta * np.sqrt(inside))
    taps[inside == 0.0] = 0.0
    taps /= taps.sum(axis=1, keepdims=True)
    return taps


def decimated(samples: Iterable[FloatArray], grid: SampleGrid, *, channel: str) -> FloatArray:
    """Return the low-passed signal at the instants of the grid, shape (grid.count,).

    ``samples``: consecutive blocks; the result is the same, bit for bit, for any cut into blocks. Beyond both ends the
    first and last values go on. ``grid``: instants, in samples since the first. ``channel``: name of the channel, for
    messages. Raises SignalError if the grid is finer than the samples.
    """
    if grid.step < 1.0:
        raise SignalError(
            f"channel {channel}: expected at least the rate of the signals, "
            f"found {grid.step:.3g} times as many samples; lower the rate of the signals."
        )
    taps = low_pass_taps(grid.step, 1 if grid.on_samples else _PHASES)
    half = (taps.shape[1] - 1) // 2
    out = np.empty(grid.count)
    before = max(0, math.ceil(half - grid.first))
    held, origin, done, total = np.empty(0), -before, 0, 0
    last = np.nan
    for block in samples:
        head = np.full(before if total == 0 else 0, block[0])
        held = np.concatenate([held, head, block])
        total += block.size
        last = block[-1]
        done = filter_grid(held, origin, taps, half, grid.first, grid.step, done, out)
        needed = math.floor(grid.first + done * grid.step) - half - 1
        dropped = min(max(needed - origin, 0), held.size)
        held, origin = held[dropped:], origin + dropped
    final = math.ceil(grid.first + grid.count * grid.step) + taps.shape[1]
    held = np.concatenate([held, np.full(max(final - origin - held.size, 0), last)])
    filter_grid(held, origin, taps, half, grid.first, grid.step, done, out)
    return out


@compiled(nogil=True, fastmath={"reassoc", "contract"})
def filter_grid(  # type: ignore[no-untyped-def]
    held, origin: int, taps, half: int, first: float, step: float, done: int, out
) -> int:
    """Write the instants that the held samples reach, from number ``done`` on; return the next."""
    phases, length = taps.shape
    while done < out.size:
        position = first + done * step
        middle = int(np.floor(position + 1e-9))
        phase = int(np.rint((position - middle) * phases))
        if phase >= phases:
            phase -= phases
            middle += 1
        begin = middle - half - origin
        if begin + length > held.size:
            break
        # one-dimensional slices: the compiler then multiplies eight taps at a time
        row = taps[phase]
        window = held[begin : begin + length]
        total = 0.0
        for k in range(row.size):
            total += window[k] * row[k]
        out[done] = total
        done += 1
    return done
