"""The governor replayed on measured speed and set point, with everything that may be nonlinear in it.

The engine's torque is known without any propeller law: upstream of the gauge ``m = M_s* + tau_up dn*/dt``. The governor
and the fuel actuation, fed with the measured speed error, foretell the same torque. A propeller of any law is inside
the measured signals and cannot be taken for a nonlinearity of the governor or the engine.

Each step in turn: set point behind its rate limit; speed error beyond the deadband; proportional and integral part;
limits of the torque (full load times the air that the boost gives, and the motored engine) with back-calculation; rate
limit of the rack; delay; second-order actuation; limits again. An observer draws the integrator towards the measured
torque, slowly: what is wrong with the calibration of the set point would otherwise pile up without end.
"""

from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.kernels import compiled

RING = 256
"""Longest delay in steps of the replay, a power of two."""

NONE = 1e6
"""Value of a limit that is never reached."""


class Terms(NamedTuple):
    """Numbers of the replay, normalised at the working point; a named tuple because compiled code takes it as it is."""

    k_p: float
    k_i: float
    delay_s: float
    set_point_rate: float
    """Fastest change of the set point [1/s]."""
    deadband: float
    """Speed error within which nothing happens, half of the whole band [-]."""
    highest: float
    """Factor on the full-load curve."""
    lowest: float
    """Torque that a motored engine takes, as a positive number [M_b0]."""
    rack_rate: float
    """Fastest change of the rack [M_b0 / s]."""
    air: float
    """Share of the highest torque without boost [-]."""
    boost_s: float
    """Time in which the boost follows the torque [s]."""
    windup_s: float
    """Time constant of the back-calculation [s]."""
    speed_slope: float
    """``g``, slope of torque over speed at constant rack [-]."""
    observer_per_s: float
    """How fast the integrator is drawn towards the measured torque [1/s]; 0 in a closed loop."""
    inertia_s: float
    """``tau_up + tau_dn`` where the speed is to be simulated [s]; 0 where the measured speed is followed."""


@compiled(inline="always")
def _clipped(value, low, high):  # type: ignore[no-untyped-def]
    return min(max(value, low), high)


@compiled(inline="always")
def _full_load(speed, curve_speed, curve_torque):  # type: ignore[no-untyped-def]
    """Return the full-load torque at a speed; the curve goes on level beyond its ends."""
    j = 1
    while j < curve_speed.size - 1 and curve_speed[j] < speed:
        j += 1
    part = (speed - curve_speed[j - 1]) / (curve_speed[j] - curve_speed[j - 1])
    return curve_torque[j - 1] + _clipped(part, 0.0, 1.0) * (curve_torque[j] - curve_torque[j - 1])


@compiled(inline="always")
def _delayed(ring, place, delay):  # type: ignore[no-untyped-def]
    """Return the value of a ring a number of steps ago, linear between steps."""
    whole = int(delay)
    newer = ring[(place - whole) & (RING - 1)]
    older = ring[(place - whole - 1) & (RING - 1)]
    return newer + (delay - whole) * (older - newer)


@compiled(nogil=True)
def replay(  # type: ignore[no-untyped-def]
    set_point, speed, torque, terms, actuation, curve_speed, curve_torque, step_s, engine, followed
) -> None:
    """Fill the torque of the engine [M_b0] and the speed that goes with it, one value a step.

    ``set_point``, ``speed`` are deviations, ``torque`` is that of the engine from the measurement [M_b0], all of shape
    (steps,). ``actuation`` is the matrix of one step of the second-order lag with its input, shape (2, 3).
    """
    n = speed[0]
    rack = torque[0] - 1.0 - terms.speed_slope * n
    ring = np.full(RING, rack)
    integral, moved, rate, before, given = rack - terms.k_p * (set_point[0] - n), rack, 0.0, rack, rack
    asked = set_point[0]
    boost = torque[0] / _full_load(n, curve_speed, curve_torque)
    for j in range(set_point.size):
        if terms.inertia_s == 0.0:
            n = speed[j]
        asked += _clipped(set_point[j] - asked, -terms.set_point_rate * step_s, terms.set_point_rate * step_s)
        error = asked - n
        error -= _clipped(error, -terms.deadband, terms.deadband)
        rest = 1.0 + terms.speed_slope * n
        full = _full_load(n, curve_speed, curve_torque)
        high = terms.highest * full * (terms.air + (1.0 - terms.air) * boost) - rest
        low = -terms.lowest - rest
        wanted = terms.k_p * error + integral
        allowed = _clipped(wanted, low, high)
        given += _clipped(allowed - given, -terms.rack_rate * step_s, terms.rack_rate * step_s)
        ring[j & (RING - 1)] = given
        past = _delayed(ring, j, terms.delay_s / step_s)
        middle, before = 0.5 * (past + before), past
        moved, rate = (
            actuation[0, 0] * moved + actuation[0, 1] * rate + actuation[0, 2] * middle,
            actuation[1, 0] * moved + actuation[1, 1] * rate + actuation[1, 2] * middle,
        )
        engine[j] = rest + _clipped(moved, low, high)
        followed[j] = n
        boost += step_s / terms.boost_s * (engine[j] / full - boost)
        back = (allowed - wanted) / terms.windup_s + terms.observer_per_s * (torque[j] - engine[j])
        integral += step_s * (terms.k_i * error + back)
        if terms.inertia_s > 0.0:
            n += step_s / terms.inertia_s * (engine[j] - (1.0 + n) ** 2)


def actuation_step(omega_n: float, zeta: float, step_s: float) -> FloatArray:
    """Return the exact step of ``z'' + 2 zeta omega_n z' + omega_n^2 z = omega_n^2 y`` for a constant input, (2, 3)."""
    decay = zeta * omega_n
    swing = omega_n * np.sqrt(complex(1.0 - zeta**2))
    swing = swing if abs(swing) > 1e-6 * omega_n else complex(1e-6 * omega_n)
    shrink = np.exp(-decay * step_s)
    cosine, sine = np.cos(swing * step_s).real, (np.sin(swing * step_s) / swing).real
    first = np.array([shrink * (cosine + decay * sine), shrink * sine])
    second = np.array([-(omega_n**2) * shrink * sine, shrink * (cosine - decay * sine)])
    return np.array([[*first, 1.0 - first[0]], [*second, -second[0]]])
