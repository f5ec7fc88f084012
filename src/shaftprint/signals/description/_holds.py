"""Levels at which the set point stands, and the jumps between them."""

import numpy as np

from shaftprint.signals.description._course import Course
from shaftprint.signals.description._pieces import Stairs

# What stands for less is no level; what takes longer is no jump [s].
_SHORTEST_S, _LONGEST_JUMP_S = 0.08, 0.06
_JUMP_SHARE = 0.02


def stairs_from(course: Course, first: int, stop: int) -> Stairs | None:
    """Return the levels from a sample on, as long as the set point only stands and jumps; None without a jump.

    ``course``: the set point. ``first``, ``stop``: sample to begin with, and the one that is not looked at any more.
    """
    shortest = max(round(_SHORTEST_S * course.rate_hz), 3)
    across = max(round(_LONGEST_JUMP_S * course.rate_hz), 2)
    smallest_v = max(10.0 * course.noise_v, _JUMP_SHARE * course.range_v, 2.0 * course.flat_v)
    values = course.values_v
    levels: list[float] = []
    borders: list[float] = []
    place = first
    while place < stop:
        hold = _hold(course, place, min(place + across, stop), stop, shortest)
        if hold is None:
            break
        begin, end, level = hold
        if levels:
            if abs(level - levels[-1]) < smallest_v:
                break
            middle = 0.5 * (level + levels[-1])
            window = values[place - 1 : begin + 1] > middle
            change = np.flatnonzero(window[1:] != window[:-1])
            k = place - 1 + (int(change[0]) if change.size else 0)
            step = values[k + 1] - values[k]
            share = (middle - values[k]) / step if step else 0.5
            borders.append(float(course.start_s + (k + share) / course.rate_hz))
        levels.append(level)
        place = end
    if len(levels) < 2:
        return None
    return Stairs(
        begin_s=course.start_s + first / course.rate_hz,
        end_s=course.start_s + place / course.rate_hz,
        jumps_s=tuple(borders),
        levels_v=tuple(levels),
    )


def _hold(course: Course, first: int, latest: int, stop: int, shortest: int) -> tuple[int, int, float] | None:
    """Return the hold that begins between two samples, as begin, end and level; None where none does."""
    values = course.values_v
    for begin in range(first, min(latest, stop - shortest) + 1):
        part = values[begin : begin + shortest]
        if part.max() - part.min() > 2.0 * course.flat_v:
            continue
        level = float(np.median(part))
        end = begin + shortest
        while end < stop:
            ahead = values[end : min(end + 4096, stop)]
            away = np.flatnonzero(np.abs(ahead - level) > course.flat_v)
            if away.size:
                end += int(away[0])
                break
            end += ahead.size
        return begin, end, float(np.median(values[begin : max(end - 2, begin + 1)]))
    return None
