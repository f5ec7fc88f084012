"""The optima that the starts of a search reached, each led to its end.

Optima are compared by their distance in deviance, ``-2 ln L``. One within 3.84 of the result lies inside the 95 %
interval of some parameter. It is a rival, and the result is not unique, unless the way to it never leaves that
distance: then both are places in one wide valley, which intervals describe.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.identify.search._optimum_path import highest_between

# 95 % point of chi-square with one degree of freedom.
WITHIN = 3.841458820694124
POLISH_TOLERANCE, POLISH_ITERATIONS = 1e-12, 300
# Optima are one where the deviance differs by no more than this share of the 95 % limit, and the places by this many
# standard deviations, ...
SAME_COST, SAME_DEVIATIONS = 1e-3, 0.1
# ... and where no parameter differs by more than this share of its bounds' width: a flat valley is several places.
SAME_PLACE = 0.02


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Optimum:
    """An optimum of the search."""

    values: FloatArray
    """All parameters, shape (parameters,)."""
    cost: float
    """Half the sum of squared residuals."""
    distance: float
    """Deviance above that of the result; negative for an unstable model that was passed over."""
    starts: int
    """How many starts reached it."""
    stable: bool
    """Whether the model is stable there."""
    connected: bool
    """Whether it lies in one valley with the result."""
    at_bound: tuple[str, ...]
    """Names of the parameters that stand at a bound."""


def is_rival(optimum: Optimum) -> bool:
    """Return whether an optimum other than the result fits as well within the noise, and is stable."""
    return optimum.stable and not optimum.connected and optimum.distance < WITHIN


def is_passed_over(optimum: Optimum) -> bool:
    """Return whether an optimum fits better than the result but is unstable."""
    return not optimum.stable and optimum.distance < 0.0


def optima_of(identification: Identification) -> tuple[Optimum, ...]:
    """Return the result and the distinct optima beside it, lowest cost first."""
    values, cost, starts = _led_to_their_end(identification)
    result = identification.values
    order = np.lexsort((cost, ~np.all(values == result, axis=1)))
    values, cost, starts = values[order], cost[order], starts[order]
    distance = _distance(identification, cost)
    kept: list[int] = []
    count = np.zeros(cost.size, dtype=np.int64)
    for row in range(cost.size):
        same = [k for k in kept if _same(identification, values[[k, row]], distance[[k, row]])]
        count[same[0] if same else row] += starts[row]
        if not same:
            kept.append(row)
    stable = _stable(identification, values[kept])
    connected = _connected(identification, values[kept], distance[kept])
    return tuple(
        Optimum(
            values=frozen_float(values[row]),
            cost=float(cost[row]),
            distance=float(distance[row]),
            starts=int(count[row]),
            stable=bool(stable[i]),
            connected=bool(connected[i]),
            at_bound=_at_bound(identification, values[row]),
        )
        for i, row in enumerate(kept)
    )


def _led_to_their_end(identification: Identification) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return parameters, cost and starts of every cluster; those that the search left unfinished are led on."""
    clusters, objective = identification.clusters, identification.objective
    values = np.array([cluster.values for cluster in clusters])
    cost = np.array([cluster.cost for cluster in clusters])
    starts = np.array([cluster.starts for cluster in clusters])
    loose = np.array([cluster.stable is None for cluster in clusters])
    if loose.any() and identification.settings.stability != "during":
        descent = descend(
            objective.of_starts,
            values[loose][:, list(objective.free)],
            objective.lower,
            objective.upper,
            tolerance=POLISH_TOLERANCE,
            max_iterations=POLISH_ITERATIONS,
        )
        values[loose], cost[loose] = objective.complete(descent.theta), descent.cost
    return values, cost, starts


def _distance(identification: Identification, cost: FloatArray) -> FloatArray:
    """Return the deviance of each cost above that of the result."""
    result_cost = identification.cost
    if identification.is_likelihood:
        return 2.0 * (cost - result_cost)
    # what is left of data without noise is rounding, not a ratio
    floor = 1e-12 * 2.0 * identification.objective.null_cost
    return np.asarray(identification.data_count * np.log((cost + floor) / (result_cost + floor)))


def _same(identification: Identification, values: FloatArray, distance: FloatArray) -> bool:
    objective = identification.objective
    free = list(objective.free)
    apart = values[1, free] - values[0, free]
    beyond = np.abs(apart) > SAME_PLACE * (objective.upper - objective.lower)
    if beyond.any() or abs(distance[1] - distance[0]) > SAME_COST * WITHIN:
        return False
    _, slopes = objective.residuals(values[:1, free])
    rise = _distance(identification, identification.cost + 0.5 * np.sum((apart @ slopes) ** 2, axis=1))
    return bool(rise[0] <= SAME_DEVIATIONS**2)


def _stable(identification: Identification, values: FloatArray) -> BoolArray:
    """Return whether the model, of every term, is stable at each of many parameter sets."""
    return identification.objective.stable(values)


def _connected(identification: Identification, values: FloatArray, distance: FloatArray) -> BoolArray:
    """Return which optima lie in one valley with the first."""
    objective = identification.objective
    free = list(objective.free)
    near = np.flatnonzero(np.abs(distance) < WITHIN)[1:]
    connected = np.zeros(distance.size, dtype=np.bool_)
    connected[0] = True
    if near.size:
        highest = highest_between(objective, values[0, free], values[near][:, free])
        connected[near] = _distance(identification, highest) < WITHIN
    return connected


def _at_bound(identification: Identification, values: FloatArray) -> tuple[str, ...]:
    objective = identification.objective
    there = zip(objective.free, objective.free_parameters, strict=True)
    return tuple(p.name for column, p in there if values[column] in (p.lower, p.upper))
