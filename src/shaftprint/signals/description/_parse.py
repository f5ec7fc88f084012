"""A set point taken apart: from left to right, the rule that explains most from there on."""

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals.description._course import Course
from shaftprint.signals.description._pieces import Piece, Stairs, Straight, Wave
from shaftprint.signals.description._repeats import repeated_from
from shaftprint.signals.description._waves import wave_from

# A repetition has to explain so many times as much as a wave, and a wave as a straight line.
_MORE = 1.3
# Where nothing fits, the next try is so much later [s], at first and then; what is shorter is the blur of a border.
_SMALL_STEP_S, _STEP_S = 0.15, 1.0
_BLUR_S = 1.0
# Two rules meet within so many samples of their border; so many times are tried.
_MEETING, _TRIED = 1.5, 61


@dataclass(frozen=True, kw_only=True, slots=True)
class Unexplained:
    """A stretch of the set point that no rule explains."""

    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""

    @property
    def length_s(self) -> float:
        """How long it lasts [s]."""
        return self.end_s - self.begin_s


def pieces_of(course: Course) -> list[Piece | Unexplained]:
    """Return what the set point does from its first sample to its last, in order of time."""
    quiet = course.quiet()
    borders = [0, *(edge for stretch in quiet for edge in stretch), course.count]
    pieces: list[Piece | Unexplained] = []
    for number, (first, stop) in enumerate(pairwise(borders)):
        if first == stop:
            continue
        if number % 2:
            pieces.append(_level(course, first, stop))
        else:
            pieces += _parsed(course, first, stop)
    return [piece for piece in pieces if not isinstance(piece, Unexplained) or piece.length_s >= _BLUR_S]


def _level(course: Course, first: int, stop: int) -> Straight:
    """Return a quiet stretch."""
    begin_s, end_s = course.start_s + first / course.rate_hz, course.start_s + stop / course.rate_hz
    return Straight(begin_s=begin_s, end_s=end_s, middle_s=begin_s, middle_v=course.offset_v, slope_v_per_s=0.0)


def _parsed(course: Course, first: int, stop: int) -> list[Piece | Unexplained]:
    """Return the pieces of a stretch that moves."""
    pieces: list[Piece | Unexplained] = []
    place, least = first, round(0.05 * course.rate_hz)
    while stop - place > least:
        piece = _longest(course, place, stop)
        if piece is None:
            lost_s = pieces[-1].length_s if pieces and isinstance(pieces[-1], Unexplained) else 0.0
            step_s = _STEP_S if lost_s >= _BLUR_S else _SMALL_STEP_S
            end = min(place + round(step_s * course.rate_hz), stop)
            pieces = _unexplained(pieces, course, place, end)
            place = end
            continue
        begin, end = course.index(piece.begin_s), course.index(piece.end_s)
        if begin - place > round(SHORTEST_S * course.rate_hz):
            pieces = _unexplained(pieces, course, place, begin)
        pieces.append(piece)
        place = max(end, place + 1)
    return pieces


def _unexplained(pieces: list[Piece | Unexplained], course: Course, first: int, stop: int) -> list[Piece | Unexplained]:
    """Return the pieces with one more stretch that nothing explains, joined with one before it."""
    begin_s, end_s = course.start_s + first / course.rate_hz, course.start_s + stop / course.rate_hz
    if pieces and isinstance(pieces[-1], Unexplained) and pieces[-1].end_s >= begin_s - 1.0 / course.rate_hz:
        return [*pieces[:-1], replace(pieces[-1], end_s=end_s)]
    return [*pieces, Unexplained(begin_s=begin_s, end_s=end_s)]


def _longest(course: Course, first: int, stop: int) -> Piece | None:
    """Return the piece that explains most from a sample on."""
    stairs = stairs_from(course, first, stop)
    if stairs is not None and len(stairs.levels_v) > 2:
        return stairs
    wave = wave_from(course, first, stop)
    if wave is not None and course.index(wave.begin_s) - first > SHORTEST_S * course.rate_hz:
        # what comes before it has to be explained first
        straight = straight_from(course, first, course.index(wave.begin_s))
        return _longer(straight, stairs) or wave
    if wave is not None and _reaches(course, wave, stop):
        return _longer(wave, stairs)
    repeated = repeated_from(course, first, stop)
    best = _longer(repeated if _is_longer(repeated, wave, _MORE) else wave, stairs)
    straight = straight_from(course, first, stop)
    return straight if _is_longer(straight, best, 1.0) else best


def _reaches(course: Course, piece: Wave, stop: int) -> bool:
    return course.count - 2 <= course.index(piece.end_s) or course.index(piece.end_s) >= stop - round(course.rate_hz)


def _longer(one: Piece | None, stairs: Stairs | None) -> Piece | None:
    return stairs if _is_longer(stairs, one, 1.0) else one


def _is_longer(one: Piece | None, other: Piece | None, times: float) -> bool:
    if one is None:
        return False
    return other is None or one.length_s > times * other.length_s


def with_exact_borders(course: Course, pieces: list[Piece | Unexplained]) -> list[Piece | Unexplained]:
    """Return the pieces with the border between two of them where both together leave least."""
    done = list(pieces)
    for k in range(len(done) - 1):
        before, after = done[k], done[k + 1]
        if isinstance(before, Unexplained) or isinstance(after, Unexplained):
            continue
        at_s = _border_s(course, before, after)
        done[k], done[k + 1] = replace(before, end_s=at_s), replace(after, begin_s=at_s)
    return done


def _border_s(course: Course, before: Piece, after: Piece) -> float:
    """Return the time [s] at which one rule goes over into the next: the change point of least squares."""
    reach_s = 0.5 * min(before.length_s, after.length_s)
    if isinstance(before, Stairs) and len(before.jumps_s):
        reach_s = min(reach_s, 0.5 * (before.end_s - before.jumps_s[-1]))
    if isinstance(after, Stairs) and len(after.jumps_s):
        reach_s = min(reach_s, 0.5 * (after.jumps_s[0] - after.begin_s))
    around = sorted((before.end_s, after.begin_s))
    first, stop = course.index(around[0] - reach_s), course.index(around[1] + reach_s)
    if stop - first < 2:
        return after.begin_s
    time, values = course.times(first, stop), course.values_v[first:stop]
    gain = (values - after.value_at(time)) ** 2 - (values - before.value_at(time)) ** 2
    summed = np.concatenate([[0.0], np.cumsum(gain)])
    border_s = course.start_s + (first + int(np.argmax(summed))) / course.rate_hz
    return (
        border_s
        if isinstance(before, Stairs) or isinstance(after, Stairs)
        else _meeting_s(course, before, after, border_s)
    )


def _meeting_s(course: Course, before: Piece, after: Piece, border_s: float) -> float:
    """Return the time [s] near a border at which two rules meet; the border itself where they do not."""
    time = border_s + np.linspace(-_MEETING, _MEETING, _TRIED) / course.rate_hz
    difference = after.value_at(time) - before.value_at(time)
    crossings = np.flatnonzero(difference[1:] * difference[:-1] < 0.0)
    if not crossings.size:
        return border_s
    k = int(crossings[np.argmin(np.abs(time[crossings] - border_s))])
    share = difference[k] / (difference[k] - difference[k + 1])
    return float(time[k] + share * (time[k + 1] - time[k]))


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
