"""Sines and sweeps: found by when they pass their middle, fitted to all samples.

At the crossings of the middle the phase is a multiple of half a turn. A linear sweep is then a polynomial of these
times, a logarithmic one an exponential with one unknown rate: no search with poor optima is needed.
"""

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals.description._course import Course
from shaftprint.signals.description._pieces import Wave

Family = Literal["sine", "linear", "logarithmic"]

# A crossing counts once the set point is so far beyond: standard deviations of noise, share of the largest motion.
_BEYOND_STDS, _BEYOND_SHARE = 8.0, 0.03
# Phase that crossings may be off [rad]: generators hold a voltage for a while.
_LARGEST_RAD = 0.35
_FEWEST: dict[Family, int] = {"sine": 2, "linear": 5, "logarithmic": 6}
_GROWTH = 1.15
# How many crossings are tried as the first one; a wave has to be so many times as long as another to be taken for it.
_SKIPPED, _MORE = 2, 1.1
# Sweeps whose frequency changes by less are sines.
_LEAST_SWEEP = 0.05
# Logarithm of the frequency's growth over a record, tried first.
_GROWTHS = np.concatenate([np.linspace(-8.0, -0.1, 40), np.linspace(0.1, 8.0, 40)])
_STEPS = 8
# A wave ends where the residual over a while is more than this share of its amplitude.
LOCAL_SHARE = 0.2
_WHILE_S = 0.2
# What it leaves inside, how many times; and a share of its amplitude: more is another course.
_STDS, _SHARE = 3.0, 0.01


def wave_from(course: Course, first: int, stop: int) -> Wave | None:
    """Return the sine or sweep that explains most from a sample on; None where none explains a period.

    A sweep has to explain more than the sine does.
    """
    crossings_s = _crossings(course, first, stop)
    best: Wave | None = None
    for skipped in range(_SKIPPED):
        # one wave may begin with a jump to the other side of the middle
        found = _longest_wave(course, crossings_s[skipped:], first, stop)
        if found is not None and (best is None or found.length_s > _MORE * best.length_s):
            best = found
    return best


def _longest_wave(course: Course, crossings_s: FloatArray, first: int, stop: int) -> Wave | None:
    best: Wave | None = None
    for family in _FEWEST:
        count = _fitting(crossings_s, family)
        wave = _wave(course, crossings_s[:count], family, first, stop) if count >= _FEWEST[family] else None
        if wave is None:
            continue
        if best is None or wave.length_s > _MORE * best.length_s:
            best = wave
        elif family == "logarithmic" and best.rate and wave.length_s > best.length_s / _MORE:
            best = min(best, wave, key=lambda one: _residual_v(course, one))
    return best


def _crossings(course: Course, first: int, stop: int) -> FloatArray:
    """Return when the set point passes the offset from one side to the other [s]."""
    about = course.values_v[first:stop] - course.offset_v
    if about.size < 2:
        return np.empty(0)
    beyond = max(_BEYOND_STDS * course.noise_v, _BEYOND_SHARE * float(np.quantile(np.abs(about), 0.99)))
    side = np.where(about > beyond, 1, np.where(about < -beyond, -1, 0))
    places = np.flatnonzero(side)
    turns = np.flatnonzero(side[places[1:]] != side[places[:-1]])
    times = []
    for k in turns.tolist():
        a, b = int(places[k]), int(places[k + 1])
        near = np.arange(a, b + 1)
        # the straight line through what lies between both sides
        slope, level = np.polyfit(near - a, about[a : b + 1], 1)
        times.append(course.start_s + (first + a + float(np.clip(-level / slope, 0.0, b - a))) / course.rate_hz)
    return np.array(times)


def _fitting(crossings_s: FloatArray, family: Family) -> int:
    """Return how many crossings from the first on one wave of a family explains."""
    count = _FEWEST[family]
    if crossings_s.size < count or not _fits(crossings_s[:count], family):
        return 0
    while count < crossings_s.size:
        more = min(max(round(count * _GROWTH), count + 1), crossings_s.size)
        while more > count and not _fits(crossings_s[:more], family):
            more = count + (more - count) // 2
        if more == count:
            break
        count = more
    return count


def _fits(crossings_s: FloatArray, family: Family) -> bool:
    _, residual = _phase_fit(crossings_s, family)
    return bool(np.all(np.abs(residual) <= _LARGEST_RAD))


def _phase_fit(crossings_s: FloatArray, family: Family) -> tuple[tuple[float, float], FloatArray]:
    """Return frequency at the first crossing [Hz] and rate of a family, and the phase that each crossing is off."""
    time = crossings_s - crossings_s[0]
    phase = np.pi * np.arange(time.size)
    if family == "logarithmic":
        span = max(float(time[-1]), 1e-9)
        rate = _best_growth(time, phase, span)
        columns = np.column_stack([np.ones(time.size), np.expm1(rate * time) / rate])
    else:
        columns = np.column_stack([np.ones(time.size), time, 0.5 * time**2][: 2 if family == "sine" else 3])
        rate = 0.0
    coefficients = np.linalg.lstsq(columns, phase, rcond=None)[0]
    if family == "linear":
        rate = float(coefficients[2]) / (2.0 * np.pi)
    return (float(coefficients[1]) / (2.0 * np.pi), rate), phase - columns @ coefficients


def _best_growth(time_s: FloatArray, phase_rad: FloatArray, span_s: float) -> float:
    """Return the rate [1/s] of the logarithm of the frequency that leaves least, refined by halves."""

    def left(rates: FloatArray) -> FloatArray:
        # offset and frequency at their best for every rate at once: what is centred needs no offset
        cycles = np.expm1(rates[:, None] * time_s) / rates[:, None]
        cycles -= cycles.mean(axis=1, keepdims=True)
        frequency = cycles @ about / np.sum(cycles**2, axis=1)
        return np.asarray(np.sum((about - frequency[:, None] * cycles) ** 2, axis=1))

    about = phase_rad - phase_rad.mean()
    rates = _GROWTHS / span_s
    costs = left(rates)
    place = int(np.argmin(costs))
    best, cost = float(rates[place]), float(costs[place])
    step = 0.2 / span_s
    while step > 1e-7 / span_s:
        beside = np.array([rate for rate in (best - step, best + step) if abs(rate) > 1e-9 / span_s])
        tried = left(beside)
        place = int(np.argmin(tried))
        if tried[place] < cost:
            best, cost = float(beside[place]), float(tried[place])
        else:
            step *= 0.5
    return best


def _wave(course: Course, crossings_s: FloatArray, family: Family, first: int, stop: int) -> Wave | None:
    """Return the wave of a family, fitted to all samples that it explains; None where that is less than a period."""
    (frequency, rate), _ = _phase_fit(crossings_s, family)
    wave = Wave(
        begin_s=float(crossings_s[0]),
        end_s=float(crossings_s[-1]),
        offset_v=course.offset_v,
        sine_v=1.0,
        cosine_v=0.0,
        zero_s=float(crossings_s[0]),
        frequency_hz=frequency,
        rate=rate,
        is_logarithmic=family == "logarithmic",
    )
    if frequency <= 0.0:
        return None
    for _ in range(2):
        fitted = _refined(course, wave)
        if fitted is None or fitted.amplitude_v == 0.0 or not _explains(course, fitted):
            return None
        wave = _extended(course, fitted, first, stop)
    ends = [wave.frequency_at(time_s) for time_s in (wave.begin_s, wave.end_s)]
    if min(ends) <= 0.0 or wave.length_s * max(ends) < 1.0:
        return None
    if family != "sine" and abs(ends[1] / ends[0] - 1.0) < _LEAST_SWEEP:
        return None
    return wave


def _refined(course: Course, wave: Wave) -> Wave | None:
    """Return the wave fitted to its samples by Gauss-Newton steps on amplitudes, frequency and rate."""
    first, stop = course.index(wave.begin_s), course.index(wave.end_s)
    if stop - first < 8:
        return None
    time, about = course.times(first, stop), course.values_v[first:stop] - wave.offset_v
    span = max(wave.length_s, 1e-9)
    for step in range(_STEPS):
        turn = wave.turn_rad(time)
        sine, cosine = np.sin(turn), np.cos(turn)
        linear = np.column_stack([sine, cosine])
        amplitudes = np.linalg.lstsq(linear.T @ linear, linear.T @ about, rcond=None)[0]
        wave = replace(wave, sine_v=float(amplitudes[0]), cosine_v=float(amplitudes[1]))
        if step == _STEPS - 1:
            break
        slope = wave.sine_v * cosine - wave.cosine_v * sine
        by_frequency = slope * turn / wave.frequency_hz
        columns = [sine, cosine, by_frequency]
        if wave.rate:
            small = 1e-4 / span * (1.0 if wave.is_logarithmic else wave.frequency_hz)
            columns.append(slope * (replace(wave, rate=wave.rate + small).turn_rad(time) - turn) / small)
        design = np.column_stack(columns)
        scale = np.sqrt(np.sum(design**2, axis=0)) + 1e-300
        moves = np.linalg.lstsq(design / scale, about - linear @ amplitudes, rcond=None)[0] / scale
        longest = 0.5 / (2.0 * np.pi * span)
        move = float(np.clip(moves[2], -longest, longest))
        rate = wave.rate
        if wave.rate:
            farthest = longest / span * (1.0 / wave.frequency_hz if wave.is_logarithmic else 1.0) * 2.0
            rate += float(np.clip(moves[3], -farthest, farthest))
        wave = replace(wave, frequency_hz=max(wave.frequency_hz + move, 1e-6), rate=rate)
        if abs(move) < 1e-7 * longest:
            break
    return wave


def _residual_v(course: Course, wave: Wave) -> float:
    """Return the root mean square of what a wave leaves [V]."""
    first, stop = course.index(wave.begin_s), course.index(wave.end_s)
    residual = course.values_v[first:stop] - wave.value_at(course.times(first, stop))
    return float(np.sqrt(np.mean(residual**2)))


def _explains(course: Course, wave: Wave) -> bool:
    return _residual_v(course, wave) <= LOCAL_SHARE * wave.amplitude_v / math.sqrt(2.0)


def _extended(course: Course, wave: Wave, first: int, stop: int) -> Wave:
    """Return the wave as far to both sides as it explains the set point."""
    time = course.times(first, stop)
    residual = course.values_v[first:stop] - wave.value_at(time)
    inside = residual[max(course.index(wave.begin_s) - first, 0) : max(course.index(wave.end_s) - first, 1)]
    tolerance_v = _STDS * float(np.sqrt(np.mean(inside**2))) + _STDS * course.noise_v + _SHARE * wave.amplitude_v
    wrong = locally_wrong(residual, min(tolerance_v, LOCAL_SHARE * wave.amplitude_v + _STDS * course.noise_v), course)
    middle = min(max(course.index(0.5 * (wave.begin_s + wave.end_s)) - first, 0), wrong.size - 1)
    before, after = np.flatnonzero(wrong[: middle + 1]), np.flatnonzero(wrong[middle:])
    begin = int(before[-1]) + 1 if before.size else 0
    end = middle + int(after[0]) if after.size else wrong.size
    return replace(wave, begin_s=float(time[0]) + begin / course.rate_hz, end_s=float(time[0]) + end / course.rate_hz)


def locally_wrong(residual_v: FloatArray, tolerance_v: float, course: Course) -> "np.typing.NDArray[np.bool_]":
    """Return where the residual over a fifth of a second is larger than a tolerance, shape of the residual."""
    width = max(round(_WHILE_S * course.rate_hz), 1)
    power = np.convolve(residual_v**2, np.full(width, 1.0 / width), mode="same")
    return np.asarray(power > tolerance_v**2)
