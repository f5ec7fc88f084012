"""Lines of the torque over the turns of a shaft: what comes back with them stays one line however the speed moves.

The torque is read at equal steps of the angle instead of the time, part by part of a recording. A line has to stand in
most parts: what a test moves and what hums stand at other orders in each, as soon as the speed has moved.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.signals._gaps import Coverage

# Length of a part, how many there are at most, and how many tell anything.
_PART_S, _MOST_PARTS, _FEWEST_PARTS = 60.0, 40, 4
# In fewer than this share of the parts something may be missing.
_MOST_WITHOUT = 0.35
# Bins within which two lines are one, and the share of the rate up to which the grid is of use.
_RESOLUTION, _HIGHEST_SHARE_OF_RATE = 1.5, 0.4
# Bins on either side whose median is the noise at a line, and the power over it that noise never has.
_AROUND, _LEAST_POWER = 12, 8.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OrderLines:
    """Lines of the torque in periods for one turn."""

    order: FloatArray
    """Where they stand [1/turn], shape (lines,)."""
    size: FloatArray
    """Logarithm of their power over that of the noise beside them, shape (lines,)."""
    highest: float
    """The highest order that is looked at [1/turn]."""
    resolution: float
    """What is nearer to each other is one line [1/turn]."""


def order_lines(
    speed_rev_s: FloatArray, torque_nm: FloatArray, *, rate_hz: float, start_s: float, coverage: "Coverage"
) -> OrderLines | None:
    """Return the lines of the torque over the turns of a shaft; None where too little of the recording is whole.

    ``speed_rev_s``, ``torque_nm``: speed of the shaft, and torque, on the grid, shape (samples,). ``rate_hz``,
    ``start_s``: the grid. ``coverage``: what the recording covers; parts in a gap are left out.
    """
    length = min(round(_PART_S * rate_hz), torque_nm.size // (2 * _FEWEST_PARTS))
    begins = np.arange(0, torque_nm.size - length + 1, max(length // 2, 1))
    whole = [
        begin
        for begin in begins.tolist()
        if not coverage.missing(start_s + begin / rate_hz, start_s + (begin + length) / rate_hz)
        and speed_rev_s[begin : begin + length].min() > 0.0
    ]
    if len(whole) < _FEWEST_PARTS or length < 2:
        return None
    whole = [whole[place] for place in np.linspace(0, len(whole) - 1, min(len(whole), _MOST_PARTS)).astype(int)]
    fastest = max(float(speed_rev_s[begin : begin + length].max()) for begin in whole)
    turns = min(float(speed_rev_s[begin : begin + length].sum()) for begin in whole) / rate_hz
    # one step of angle is a sample where the shaft is fastest
    count = int(turns * rate_hz / fastest)
    at = np.arange(count) * fastest / rate_hz
    taper = np.hanning(count)
    powers = []
    for begin in whole:
        part = slice(begin, begin + length)
        angle = (np.cumsum(speed_rev_s[part]) - speed_rev_s[begin]) / rate_hz
        load = np.interp(at, angle, torque_nm[part] / speed_rev_s[part] ** 2)
        power = np.abs(np.fft.rfft((load - load.mean()) * taper)) ** 2
        middle = float(np.median(power))
        # of what stands still there is no noise to stand out of
        if middle > 0.0:
            powers.append(power / middle)
    if len(powers) < _FEWEST_PARTS:
        return None
    power = np.quantile(powers, _MOST_WITHOUT, axis=0)
    beside = np.pad(power, _AROUND, mode="reflect")
    noise = np.median(np.lib.stride_tricks.sliding_window_view(beside, 2 * _AROUND + 1), axis=1)
    ratio = power / np.maximum(noise, np.finfo(np.float64).tiny)
    inner = ratio[1:-1]
    place = 1 + np.flatnonzero((inner > _LEAST_POWER) & (inner >= ratio[:-2]) & (inner > ratio[2:]))
    step = rate_hz / (count * fastest)
    size = np.log(ratio[place])
    # a line stands at the top of the parabola through three bins
    below, above = np.log(ratio[place - 1]), np.log(ratio[place + 1])
    beside = 0.5 * (below - above) / (below - 2.0 * size + above)
    return OrderLines(
        order=np.asarray((place + beside) * step),
        size=size,
        highest=_HIGHEST_SHARE_OF_RATE * rate_hz / fastest,
        resolution=_RESOLUTION * step,
    )
