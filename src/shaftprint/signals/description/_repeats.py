"""What repeats itself: its period, and the harmonics that it has."""

import math

import numpy as np

from shaftprint.arrays import FloatArray, in_blocks
from shaftprint.signals.description._course import Course
from shaftprint.signals.description._pieces import Repeated
from shaftprint.signals.description._waves import LOCAL_SHARE, locally_wrong

# Rate at which periods are looked for [Hz], and the shortest [s].
_LOOKED_HZ, _SHORTEST_S = 25.0, 1.0
# Share of the motion that differs from one period to the next: looked at coarsely, and at the full rate.
_COARSE, _FINE = 0.2, 0.02
_FEWEST_PERIODS = 2.0
# A line is a harmonic so many times as large as the middle of all, which are noise and rounding; and as a share.
_TIMES_MEDIAN, _LEAST_SHARE = 6.0, 1e-3
# What a sum leaves inside, how many times; and a share of its motion: more is another course.
_STDS, _LOCAL = 4.0, 0.03
_HIGHEST_SHARE = 0.2
_ROUNDS = 3


def repeated_from(course: Course, first: int, stop: int) -> Repeated | None:
    """Return what repeats itself from a sample on, as the sum of its harmonics; None where nothing does.

    It is longer than two periods, of which each is as the one before it.
    """
    length = _period(course, first, stop)
    if length is None:
        return None
    begin, end = first, min(first + math.ceil(_FEWEST_PERIODS * length) + 1, stop)
    period_s = length / course.rate_hz
    for _ in range(_ROUNDS):
        piece = _summed(course, begin, end, period_s)
        if not _explains(course, piece):
            return None
        begin, end = _extent(course, piece, first, stop)
        period_s = piece.period_s
        if (end - begin) / course.rate_hz < _FEWEST_PERIODS * period_s:
            return None
    return _summed(course, begin, end, period_s)


def _explains(course: Course, piece: Repeated) -> bool:
    first, stop = course.index(piece.begin_s), course.index(piece.end_s)
    values = course.values_v[first:stop]
    residual = values - piece.value_at(course.times(first, stop))
    return float(np.sqrt(np.mean(residual**2))) <= LOCAL_SHARE * float(np.std(values))


def _period(course: Course, first: int, stop: int) -> float | None:
    """Return the shortest period of what begins at a sample [samples]."""
    every = max(round(course.rate_hz / _LOOKED_HZ), 1)
    rate_hz = course.rate_hz / every
    # means of blocks: what is faster than they are must not fold
    coarse = in_blocks(course.values_v[first:stop], every).mean(axis=1)
    for lag in range(round(_SHORTEST_S * rate_hz), coarse.size // 2 + 1):
        here, there = coarse[:lag], coarse[lag : 2 * lag]
        motion = float(np.var(here))
        if motion <= (2.0 * course.flat_v) ** 2 or float(np.mean((there - here) ** 2)) > _COARSE * motion:
            continue
        found = _nearby(course.values_v[first:stop], lag * every, every)
        if found is not None:
            return found
    return None


def _nearby(values: FloatArray, lag: int, every: int) -> float | None:
    """Return the lag near one that repeats best [samples], by a parabola; None where it does not repeat."""
    lags = np.arange(max(lag - 2 * every, 2), lag + 2 * every + 1)
    lags = lags[2 * lags <= values.size]
    if lags.size < 3:
        return None
    length = int(lags[0])
    here = values[:length]
    costs = np.array([np.mean((values[k : k + length] - here) ** 2) for k in lags.tolist()])
    best = int(np.argmin(costs))
    if costs[best] > _FINE * np.var(here):
        return None
    if best in (0, lags.size - 1):
        return None
    before, at, after = costs[best - 1 : best + 2]
    bend = before - 2.0 * at + after
    return float(lags[best]) + (0.5 * (before - after) / bend if bend > 0.0 else 0.0)


def _extent(course: Course, piece: Repeated, first: int, stop: int) -> tuple[int, int]:
    """Return from where to where a sum explains the set point."""
    residual = course.values_v[first:stop] - piece.value_at(course.times(first, stop))
    begin, end = course.index(piece.begin_s) - first, course.index(piece.end_s) - first
    left_v = float(np.sqrt(np.mean(residual[begin:end] ** 2)))
    motion_v = float(np.std(course.values_v[first + begin : first + end]))
    wrong = locally_wrong(residual, _STDS * (left_v + course.noise_v) + _LOCAL * motion_v, course)
    middle = (begin + end) // 2
    before, after = np.flatnonzero(wrong[:middle]), np.flatnonzero(wrong[middle:])
    return (
        first + (int(before[-1]) + 1 if before.size else 0),
        first + (middle + int(after[0]) if after.size else wrong.size),
    )


def _summed(course: Course, begin: int, end: int, period_s: float) -> Repeated:
    """Return the sum of harmonics fitted to whole periods, its period by the phases of the first and last ones."""
    periods = int((end - begin) / course.rate_hz / period_s + 1e-6)
    highest = int(_HIGHEST_SHARE * course.rate_hz * period_s)
    begin_s = course.start_s + begin / course.rate_hz
    for _ in range(_ROUNDS):
        each = np.array([_phasors(course, begin_s + k * period_s, period_s, highest) for k in range(periods)])
        mean = each.mean(axis=0)
        size = np.abs(mean)
        weight = np.arange(1, highest + 1) * size
        # what each period turns against the one before it, weighted by how well a line tells it
        turns = np.angle(np.sum(each[1:] * each[:-1].conj(), axis=0))
        strong = size > 0.05 * size.max()
        order = np.arange(1, highest + 1)
        drift = float(np.sum((weight**2 * turns / order)[strong]) / np.sum((weight**2)[strong]))
        period_s *= 1.0 - drift / (2.0 * np.pi)
    floor = np.median(size) if highest > 20 else 0.0
    lines = np.flatnonzero(size > max(_TIMES_MEDIAN * floor, _LEAST_SHARE * size.max()))
    middle = course.values_v[begin : begin + round(periods * period_s * course.rate_hz)]
    return Repeated(
        begin_s=begin_s,
        end_s=course.start_s + end / course.rate_hz,
        level_v=float(middle.mean()),
        period_s=period_s,
        zero_s=begin_s,
        harmonics=lines + 1,
        phasors_v=mean[lines],
    )


def _phasors(course: Course, begin_s: float, period_s: float, highest: int) -> "np.typing.NDArray[np.complex128]":
    """Return the harmonics of one period from a time on [V], shape (highest,).

    The samples are moved to a grid of whole samples a period.
    """
    count = round(period_s * course.rate_hz)
    step = period_s * course.rate_hz / count
    place: FloatArray = (begin_s - course.start_s) * course.rate_hz + step * np.arange(count, dtype=np.float64)
    values = _between(course.values_v, place)
    spectrum = np.fft.rfft(values) * (2.0 / count)
    found = np.zeros(highest, dtype=np.complex128)
    upper = min(highest, spectrum.size - 1)
    found[:upper] = spectrum[1 : upper + 1]
    return found


def _between(values: FloatArray, place: FloatArray) -> FloatArray:
    """Return values between samples by cubics through four of them (Catmull-Rom), shape of ``place``."""
    k = np.clip(np.floor(place).astype(np.intp), 1, values.size - 3)
    t = place - k
    a, b, c, d = (values[k + j] for j in (-1, 0, 1, 2))
    return np.asarray(b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a))))
