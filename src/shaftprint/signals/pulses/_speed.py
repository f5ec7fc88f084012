"""Speed from the angles at which pulses begin: the derivative of an interpolating cubic spline.

The knots are (time of the pulse, angle of the shaft); the derivative is the speed at every instant,
neither averaged over a revolution nor late. The equations for the slopes at the knots are those of
de Boor, "A Practical Guide to Splines", chapter IV (cubic spline interpolation).
"""

from collections.abc import Iterator

import numpy as np

from shaftprint.arrays import FloatArray

# Instants that are calculated together: few enough for the processor's cache.
_TOGETHER = 16_384


def spline_speed(time_s: FloatArray, angle_rev: FloatArray, *, start_s: float, step_s: float, count: int) -> FloatArray:
    """Return the speed on a uniform grid [rev/s], shape (count,).

    Parameters
    ----------
    time_s
        When each pulse begins [s], shape (pulses,), strictly ascending, at least 3.
    angle_rev
        Angle of the shaft then [rev], shape (pulses,).
    start_s, step_s, count
        The grid. Before the first and after the last pulse the speed there is held.
    """
    slope = knot_slopes(time_s, angle_rev)
    speed = np.empty(count)
    for first in range(0, count, _TOGETHER):
        instants = np.arange(first, min(first + _TOGETHER, count), dtype=np.int64)
        position = np.asarray(start_s + step_s * instants, dtype=np.float64)
        speed[instants] = sampled_slopes(time_s, angle_rev, slope, position)
    return speed


def spline_speeds(
    time_s: FloatArray, angle_rev: FloatArray, *, start_s: float, step_s: float, count: int, block: int
) -> Iterator[FloatArray]:
    """Yield the speed on a uniform grid [rev/s] in blocks, as ``spline_speed`` gives it."""
    slope = knot_slopes(time_s, angle_rev)
    for first in range(0, count, block):
        instants = np.arange(min(block, count - first))
        position = np.asarray(start_s + first * step_s + step_s * instants, dtype=np.float64)
        yield sampled_slopes(time_s, angle_rev, slope, position)


def knot_slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the slope of the spline at each knot, shape (knots,).

    At both ends the second derivative is that of the next knot.
    """
    inverse = 1.0 / np.diff(x)
    chord = np.diff(y) * inverse
    before, after = inverse[:-1], inverse[1:]
    return _solved(
        np.concatenate([[0.0], before, [1.0]]),
        np.concatenate([[1.0], 2.0 * (before + after), [1.0]]),
        np.concatenate([[1.0], after, [0.0]]),
        np.concatenate([[2.0 * chord[0]], 3.0 * (chord[:-1] * before + chord[1:] * after), [2.0 * chord[-1]]]),
    )


def _solved(lower: FloatArray, diagonal: FloatArray, upper: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solution of tridiagonal equations by cyclic reduction; ``lower[0]`` and ``upper[-1]`` are 0.

    Each row takes its unknown out of both neighbours, every second row at a time, as none of them has to be exchanged
    with another: the diagonal rules.
    """
    if diagonal.size == 1:
        return right / diagonal
    rows = np.array([lower, diagonal, upper, right])
    even, odd = rows[:, ::2], rows[:, 1::2]
    count, between = even.shape[1], odd.shape[1]
    ahead, behind = even[2, :between] / odd[1], even[0, 1:] / odd[1, : count - 1]
    left = np.array([np.zeros(count), even[1], np.zeros(count), even[3]])
    left[1:, :between] -= ahead * odd[[0, 2, 3]]
    left[[0, 1, 3], 1:] -= behind * odd[[0, 2, 3], : count - 1]
    solution = np.empty(diagonal.size)
    solution[::2] = _solved(*left)
    following = np.zeros(between)
    following[: count - 1] = solution[2::2]
    solution[1::2] = (odd[3] - odd[0] * solution[: 2 * between : 2] - odd[2] * following) / odd[1]
    return solution


def sampled_slopes(x: FloatArray, y: FloatArray, slope: FloatArray, position: FloatArray) -> FloatArray:
    """Return the derivative of the spline at ascending positions; beyond its ends it is held."""
    if not position.size:
        return np.empty(0)
    first, last = np.clip(np.searchsorted(x, position[[0, -1]]) - 1, 0, x.size - 2).tolist()
    knots = slice(first, last + 2)
    x, slope = x[knots], slope[knots]
    width = np.diff(x)
    chord = np.diff(y[knots]) / width
    # knots are fewer than instants, and looked for among them
    k = np.repeat(
        np.arange(width.size), np.diff(np.searchsorted(position, x[1:-1], "right"), prepend=0, append=position.size)
    )
    u = np.clip((position - x[k]) / width[k], 0.0, 1.0)
    return np.asarray(
        6.0 * u * (1.0 - u) * chord[k] + (1.0 - u) * (1.0 - 3.0 * u) * slope[k] + u * (3.0 * u - 2.0) * slope[k + 1]
    )
