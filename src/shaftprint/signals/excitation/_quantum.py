"""What the steps of messages do to the sines and legs of a set point, taken out by their course.

A slow sine in steps is no sine with noise: one of ``a`` steps is wrong by up to ``2 J_1(2 pi a) / pi`` of a step, 0.3 %
at 15 steps, in the same sense at every line of that amplitude (W. R. Bennett, "Spectra of quantized signals", Bell
System Technical Journal 27 (1948)). The lines of a leg are wrong as if by chance, but by the same in each of its
periods, so that no scatter of the periods tells. Where the course that was put out is known, so is what rounding makes
of each of its values; with noise of deviation ``s`` before rounding, that is

``e(u) = sum_n (-1)^n / (pi n) exp(-2 pi^2 n^2 s^2) sin(2 pi n u)``, all in steps

(B. Widrow and I. Kollar, "Quantization Noise", 2008, chapter 4). The course is fitted, the errors of its values are
taken from the messages, and so again.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Sine, Staircase
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._setpoint import setpoint

# So many rounds, each half of the way: the error of a course of few steps hangs on itself.
_ROUNDS, _SHARE = 12, 0.5
# With noise above so many steps nothing is left to take out; below, rounding is that of the course alone.
_MOST_NOISE, _LEAST_NOISE = 0.4, 0.02
# Terms whose factor is below exp(-18) are left out.
_TERMS_BY_NOISE = 1.2
# What is left must be smaller than so much of the variance that was there, else it is another course.
_LEAST_GAIN = 0.8
_FEWEST_MESSAGES = 30
# Lines up to so much of the rate of the messages are told apart.
_OF_RATE = 0.45
# A course from crest to trough of fewer steps says nothing.
_FEWEST_STEPS = 1.0
# Phases of a period that are told apart.
_PHASES = 400


def take_out_steps(
    set_point_v: FloatArray,
    time_s: FloatArray,
    shown_v: FloatArray,
    campaign: Campaign,
    *,
    step_v: float,
    rate_hz: float,
    start_s: float,
) -> None:
    """Take out of a set point, in place, what the steps of its messages make of sines, legs and levels between them.

    ``set_point_v``: the set point on the grid [V], shape (samples,). ``time_s``, ``shown_v``: time [s], ascending, and
    value [V] of its messages, shape (messages,). ``campaign``: what was asked. ``step_v``: step of the values [V].
    ``rate_hz``, ``start_s``: the grid.
    """
    error_v = np.zeros(time_s.size)
    middles, lengths = [], []
    sines = [_of_sine(sine, campaign.offset_v) for sine in campaign.sines]
    for course in (*sines, *map(_of_leg, campaign.legs)):
        inside = slice(*np.searchsorted(time_s, [course.start_s, course.stop_s]))
        if time_s[inside].size < _FEWEST_MESSAGES * len(course.frequencies_hz):
            continue
        asked = None if course.value_at is None else course.value_at(time_s[inside]) / step_v
        error_v[inside] = step_v * steps_of_lines(
            time_s[inside], shown_v[inside] / step_v, course.frequencies_hz, asked
        )
        window = slice(*np.searchsorted(time_s, course.window_s))
        if error_v[window].any():
            about_v = course.level_v - campaign.offset_v
            middles.append(float(np.mean(shown_v[window] - error_v[window])) - about_v)
            lengths.append(course.window_s[1] - course.window_s[0])
    if not middles:
        return
    middle_v = float(np.average(middles, weights=lengths))
    error_v += _error_of_levels(time_s, shown_v, campaign, middle_v=middle_v, step_v=step_v)
    begin, end = (int(np.ceil((instant - start_s) * rate_hz)) for instant in (time_s[0], time_s[-1]))
    places = np.arange(max(begin, 0), min(end, set_point_v.size))
    set_point_v[places] -= scipy.interpolate.CubicSpline(time_s, error_v)(start_s + places / rate_hz)


def left_by_steps(sine: Sine, time_s: FloatArray, *, step_v: float) -> float:
    """Return the standard deviation of what steps leave in the amplitude of a sine at most, as a share of it.

    Messages that come at the same phases in every period show the same steps again, which no course tells apart.

    ``time_s``: times of the messages [s], shape (messages,). ``step_v``: step of the values [V].
    """
    inside_s = time_s[slice(*np.searchsorted(time_s, [sine.settled_s, sine.window_stop_s]))]
    phases = np.unique(np.rint(_PHASES * ((sine.frequency_hz * inside_s) % 1.0))).size
    return step_v / sine.amplitude_v / math.sqrt(6.0 * max(phases, 1))


def _error_of_levels(
    time_s: FloatArray, shown_v: FloatArray, campaign: Campaign, *, middle_v: float, step_v: float
) -> FloatArray:
    """Return what rounding adds to levels that stand still [V], shape (messages,); zeros where the set point moves.

    A level lies anywhere within its step. About the middle of sines and legs, which they know, it lies where the
    campaign has it; where that would be rounded to another value, as near to it as the value allows.
    """
    stands = np.ones(time_s.size, dtype=np.bool_)
    for item in campaign.excitations:
        if not isinstance(item, Staircase):
            stands[slice(*np.searchsorted(time_s, [item.start_s, item.stop_s]))] = False
    asked_v = setpoint(campaign, time_s) + (middle_v - campaign.offset_v)
    error_v = shown_v - asked_v
    # another value than the next one is another course
    stands &= np.abs(error_v) < step_v
    return np.where(stands, error_v.clip(-0.5 * step_v, 0.5 * step_v), 0.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Course:
    """A sum of sines that a set point follows for some time."""

    start_s: float
    stop_s: float
    window_s: tuple[float, float]
    """When it is analysed [s]."""
    frequencies_hz: tuple[float, ...]
    level_v: float
    """Its middle [V]."""
    value_at: Callable[[FloatArray], FloatArray] | None = None
    """What is asked for at times [s]; not given of a single sine, which is found without."""


def _of_sine(sine: Sine, level_v: float) -> _Course:
    return _Course(
        start_s=sine.start_s,
        stop_s=sine.stop_s,
        window_s=(sine.settled_s, sine.window_stop_s),
        frequencies_hz=(sine.frequency_hz,),
        level_v=level_v,
    )


def _of_leg(leg: Leg) -> _Course:
    return _Course(
        start_s=leg.start_s,
        stop_s=leg.stop_s,
        window_s=(leg.settled_s, leg.stop_s),
        frequencies_hz=tuple(line / leg.length_of_period_s for line in leg.lines),
        level_v=leg.level_v,
        value_at=leg.value_at,
    )


def steps_of_lines(
    time_s: FloatArray, shown: FloatArray, frequencies_hz: Sequence[float], asked: FloatArray | None = None
) -> FloatArray:
    """Return what rounding adds to each value of a sum of sines; zeros where the values follow none.

    ``time_s``: times of the values [s], shape (values,). ``shown``: the values in steps, all of them whole numbers
    apart, shape (values,). ``frequencies_hz``: frequencies of the sines [Hz]; where their clock differs, they may turn
    by some hundredths of a period. ``asked``: what was asked for at those times, in steps, shape (values,): many sines
    of few steps are found from there alone, as each of them may take some of the rounding.
    """
    # what is faster looks like a slower line
    highest_hz = _OF_RATE * (time_s.size - 1) / (time_s[-1] - time_s[0])
    slower_hz = [hertz for hertz in frequencies_hz if hertz < highest_hz]
    if not slower_hz:
        return np.zeros_like(shown)
    # the grid of the steps goes through every value
    values = shown - shown[0]
    fitted = _fit_of(_design(time_s, slower_hz))
    plain = values - fitted(values)
    error = np.zeros_like(values)
    if asked is not None:
        slow, late = _slow(time_s), np.gradient(asked, time_s)
        few = np.column_stack([np.ones(slow.size), slow, asked, late, slow * late])
        error = _explained(values, _fit_of(few), error)
    error = _explained(values, fitted, error)
    course = fitted(values - error)
    is_better = np.ptp(course) > _FEWEST_STEPS and (values - error - course).var() < _LEAST_GAIN * plain.var()
    return error if is_better else np.zeros_like(values)


def _explained(values: FloatArray, fitted: Callable[[FloatArray], FloatArray], error: FloatArray) -> FloatArray:
    """Return the error of values by the rounding of the course that is fitted to them; zeros where noise hides it."""
    course = fitted(values - error)
    for _ in range(_ROUNDS):
        noise = _noise(values, course)
        if noise > _MOST_NOISE:
            return np.zeros_like(values)
        error = error + _SHARE * (rounding_error(course, noise) - error)
        course = fitted(values - error)
    return error


def _fit_of(design: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return what gives the least-squares course of values along the columns of a design."""
    factor = scipy.linalg.cho_factor(design.T @ design)
    return lambda values: np.asarray(design @ scipy.linalg.cho_solve(factor, design.T @ values))


def _slow(time_s: FloatArray) -> FloatArray:
    return np.asarray(2.0 * (time_s - time_s[0]) / (time_s[-1] - time_s[0]) - 1.0)


def rounding_error(values: FloatArray, noise: float = 0.0) -> FloatArray:
    """Return by how much rounding to whole numbers changes values on average, of any shape.

    ``values``: in steps. ``noise``: standard deviation of the noise that they have beside [steps].
    """
    if noise < _LEAST_NOISE:
        return np.asarray(np.rint(values) - values)
    error = np.zeros_like(values)
    for term in range(1, int(_TERMS_BY_NOISE / noise) + 2):
        factor = (-1.0) ** term / (np.pi * term) * np.exp(-2.0 * (np.pi * term * noise) ** 2)
        error += factor * np.sin(2.0 * np.pi * term * values)
    return error


def _design(time_s: FloatArray, frequencies_hz: Sequence[float]) -> FloatArray:
    """Return offset, drift and sines that may slowly change, shape (values, 2 + 4 sines)."""
    phase = 2.0 * np.pi * np.outer(time_s - time_s[0], frequencies_hz)
    slow = _slow(time_s)
    waves = np.hstack([np.cos(phase), np.sin(phase)])
    return np.column_stack([np.ones(time_s.size), slow, waves, slow[:, None] * waves])


def _noise(values: FloatArray, course: FloatArray) -> float:
    """Return the noise before rounding [steps]: what the values scatter beyond the rounding of their course."""
    rounding = np.rint(course) - course
    return math.sqrt(max(float(np.var(values - course)) - float(np.var(rounding)), 0.0))
