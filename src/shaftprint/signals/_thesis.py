"""The way of the thesis, step by step, to compare with on the same recording.

"Fingerprinting II", section 3.1: pulse periods between whole samples (eq. 3.1), the previous neighbour
when the rate is lowered, no filter before it, a plain line through the steady levels (eq. 3.2).
"""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals._decimate import Grid

if TYPE_CHECKING:
    from shaftprint.recording import Channel
    from shaftprint.signals._pulses import PulseTrain


def previous_neighbours(samples: Iterable[FloatArray], grid: Grid) -> FloatArray:
    """Return the last sample at or before each instant of the grid, shape (grid.count,).

    Before the first sample the first one is taken, after the last one the last.
    """
    place = np.floor(grid.first + grid.step * np.arange(grid.count) + 1e-6).astype(np.int64)
    np.maximum(place, 0, out=place)
    out = np.empty(grid.count)
    origin, done = 0, 0
    last = np.nan
    for block in samples:
        stop = int(np.searchsorted(place, origin + block.size))
        out[done:stop] = block[place[done:stop] - origin]
        origin, done, last = origin + block.size, stop, block[-1]
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
        Pulses a revolution; the angles between the strips are taken as equal.
    channel
        The channel, for its clock.
    start_s, step_s, count
        The grid [s]. Before the second pulse the first period is taken.
    """
    # a rounding error must not push an edge that lies on a sample to the next one
    quantised = np.ceil(train.position - 1e-6)
    speed = channel.rate_hz / (np.diff(quantised) * strips)
    whole = np.diff(train.number) == 1
    place = np.arange(speed.size)
    speed[~whole] = np.interp(place[~whole], place[whole], speed[whole])
    instants = start_s + step_s * np.arange(count)
    ends = channel.start_s + quantised[1:] / channel.rate_hz
    ended = np.searchsorted(ends, instants + 1e-9, side="right") - 1
    out: FloatArray = speed[np.maximum(ended, 0)]
    return out
