"""The linear response of the tug around its working point, taken from its own nonlinear equations."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import SettingsError
from shaftprint.tug._pitch_actuation import PitchActuation, pitch_torque
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._constants import Plant
from shaftprint.tug.plant._physics import build_plant, equilibrium, steady_load_nm, working_point, working_point_rack
from shaftprint.tug.plant._pitch import actuation_of
from shaftprint.tug.plant._plant import (
    ANGLE,
    ENGINE,
    INTEGRAL,
    RACK,
    RACK_RATE,
    SLIPSTREAM,
    SPEED,
    TWIST,
    WAY,
    derivatives,
)
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel import Vessel

# Places in the vector that is perturbed: nine states, the demand in the ECU, the rack given a delay ago, the pitch, the
# disturbance of the propeller's torque, the torque of an electric machine on the gearbox.
_DEMAND, _RACK_DELAYED, _PITCH, _LOAD, _MACHINE, _SIZE = 9, 10, 11, 12, 13, 14
# Places in what comes out: the rates of the states, then the rack given and the torque at the gauge.
_GIVEN, _GAUGE, _RATES = 9, 10, 11


def linearised_response(
    tug: Tug, vessel: Vessel, frequency_hz: ArrayLike, *, outputs: tuple[str, ...] = ("n", "M_s"), input: str = "n_set"
) -> ComplexArray:
    """Return the response from set point to speed, torque and rack at the working point, with the exact delays.

    The nonlinear rates are perturbed numerically (central differences) and the delays ``exp(-j w t_d)`` inside the
    loop and ``exp(-j w t_sp)`` before it are put in exactly. Limits, quantisation and disturbances take no part.

    Parameters
    ----------
    tug, vessel
        The truth and the installation.
    frequency_hz
        Frequencies [Hz], shape (lines,).
    outputs
        Which responses: ``n``, ``M_s``, ``X``, the fuel rack that the governor gives before the delay, and of a tug
        that sails ``v_s``, the speed of the ship, of one with a controllable pitch at the quay ``theta``, its feedback.
    input
        ``n_set``; ``load``, a share by which the propeller takes more torque; of a tug that sails or has a controllable
        pitch ``theta_set``, the set point of the pitch; or where an electric machine is on the gearbox ``M_m``, its
        torque at the propeller shaft as its channel shows it.

    Returns
    -------
    response
        ``n* / n_set*``, ``M_s* / n_set*`` and ``X* / n_set*`` as asked [-], normalised at the working point, ``M_m`` by
        the shaft torque there, shape (outputs, 1, lines).

    Raises
    ------
    SettingsError
        If the truth is not physical or an output has another name.
    """
    names = ("n", "M_s", "X", *(("theta",) if tug.pitch is not None else ()), *(("v_s",) if tug.sailing else ()))
    unknown = [name for name in outputs if name not in names]
    if unknown:
        words = f"{', '.join(names[:-1])} and {names[-1]}"
        raise SettingsError(f"outputs: expected names out of {words}, found {', '.join(unknown)}.")
    plant = build_plant(tug, vessel)
    speed, driving_nm = working_point(tug, vessel)
    torque = vessel.working_point.turning * driving_nm
    slope = _slopes(plant, speed, () if tug.pitch is None else pitch_torque(tug.pitch, vessel))
    rack = working_point_rack(tug, vessel)
    s = 2j * np.pi * np.asarray(frequency_hz, dtype=np.float64)
    # the torque of a motor follows in a lag of first order
    states = [SPEED, INTEGRAL, RACK] + [RACK_RATE] * (plant.torque_per_s == 0.0)
    # a slipstream that follows at once is no state, nor the twist of a rigid line, nor the speed of a ship that stands
    states += [SLIPSTREAM] * bool(plant.inflow_gain) + [ENGINE, TWIST] * bool(plant.coupling_nm_rev)
    states += [WAY] * plant.sails
    way = equilibrium(plant, speed)[WAY]
    response = np.empty((len(outputs), 1, s.size), dtype=np.complex128)
    for line, value in enumerate(s):
        delay = np.exp(-value * plant.delay_s)
        # (s I - A) x - B_delayed e^{-s t_d} (rack_given) = B_demand e^{-s t_sp} n_set
        rack_given, gauge = slope[_GIVEN], slope[_GAUGE]
        inner = slope[states, _RACK_DELAYED] * delay
        system = value * np.eye(inner.size) - slope[np.ix_(states, states)] - np.outer(inner, rack_given[states])
        moved = _excitation(tug, vessel, input, value, (speed, driving_nm))
        right = (slope[states] + np.outer(inner, rack_given)) @ moved
        x = np.linalg.solve(system, right)
        responses = {
            "n": plant.gear_ratio * x[SPEED] / speed,
            "M_s": (gauge[states] @ x + gauge @ moved) / torque,
            "X": (rack_given[states] @ x + rack_given @ moved) / rack,
        }
        if tug.pitch is not None:
            responses["theta"] = moved[_PITCH] * tug.pitch.sensor_scale / vessel.propeller.pitch_ratio
        if plant.sails:
            responses["v_s"] = x[-1] / way
        response[:, 0, line] = [responses[name] for name in outputs]
    return response


def _excitation(tug: Tug, vessel: Vessel, name: str, s: complex, at: tuple[float, float]) -> ComplexArray:
    """Return what one unit of an input over its working point moves at the line, shape (14,).

    ``at`` are engine speed [rev/s] and driving torque at the shaft [N m] of the working point.
    """
    moved = np.zeros(_SIZE, dtype=np.complex128)
    actuation = actuation_of(tug)
    ratio = vessel.propeller.pitch_ratio if tug.sailing is None else tug.sailing.pitch_ratio
    if name == "n_set":
        moved[_DEMAND] = at[0] * np.exp(-s * tug.set_point_latency_s)
        if vessel.combinator is not None and actuation is not None:
            slope = vessel.combinator.combinator_slope(rpm_from_rev_s(at[0]))
            moved[_PITCH] = slope * ratio * _followed(actuation, s)
    elif name == "load":
        moved[_LOAD] = 1.0
    elif name == "M_m" and tug.shaft_machine is not None:
        moved[_MACHINE] = at[1] / tug.shaft_machine.shown
    elif name == "theta_set" and actuation is not None:
        moved[_PITCH] = ratio * _followed(actuation, s)
    else:
        raise SettingsError(
            "input: expected n_set or load, theta_set of a tug that sails or has a controllable pitch, or M_m where "
            f"an electric machine is on the gearbox, found {name}."
        )
    return moved


def _followed(actuation: PitchActuation, s: complex) -> complex:
    """Return the change of pitch over that asked for."""
    return complex(actuation.set_point_scale * np.exp(-s * actuation.delay_s) / (actuation.lag_s * s + 1.0))


def _slopes(plant: Plant, engine_speed_rev_s: float, pitch_powers: tuple[float, ...]) -> FloatArray:
    """Return the slopes of the rates, the rack given and the gauge torque, shape (11, 14).

    ``pitch_powers`` are those of the torque over the pitch at the quay; none where the pitch is fixed or the curves of
    a ship that sails hold it.
    """
    state = equilibrium(plant, engine_speed_rev_s)
    centre = np.array([*state, engine_speed_rev_s, state[RACK], 0.0, 0.0, plant.machine_nm])
    # at the quay the rates are at most quadratic: the central difference has no truncation error; underway it is 1e-8
    size = 1e-4 * centre
    size[RACK_RATE] = size[RACK]
    size[ANGLE] = 1.0
    size[TWIST] = size[TWIST] or 1.0
    size[WAY] = max(size[WAY], 1e-4)
    size[_PITCH] = size[_LOAD] = 1e-4
    size[_MACHINE] = 1e-4 * steady_load_nm(plant, engine_speed_rev_s / plant.gear_ratio)
    slope = np.empty((_RATES, _SIZE))
    for index in range(_SIZE):
        shift = np.zeros(_SIZE)
        shift[index] = size[index]
        difference = _rates(plant, centre + shift, pitch_powers) - _rates(plant, centre - shift, pitch_powers)
        slope[:, index] = difference / (2.0 * size[index])
    return slope


def _rates(plant: Plant, vector: FloatArray, pitch_powers: tuple[float, ...]) -> FloatArray:
    rates: Any = derivatives
    of_pitch = float(np.polynomial.polynomial.polyval(vector[_PITCH], pitch_powers)) if pitch_powers else 1.0
    load = (1.0 + vector[_LOAD]) * of_pitch - 1.0
    moved, pitch, machine = vector[_DEMAND:_PITCH], vector[_PITCH], vector[_MACHINE]
    values = rates.py_func(vector[:_DEMAND], *moved, load, 0.0, plant, 1.0, pitch, machine)
    # the angle's rate, which is the speed, plays no part
    return np.array([*values[:5], 0.0, *values[9:12], values[5], values[6]])
