"""How a leg begins: where its set point passes its level, at that phase at which the start stirs up least.

Before its first period the set point stands still, so that the ship is not yet in the periodic motion whose peaks the
plan holds. The difference dies out before the window, but it may meet a limit of the torque.
"""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._motion import motion
from shaftprint.design.plan._leg import Leg
from shaftprint.design.search._uses import samples_of_period
from shaftprint.models._structure import Structure

# Samples a period of the fastest line, between which the set point is straight where it passes its level.
_CROSSING_SAMPLES = 64
# Samples a period of the fastest line in which the motion after a start is computed.
_START_SAMPLES = 16
# Share of the time to settle that a leg must have, so that what the start stirs up dies out: of a loop that forgets in
# 2 s an eighth is left after 4 s. With less the first period is another than those after it.
_LEAST_SETTLING = 0.4


def gentle_start(leg: Leg, structure: Structure, values: FloatArray, bounds: tuple[Bound, ...]) -> tuple[Leg, float]:
    """Return a leg whose first period begins where its set point passes its level and the start asks for least.

    Its window begins at the last such passage within the time to settle, so that ramps go from level to level. A start
    after which there is none late enough is not taken. A leg of slow lines may have no other: its first period is then
    left to settle.

    ``leg``: the leg, beginning at any phase. ``structure``: the structure as it is normalised at the leg. ``values``:
    assumed values of its parameters, shape (parameters,). ``bounds``: bounds of the leg. Returns the leg, and the
    largest use of its bounds from the start to the window.
    """
    crossings_s = _crossings(leg)
    settling_s = _settling(crossings_s, leg)
    start_use = _start_uses(leg, crossings_s, structure, values, bounds)
    least_s = _LEAST_SETTLING * leg.settle_s
    settles = settling_s >= min(least_s, float(settling_s.max()))
    gentlest = int(np.argmin(np.where(settles, start_use, np.inf)))
    start_s, settle_s = crossings_s[gentlest], float(settling_s[gentlest])
    turned = leg.amplitudes * np.exp(2j * np.pi * np.array(leg.harmonics) * start_s / leg.period_s)
    begun = replace(leg, amplitudes=turned, settle_s=settle_s)
    if settle_s < least_s:
        begun = replace(begun, settle_s=settle_s + leg.period_s, periods=leg.periods - 1)
    return begun, float(start_use[gentlest])


def _settling(crossings_s: FloatArray, leg: Leg) -> FloatArray:
    """Return the time from each start to the last crossing within the time to settle [s], shape (starts,)."""
    rest_s = leg.settle_s % leg.period_s
    after_s = np.mod(crossings_s - crossings_s[:, None], leg.period_s)
    last_s = np.where(after_s <= rest_s, after_s, 0.0).max(axis=1)
    return np.asarray(leg.settle_s - rest_s + last_s)


def _crossings(leg: Leg) -> FloatArray:
    """Return when the set point passes its level in one period [s], ascending."""
    count = _CROSSING_SAMPLES * leg.harmonics[-1]
    time = leg.period_s / count * np.arange(count)
    before = leg.set_point_rpm(time) - leg.level_rpm
    after = np.roll(before, -1)
    places = np.flatnonzero((before <= 0.0) != (after <= 0.0))
    share = before[places] / (before[places] - after[places])
    return np.asarray(time[places] + leg.period_s / count * share)


def _start_uses(
    leg: Leg, starts_s: FloatArray, structure: Structure, values: FloatArray, bounds: tuple[Bound, ...]
) -> FloatArray:
    """Return the largest use of the bounds while the leg settles after each of several starts, shape (starts,).

    One period of rest and one of the leg, repeated: what the end of the leg stirs up has died out after the rest.
    """
    count = samples_of_period(leg.harmonics[-1], _START_SAMPLES)
    time = leg.period_s / count * np.arange(count)
    about = leg.set_point_rpm(starts_s[:, None] + time) / leg.level_rpm - 1.0
    spectrum = np.fft.rfft(np.concatenate([np.zeros_like(about), about], axis=1), axis=1)
    weights = np.array([bound.weights / bound.free for bound in bounds])
    transfer = weights @ _responses(leg, structure, values, spectrum.shape[1])
    settling = slice(count, count + max(1, int(count * min(leg.settle_s / leg.period_s, 1.0))))
    largest = [np.fft.irfft(spectrum * row, n=2 * count, axis=1)[:, settling].max(axis=1) for row in transfer]
    return np.asarray(np.max(largest, axis=0))


def _responses(leg: Leg, structure: Structure, values: FloatArray, count: int) -> ComplexArray:
    """Return the responses of ``SIGNALS`` at multiples of half of the leg's first frequency, shape (signals, count)."""
    omega = np.pi / leg.period_s * np.arange(count, dtype=np.float64)
    # an integrator has no value at zero, its loop has
    omega[0] = 1e-3 * omega[1]
    responses: ComplexArray = motion(structure, values[None, :], omega)[0]
    return responses
