"""The linear response of the tug around its working point, taken from its own nonlinear equations."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.tug._physics import build_plant, equilibrium, working_point
from shaftprint.tug._plant import INTEGRAL, RACK, RACK_RATE, SPEED, Plant, derivatives
from shaftprint.tug._tug import Tug
from shaftprint.vessel import Vessel

# Places in the vector that is perturbed: four states, the demand in the ECU and the rack given a delay ago.
_DEMAND, _RACK_DELAYED, _SIZE = 4, 5, 6


def linearised_response(tug: Tug, vessel: Vessel, frequency_hz: ArrayLike) -> ComplexArray:
    """Return the response from set point to speed and torque at the working point, with the exact delays.

    The nonlinear rates are perturbed numerically (central differences) and the delays ``exp(-j w t_d)`` inside the
    loop and ``exp(-j w t_sp)`` before it are put in exactly. Limits, quantisation and disturbances take no part.

    Parameters
    ----------
    tug, vessel
        The truth and the installation.
    frequency_hz
        Frequencies [Hz], shape (lines,).

    Returns
    -------
    response
        ``n* / n_set*`` and ``M_s* / n_set*`` [-], normalised at the working point, shape (2, 1, lines).

    Raises
    ------
    SettingsError
        If the truth is not physical.
    """
    plant = build_plant(tug, vessel)
    speed, torque = working_point(tug, vessel)
    slope = _slopes(plant, speed)
    s = 2j * np.pi * np.asarray(frequency_hz, dtype=np.float64)
    states, rates = slice(0, 4), slice(0, 4)
    response = np.empty((2, 1, s.size), dtype=np.complex128)
    for line, value in enumerate(s):
        delay = np.exp(-value * plant.delay_s)
        # (s I - A) x - B_delayed e^{-s t_d} (given) = B_demand e^{-s t_sp} n_set
        given, gauge = slope[4], slope[5]
        inner = slope[rates, _RACK_DELAYED] * delay
        left = value * np.eye(4) - slope[rates, states] - np.outer(inner, given[states])
        right = slope[rates, _DEMAND] + inner * given[_DEMAND]
        x = np.linalg.solve(left, right) * np.exp(-value * tug.set_point_latency_s)
        response[0, 0, line] = plant.gear_ratio * x[SPEED]
        response[1, 0, line] = (gauge[states] @ x) * speed / torque
    return response


def _slopes(plant: Plant, engine_speed_rev_s: float) -> FloatArray:
    """Return the slopes of the four rates, the rack given and the gauge torque, shape (6, 6)."""
    state = equilibrium(plant, engine_speed_rev_s)
    centre = np.array([state[SPEED], state[INTEGRAL], state[RACK], state[RACK_RATE], engine_speed_rev_s, state[RACK]])
    # the rates are at most quadratic: the central difference has no truncation error
    size = 1e-4 * np.array([centre[0], centre[1], centre[2], centre[2], centre[4], centre[2]])
    slope = np.empty((6, _SIZE))
    for place in range(_SIZE):
        shift = np.zeros(_SIZE)
        shift[place] = size[place]
        difference = _rates(plant, centre + shift) - _rates(plant, centre - shift)
        slope[:, place] = difference / (2.0 * size[place])
    return slope


def _rates(plant: Plant, vector: FloatArray) -> FloatArray:
    rates: Any = derivatives
    return np.array(rates.py_func(*vector, 0.0, 0.0, plant)[:6])
