"""Speed from the angles at which pulses begin: the derivative of an interpolating cubic spline.

The knots are (time of the pulse, angle of the shaft); the derivative is the speed at every instant,
neither averaged over a revolution nor late. The equations for the slopes at the knots are those of
de Boor, "A Practical Guide to Splines", chapter IV (cubic spline interpolation).
"""

from collections.abc import Iterator

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.kernels._compiled import compiled


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
    slope = np.empty(time_s.size)
    solve_slopes(time_s, angle_rev, slope)
    speed = np.empty(count)
    sample_slopes(time_s, angle_rev, slope, start_s, step_s, speed)
    return speed


def spline_speeds(
    time_s: FloatArray, angle_rev: FloatArray, *, start_s: float, step_s: float, count: int, block: int
) -> Iterator[FloatArray]:
    """Yield the speed on a uniform grid [rev/s] in blocks, as ``spline_speed`` gives it."""
    slope = np.empty(time_s.size)
    solve_slopes(time_s, angle_rev, slope)
    for first in range(0, count, block):
        speed = np.empty(min(block, count - first))
        begin_s = start_s + first * step_s
        # from the knot before the block on
        knots = slice(min(max(int(np.searchsorted(time_s, begin_s)) - 1, 0), time_s.size - 2), None)
        sample_slopes(time_s[knots], angle_rev[knots], slope[knots], begin_s, step_s, speed)
        yield speed


@compiled(nogil=True)
def solve_slopes(x, y, slope) -> None:  # type: ignore[no-untyped-def]
    """Write the slope of the spline at each knot, by elimination in the tridiagonal equations.

    At both ends the second derivative is that of the next knot.
    """
    last = x.size - 1
    upper = np.empty(x.size)
    upper[0] = 1.0
    slope[0] = 2.0 * (y[1] - y[0]) / (x[1] - x[0])
    for k in range(1, last):
        before = 1.0 / (x[k] - x[k - 1])
        after = 1.0 / (x[k + 1] - x[k])
        right = 3.0 * ((y[k] - y[k - 1]) * before * before + (y[k + 1] - y[k]) * after * after)
        pivot = 2.0 * (before + after) - before * upper[k - 1]
        upper[k] = after / pivot
        slope[k] = (right - before * slope[k - 1]) / pivot
    right = 2.0 * (y[last] - y[last - 1]) / (x[last] - x[last - 1])
    slope[last] = (right - slope[last - 1]) / (1.0 - upper[last - 1])
    for k in range(last - 1, -1, -1):
        slope[k] -= upper[k] * slope[k + 1]


@compiled(nogil=True)
def sample_slopes(x, y, slope, start: float, step: float, out) -> None:  # type: ignore[no-untyped-def]
    """Write the derivative of the spline on a uniform grid."""
    last = x.size - 1
    k = 0
    for j in range(out.size):
        position = start + j * step
        if position <= x[0]:
            out[j] = slope[0]
        elif position >= x[last]:
            out[j] = slope[last]
        else:
            while x[k + 1] < position:
                k += 1
            width = x[k + 1] - x[k]
            u = (position - x[k]) / width
            chord = (y[k + 1] - y[k]) / width
            out[j] = (
                6.0 * u * (1.0 - u) * chord
                + (1.0 - u) * (1.0 - 3.0 * u) * slope[k]
                + u * (3.0 * u - 2.0) * slope[k + 1]
            )
