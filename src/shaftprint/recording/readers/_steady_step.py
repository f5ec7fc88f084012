"""The step of a clock whose first or last times are strays: they would tilt the rate that the ends of a file give."""

from collections.abc import Callable

import numpy as np

from shaftprint.arrays import FloatArray

# So many times at either end are looked at.
_TIMES = 1000
# A time at an end is a stray that is further off the others than this part of a step, and than so many of their
# usual distances.
_STRAY, _STRAY_SCATTERS = 0.02, 6.0


def without_stray_ends(
    count: int, even: Callable[[int, int], tuple[FloatArray, FloatArray]], first_s: float, step_s: float
) -> tuple[float, float]:
    """Return where a clock begins, and its step [s]; those that are given where both ends lie on the others' line.

    ``count``: number of rows. ``even``: gives the places on the clock of the rows [start, stop) and their times without
    jumps [s]. ``first_s``, ``step_s``: what the first row and the last give [s].
    """
    some = min(_TIMES, count // 2)
    if some < 3:
        return first_s, step_s
    (begins, begin_s), (ends, end_s) = even(0, some), even(count - some, count)
    # half of the pairs may be strays
    steady_s = float(np.median((end_s - begin_s) / (ends - begins)))
    off_s = np.concatenate([begin_s - begins * steady_s, end_s - ends * steady_s])
    start_s = float(np.median(off_s))
    off_s = np.abs(off_s - start_s)
    if max(off_s[0], off_s[-1]) <= max(_STRAY * steady_s, _STRAY_SCATTERS * float(np.median(off_s))):
        return first_s, step_s
    return start_s, steady_s
