"""The way of the thesis, step by step, to compare with on the same recording.

"Fingerprinting II", section 3.1: pulse periods between whole samples (eq. 3.1), the previous neighbour
when the rate is lowered, no filter before it, a plain line through the steady levels (eq. 3.2).
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals.conditioning._decimate import SampleGrid

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals.pulses._pulses import PulseTrain

# A rounding error must not push what lies on a sample to the next one.
_ROUNDING = 1e-6


def previous_neighbours(samples: Iterable[FloatArray], grid: SampleGrid) -> FloatArray:
    """Return the last sample at or before each instant of the grid, shape (grid.count,).

    Before the first sample the first one is taken, after the last one the last.
    """
    out = np.empty(grid.count)
    origin, done = 0, 0
    last = np.nan
    for block in samples:
        origin += block.size
        # a few instants too many, of which those beyond the block wait for the next one
        reach = min(grid.count, int((origin - grid.first) / grid.step) + 2)
        instants = np.arange(done, max(reach, done))
        index = np.floor(grid.first + grid.step * instants + _ROUNDING).astype(np.int64)
        index = np.maximum(index[index < origin], 0)
        out[done : done + index.size] = block[index - origin + block.size]
        done, last = done + index.size, block[-1]
    out[done:] = last
    return out


def pulse_period_speed(
    train: "PulseTrain",
    strips: int,
    channel: "Channel",
    *,
    start_s: float,
    step_s: float,
    count: int,
) -> FloatArray:
    """Return the speed from the last whole pulse period at each instant [rev/s], shape (count,).

    A period in which a pulse is missing gets the mean of its neighbours, as outliers do.

    Parameters
    ----------
    train
        Numbered pulses; the first whole sample of each pulse is taken.
    strips
        Pulses a revolution; the angles between the strips are taken as equal, but for the gaps of a wheel.
    channel
        The channel, for its clock.
    start_s, step_s, count
        The grid [s]. Before the second pulse the first period is taken.
    """
    quantised = np.ceil(train.position - _ROUNDING)
    nominal = train.nominal_rev
    # strips of which nothing is said are even
    per_turn = strips if nominal.size == 1 else 1.0 / nominal[train.number[:-1] % nominal.size]
    speed = channel.rate_hz / (np.diff(quantised) * per_turn)
    complete = np.diff(train.number) == 1
    index = np.arange(speed.size)
    speed[~complete] = np.interp(index[~complete], index[complete], speed[complete])
    # the instant from which each period is the last whole one; the first serves from the beginning
    ends_s = channel.start_s + quantised[2:] / channel.rate_hz
    instant = np.ceil((ends_s - start_s) / step_s - _ROUNDING).astype(np.int64)
    border = np.concatenate([[0], np.clip(instant, 0, count), [count]])
    return np.repeat(speed, np.diff(border))
