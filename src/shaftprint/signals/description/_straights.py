"""Straight stretches of the set point: levels and ramps."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals.description._course import Course
from shaftprint.signals.description._pieces import Straight

# The shortest straight piece [s]; by how much one is tried longer than the one before it.
SHORTEST_S, _GROWTH = 0.4, 1.2
# Residual of a straight piece: standard deviations of noise, and share of all motion.
_STDS, _SHARE = 3.0, 0.0015


def straight_from(course: Course, first: int, stop: int) -> Straight | None:
    """Return the longest straight piece that begins at a sample; None where there is none."""
    shortest = max(round(SHORTEST_S * course.rate_hz), 8)
    tolerance = _STDS * course.noise_v + _SHARE * course.range_v
    if stop - first < shortest:
        return None
    best, count, step = 0, shortest, 0
    while True:
        count = min(count, stop - first)
        if not _is_straight(course.values_v[first : first + count], tolerance):
            break
        best = count
        if count == stop - first:
            break
        count = max(round(count * _GROWTH), count + 1)
    if not best:
        return None
    # between the longest that fits and the shortest that does not, by halves
    step = max(count - best, 1) // 2
    while step:
        if best + step <= stop - first and _is_straight(course.values_v[first : first + best + step], tolerance):
            best += step
        step //= 2
    time = course.times(first, first + best)
    middle_s = 0.5 * float(time[0] + time[-1])
    slope, middle = np.polyfit(time - middle_s, course.values_v[first : first + best], 1)
    level = abs(slope) * best / course.rate_hz <= course.flat_v
    return Straight(
        begin_s=float(time[0]),
        end_s=float(time[-1]) + 1.0 / course.rate_hz,
        middle_s=middle_s,
        middle_v=float(middle),
        slope_v_per_s=0.0 if level else float(slope),
    )


def _is_straight(values: FloatArray, tolerance_v: float) -> bool:
    """Return whether values lie on a line, their last quarter too."""
    place = np.arange(values.size) - 0.5 * (values.size - 1)
    slope = float(place @ values) / float(place @ place)
    residual = values - values.mean() - slope * place
    tail = residual[-max(values.size // 4, 4) :]
    return float(np.sqrt(np.mean(residual**2))) <= tolerance_v and abs(float(tail.mean())) <= tolerance_v
