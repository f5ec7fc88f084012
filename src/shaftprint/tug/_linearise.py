"""The linear response of the tug around its working point, taken from its own nonlinear equations."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import SettingsError
from shaftprint.tug._physics import build_plant, equilibrium, working_point, working_point_rack
from shaftprint.tug._plant import INTEGRAL, RACK, RACK_RATE, SLIPSTREAM, SPEED, Plant, derivatives
from shaftprint.tug._tug import Tug
from shaftprint.vessel import Vessel

# Places in the vector that is perturbed: five states, the demand in the ECU and the rack given a delay ago.
_DEMAND, _RACK_DELAYED, _SIZE = 5, 6, 7
# Places in what comes out: the rates of the five states, then the rack given and the torque at the gauge.
_GIVEN, _GAUGE, _RATES = 5, 6, 7


def linearised_response(
    tug: Tug, vessel: Vessel, frequency_hz: ArrayLike, *, outputs: tuple[str, ...] = ("n", "M_s")
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
        Which responses: ``n``, ``M_s``, and ``X``, the fuel rack that the governor gives before the delay.

    Returns
    -------
    response
        ``n* / n_set*``, ``M_s* / n_set*`` and ``X* / n_set*`` as asked [-], normalised at the working point, shape
        (outputs, 1, lines).

    Raises
    ------
    SettingsError
        If the truth is not physical or an output has another name.
    """
    unknown = [name for name in outputs if name not in ("n", "M_s", "X")]
    if unknown:
        raise SettingsError(f"outputs: expected names out of n, M_s and X, found {', '.join(unknown)}.")
    plant = build_plant(tug, vessel)
    speed, torque = working_point(tug, vessel)
    slope = _slopes(plant, speed)
    rack = working_point_rack(tug, vessel)
    s = 2j * np.pi * np.asarray(frequency_hz, dtype=np.float64)
    # a slipstream that follows at once is no state
    states = slice(0, SLIPSTREAM + 1 if plant.inflow_gain else SLIPSTREAM)
    response = np.empty((len(outputs), 1, s.size), dtype=np.complex128)
    for line, value in enumerate(s):
        delay = np.exp(-value * plant.delay_s)
        # (s I - A) x - B_delayed e^{-s t_d} (given) = B_demand e^{-s t_sp} n_set
        given, gauge = slope[_GIVEN], slope[_GAUGE]
        inner = slope[states, _RACK_DELAYED] * delay
        left = value * np.eye(inner.size) - slope[states, states] - np.outer(inner, given[states])
        right = slope[states, _DEMAND] + inner * given[_DEMAND]
        demand = np.exp(-value * tug.set_point_latency_s)
        x = np.linalg.solve(left, right) * demand
        found = {
            "n": plant.gear_ratio * x[SPEED],
            "M_s": (gauge[states] @ x) * speed / torque,
            "X": (given[states] @ x + given[_DEMAND] * demand) * speed / rack,
        }
        response[:, 0, line] = [found[name] for name in outputs]
    return response


def _slopes(plant: Plant, engine_speed_rev_s: float) -> FloatArray:
    """Return the slopes of the five rates, the rack given and the gauge torque, shape (7, 7)."""
    state = equilibrium(plant, engine_speed_rev_s)
    states = [SPEED, INTEGRAL, RACK, RACK_RATE, SLIPSTREAM]
    centre = np.array([*state[states], engine_speed_rev_s, state[RACK]])
    # the rates are at most quadratic: the central difference has no truncation error
    size = 1e-4 * centre
    size[RACK_RATE] = size[RACK]
    slope = np.empty((_RATES, _SIZE))
    for place in range(_SIZE):
        shift = np.zeros(_SIZE)
        shift[place] = size[place]
        difference = _rates(plant, centre + shift) - _rates(plant, centre - shift)
        slope[:, place] = difference / (2.0 * size[place])
    return slope


def _rates(plant: Plant, vector: FloatArray) -> FloatArray:
    rates: Any = derivatives
    return np.array(rates.py_func(vector[:_DEMAND], *vector[_DEMAND:], 0.0, 0.0, plant)[:_RATES])
