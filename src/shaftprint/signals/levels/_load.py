"""The shaft torque at the mean load of a whole recording, and how far that may be from the mean of the ship.

The load of a propeller, torque over the square of the speed, wanders by a per cent over tens of seconds: recirculating
water, wake, current. A quiet stretch of half a minute says next to nothing of its mean. Every second of the recording
says something: over a block of time, with ``u`` the speed over that of the working point, mean torque and speed obey

    mean(M_s) = M_s0 (1 + w) mean(u^2) + J (u_end - u_begin) / length + z (1 - mean(u^2))

however the speed moves. ``w`` is the wander, ``J`` accelerates what is behind the gauge, ``z`` is what the gauge shows
without torque. Divided by ``mean(u^2)`` it is a line whose value at the working point is ``M_s0``, and whose
disturbance is the wander, of which nothing is known beforehand (``_wander.py``).
"""

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, in_blocks
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals.levels._wander import fit_through_wander

# Blocks are this long, and longer where there would be too many; shorter ones where few are near the working point.
BLOCKS_S = (10.0, 5.0, 2.5, 1.0)
MOST_BLOCKS = 150
FEWEST_BLOCKS = 12
# Blocks in which the speed leaves the working point by more than this share say nothing of the torque there.
REACH = 0.3
# Less than this of a column is noise: change of speed a second, and spread of its square.
LEAST_CHANGE, LEAST_SPREAD = 1e-3, 0.02


def torque_of_mean_load(
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    *,
    about_rev_s: float,
    rate_hz: float,
    start_s: float = 0.0,
    coverage: Coverage = EVERYTHING,
) -> tuple[float, float]:
    """Return the shaft torque at a speed under the mean load [N m], and its standard deviation.

    ``speed_rev_s``, ``torque_nm``: engine speed and shaft torque on the grid, shape (samples,). ``about_rev_s``: engine
    speed of the working point [rev/s]. ``rate_hz``, ``start_s``: the grid. ``coverage``: says where the gaps are.
    Raises SignalError if the speed is hardly ever near the working point.
    """
    speed = speed_rev_s / about_rev_s
    longest = max(BLOCKS_S[0], speed.size / rate_hz / MOST_BLOCKS)
    for block_s in (longest, *BLOCKS_S[1:]):
        length = max(round(block_s * rate_hz), 2)
        begins = start_s + np.arange(speed.size // length) * length / rate_hz
        complete = np.array(
            [not coverage.missing(begin, begin + length / rate_hz) for begin in begins.tolist()], dtype=bool
        )
        values, columns, near = _blocks(speed, torque_nm, length, rate_hz, complete)
        if values.size >= FEWEST_BLOCKS:
            break
    line = fit_through_wander(values, columns, begins[near], begins[near] + length / rate_hz)
    return float(line.value[0]), float(line.std[0])


def _blocks(
    speed: FloatArray, torque_nm: FloatArray, length: int, rate_hz: float, whole: BoolArray
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return torque over the mean square of the speed and the columns of the line of some blocks, and of which."""
    count = speed.size // length
    parts = in_blocks(speed, length)
    torque = in_blocks(torque_nm, length).mean(axis=1)
    # block by block, as the speed is as long as the recording
    square = np.array([np.mean(part**2) for part in parts])
    near = whole & (parts.max(axis=1) - 1.0 <= REACH) & (1.0 - parts.min(axis=1) <= REACH)
    # a sample stands for its surroundings: the border of two blocks is halfway between samples
    border = np.arange(count + 1) * length
    at_border = 0.5 * (speed[np.maximum(border - 1, 0)] + speed[np.minimum(border, speed.size - 1)])
    change = np.diff(at_border) * rate_hz / length
    moving = change if np.abs(change[near]).max(initial=0.0) > LEAST_CHANGE else np.zeros(count)
    away = 1.0 / square - 1.0
    spread = away if near.any() and np.ptp(away[near]) > LEAST_SPREAD else np.zeros(count)
    columns = np.column_stack([np.ones(count), moving / square, spread])
    return (torque / square)[near], columns[near], near
