"""The gauge-aware closed loop of a ship that sails free, at large: its propeller feels the speed of the ship.

With ``n`` and ``v`` the deviations of shaft and ship, thrust and torque over those of the working point are

    c(n, v; a) = (1 + n)^2 + a (1 + n) (v - n) + d (v - n)^2 / 2        a = d ln K_T / d ln J, b of K_Q alike

and that with the ship around it::

    torque      M_p = (k_q / 2) [c(n, v; b) - 1]
    ship        tau_u dv/dt = c(n, v; a) - (1 + v)^e

For small signals it is ``FREE-CLOSED``. The bend ``d = J^2 K'' / K`` is -0.44 of ``K_T`` and -0.55 of ``K_Q`` of the
Ka4-70 in nozzle 19A at P/D 1.11 and ``J = 0.52``, -0.36 and -0.39 of the Wageningen B4-70 at P/D 0.9 and ``J = 0.6``; a
number between is taken for all, a tenth of the torque's change with ``v - n`` if that were a straight line.

A ship takes longer to settle than a lever stands still: ``v_0`` is how much faster it goes at the first moment than in
steady running, which dies away with ``(e - a) / tau_u``.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._limited import LoadPart
from shaftprint.catalogue._sailing import TAU_U, A, B, E
from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula

V_0 = Parameter("v_0", "-", -0.5, 0.5, 0.0, "speed of the ship beyond steady running at the first moment", held=True)

_BEND = -0.45
# Steps of Newton's, and the slowest ship that they look at.
_STEPS, _SLOWEST = 30, -0.95


def taken(speed: Any, ship: Any, slope: Any) -> Any:
    """Return thrust or torque of a propeller over that of the working point.

    ``speed``, ``ship``: deviations of shaft and ship, numbers or formulas. ``slope``: that of its coefficient with the
    advance ratio.
    """
    turned, ahead = 1.0 + speed, ship - speed
    return turned * turned + slope * turned * ahead + 0.5 * _BEND * ahead * ahead


def taken_slope(speed: FloatArray, ship: FloatArray, slope: float) -> FloatArray:
    """Return how that changes with the speed of the shaft, of the ship's alone."""
    ahead = ship - speed
    return np.asarray(2.0 * (1.0 + speed) + slope * (ahead - 1.0 - speed) - _BEND * ahead)


def _resistance(ship: Any, exponent: Any) -> Any:
    return np.exp(exponent * np.log(1.0 + ship))


def steady_ship(speed: FloatArray, thrust_slope: float, exponent: float) -> FloatArray:
    """Return the deviation of the ship's speed in steady running at deviations of the shaft's, of one shape."""
    ship = np.maximum(speed * (2.0 - thrust_slope) / (exponent - thrust_slope), _SLOWEST)
    for _ in range(_STEPS):
        pull = taken(speed, ship, thrust_slope) - _resistance(ship, exponent)
        rise = exponent * (1.0 + ship) ** (exponent - 1.0) - thrust_slope * (1.0 + speed)
        ship = np.maximum(ship + pull / rise, _SLOWEST)
    return np.asarray(ship)


def sailing_load(flow: Flow, speed: Formula, p: Any) -> tuple[Formula, Mapping[str, Formula]]:
    """Return the torque of a propeller that drives a ship through the water, and the ship's speed."""
    settles = flow.state("ship speed")
    flow.rate(settles, (taken(speed, settles, p.a) - _resistance(settles, p.e)) / p.tau_u)
    ship = settles + p.v_0 * (-1.0 * (p.e - p.a) / p.tau_u * flow.running_sum("time", 1.0)).exp()
    return 0.5 * p.k_q * (taken(speed, ship, p.b) - 1.0), {"v": ship}


SAILING = LoadPart(equations=sailing_load, parameters=(A, B, E, TAU_U, V_0), shows=("v",))
"""A propeller that drives a ship through the water."""
