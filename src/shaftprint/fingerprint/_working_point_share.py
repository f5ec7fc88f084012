"""What the error of the working point does to the numbers that are normalised by it.

A reader takes ``tau_dn`` for that of the ship at its mean load. The program divides by the ``M_s0`` and multiplies by
the ``n_0`` that it has found, ``M_s0 = L n_0^2`` with the mean load ``L`` of the recording: inertia times, gains and
``g`` are a physical value over ``L n_0``. That error is not in the fit, for all data are divided alike, and comes
after it, as a source of its own: to every parameter whose role is ``over_torque``, with the share that ``L`` and
``n_0`` have. Combinations and margins follow by their slopes: ``K_p / K_i`` does not move, ``v K_i / (k_q - g)`` does.
In the conversion to kg m2 and N m/rpm the same share comes back with the other sign: ``I_dn`` does not know of it.

Legs are tied by the torques that the gauge shows in each. Where its gain changed between them and nothing showed it,
the parameters over the torque are off in one leg and not in the other, and the fit makes of that what it can: a source
of its own, which moves what is in N m as well.

A logged rack is divided by its own ``X_0``, a mean of quiet stretches with the steps of its channel in it. Gains are so
much rack for a speed, ``v`` so much torque for a rack: ``K_p`` and ``K_i`` go with ``1 / X_0``, ``v`` with ``X_0``, and
``v K_p`` does not move.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._pseudo_inverse import PseudoInverse
from shaftprint.identify.uncertainty._budget import Budget

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint

LOAD_WANDER = "wander of the load"
SPEED = "working-point speed"
RACK = "working-point rack"
GAIN = "working-point gain of the gauge"
SPEED_AGE = "speed latency"
"""Sources of the budget, which no fit knows of."""

FUEL_RACK = "X"

# Step of the central differences, over the size of a parameter.
DIFFERENCE = 1e-6


def shares_over_torque(point: "WorkingPoint") -> dict[str, float]:
    """Return the change of a number over the torque for one standard deviation of each source, over its value."""
    return {LOAD_WANDER: -point.load_std, SPEED: -point.engine_speed_std_rev_s / point.engine_speed_rev_s}


def shifts_of_working_point(
    identification: Identification,
    point: "WorkingPoint",
    rack_share: float = 0.0,
    legs: "Sequence[WorkingPoint]" = (),
) -> dict[str, dict[str, float]]:
    """Return the change of each parameter for one standard deviation of each source, by source and parameter.

    ``identification``, ``point``: the fit, and where it was made. ``rack_share``: standard deviation of the working
    point of a logged rack over its value; it enters the structures that have the rack among their channels. ``legs``:
    the working points of all terms of a fit to legs, in their order.
    """
    roles = {name: role for part in identification.parts for name, role in part.structure.roles.items()}
    changes = _changes(identification, {name: 1.0 for name, role in roles.items() if role.over_torque})
    shifts = {source: _scaled(share, changes) for source, share in shares_over_torque(point).items()}
    if len(legs) == len(identification.objective.terms) > 1:
        shifts[GAIN] = _tied(identification, changes, np.array([one.unseen_gain for one in legs]))
    structure = identification.structure
    if rack_share and FUEL_RACK in (*structure.inputs, *structure.outputs):
        powers = {name: float(role.rack_power) for name, role in roles.items() if role.rack_power}
        shifts[RACK] = _scaled(rack_share, _changes(identification, powers))
    return shifts


def _tied(identification: Identification, changes: Mapping[str, float], gains: FloatArray) -> dict[str, float]:
    """Return the change of each parameter where the gauge shows the torque of each term so much too large.

    ``changes``: of each parameter where all over the torque are larger, over how much they are. ``gains``: relative
    error of the gain in each term, that of the parameters first, shape (terms,).
    """
    objective = identification.objective
    rows, _ = objective.sensitivity(identification.values[list(objective.free)], expected=False)
    names = [parameter.name for parameter in objective.free_parameters]
    along = np.array([changes.get(name, 0.0) for name in names])
    pull, first = np.zeros(along.size), 0
    for term, apart in zip(objective.terms, gains - gains[0], strict=True):
        part = rows[:, first : first + term.row_count]
        first += term.row_count
        pull += apart * part @ (part.T @ along)
    moved = PseudoInverse.of(rows).inverse @ pull
    return dict(zip(names, moved.tolist(), strict=True))


def _scaled(share: float, changes: Mapping[str, float]) -> dict[str, float]:
    return {name: share * change for name, change in changes.items()}


def _changes(identification: Identification, powers: Mapping[str, float]) -> dict[str, float]:
    """Return the change of each free parameter that multiplies every parameter by (1 + x) to its power, over x.

    A tied parameter moves through the free ones: ``K_i = K_p / T_i`` with ``K_p``, and ``tau_n = exp(log_tau)`` by a
    ``log_tau`` that moves by 1. The smallest change that moves them all is taken.
    """
    objective, values = identification.objective, identification.values
    sizes = objective.named(values)
    names = [name for name in sizes if name in powers]
    step = np.maximum(np.abs(values), 1.0) * DIFFERENCE
    columns = []
    for index in objective.free:
        there, back = values.copy(), values.copy()
        there[index] += step[index]
        back[index] -= step[index]
        above, below = objective.named(there), objective.named(back)
        columns.append([float(above[name] - below[name]) / (2.0 * step[index]) for name in names])
    slopes = np.array(columns).reshape(len(objective.free), len(names)).T
    moving = np.any(slopes != 0.0, axis=1)
    wanted = np.array([powers[name] * float(sizes[name]) for name in names])
    change = np.linalg.lstsq(slopes[moving], wanted[moving])[0]
    free = (estimate.name for estimate in identification.parameters)
    return {name: float(size) for name, size in zip(free, change, strict=True) if size}


def std_beside_fit(stated: Budget, name: str) -> float:
    """Return the standard deviation that what comes after the fit gives to a number of the budget."""
    variances = stated.row(name).variances
    return float(np.sqrt(sum(variances.get(source, 0.0) for source in (LOAD_WANDER, SPEED, RACK, GAIN, SPEED_AGE))))


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


def widened_covariance(
    covariance: FloatArray, identification: Identification, shifts: Mapping[str, Mapping[str, float]]
) -> FloatArray:
    """Return the covariance of the free parameters with the sources of the working point, shape (free, free)."""
    names = [estimate.name for estimate in identification.parameters]
    widened = np.array(covariance)
    for moves in shifts.values():
        along = np.array([moves.get(name, 0.0) for name in names])
        widened += np.outer(along, along)
    return widened
