"""What the error of the working point does to the numbers that are normalised by it.

A reader takes ``tau_dn`` for that of the ship at its mean load. The program divides by the ``M_s0`` and multiplies by
the ``n_0`` that it has found, ``M_s0 = L n_0^2`` with the mean load ``L`` of the recording: inertia times, gains and
``g`` are a physical value over ``L n_0``. That error is not in the fit, for all data are divided alike, and comes
after it, as a source of its own: to every parameter of ``OVER_TORQUE`` with the share that ``L`` and ``n_0`` have.
Combinations and margins follow by their slopes: ``K_p / K_i`` does not move, ``v K_i / (k_q - g)`` does. In the
conversion to kg m2 and N m/rpm the same share comes back with the other sign: ``I_dn`` does not know of it.
"""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.identify import OVER_TORQUE, Budget, Identification
from shaftprint.normal import NORMAL_95

if TYPE_CHECKING:
    from shaftprint.signals import WorkingPoint

LOAD_WANDER = "wander of the load"
SPEED = "working-point speed"
"""Sources of the budget."""


def shares_over_torque(point: "WorkingPoint") -> dict[str, float]:
    """Return the change of a number over the torque for one standard deviation of each source, over its value."""
    return {LOAD_WANDER: -point.load_std, SPEED: -point.engine_speed_std_rev_s / point.engine_speed_rev_s}


def shifts_of_working_point(identification: Identification, point: "WorkingPoint") -> dict[str, dict[str, float]]:
    """Return the change of each parameter for one standard deviation of each source, by source and parameter."""
    values = {e.name: e.value for e in identification.parameters if e.name in OVER_TORQUE}
    return {
        source: {name: share * value for name, value in values.items()}
        for source, share in shares_over_torque(point).items()
    }


def std_of_working_point(stated: Budget, name: str) -> float:
    """Return the standard deviation that the working point gives to a number of the budget."""
    variances = stated.row(name).variances
    return float(np.sqrt(variances.get(LOAD_WANDER, 0.0) + variances.get(SPEED, 0.0)))


def widened(
    interval: tuple[float, float], value: float, further_std: float, is_open: tuple[bool, bool]
) -> tuple[float, float]:
    """Return a 95 % interval with a further independent source: its half widths add in quadrature, bounds stay."""
    lower, upper = interval
    further = NORMAL_95 * further_std
    return (
        lower if is_open[0] else value - float(np.hypot(value - lower, further)),
        upper if is_open[1] else value + float(np.hypot(upper - value, further)),
    )


def widened_covariance(covariance: FloatArray, identification: Identification, point: "WorkingPoint") -> FloatArray:
    """Return the covariance of the free parameters with the sources of the working point, shape (free, free)."""
    names = [estimate.name for estimate in identification.parameters]
    found = np.array(covariance)
    for moves in shifts_of_working_point(identification, point).values():
        along = np.array([moves.get(name, 0.0) for name in names])
        found += np.outer(along, along)
    return found
