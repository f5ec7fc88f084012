"""Profile-likelihood intervals: right also where the standard deviation is not, because the cost is no parabola.

The profile of a number ``c(theta)`` is the lowest cost at each of its values. The 95 % interval are the values
whose profile exceeds the lowest cost by less than 1.92, half the 95 % point of chi-square with one degree of
freedom (Venzon and Moolgavkar, A method for computing profile-likelihood-based confidence intervals, 1988). Both ends
of all numbers are searched for in one batch.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._optima import SAME_PLACE
from shaftprint.identify.uncertainty._contour import furthest
from shaftprint.identify.uncertainty._numbers import Numbers, all_numbers
from shaftprint.models._combination import Combination
from shaftprint.notebook._shown import Shown

# No curve of a profile rises by more.
MOST_RISE = 4.0
# Ends are looked for from so many optima beside the result, those of lowest cost.
MOST_OPTIMA = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class Interval:
    """A 95 % interval of one parameter or combination."""

    name: str
    """Name of the parameter or combination."""
    lower: float
    """Lower end."""
    upper: float
    """Upper end."""
    lower_open: bool
    """Whether the data set no lower end: a bound of the search stands there."""
    upper_open: bool
    """Whether the data set no upper end: a bound of the search stands there."""
    lower_failed: bool = False
    """Whether the search for the lower end came to none: that of the standard deviation stands there."""
    upper_failed: bool = False
    """Whether the search for the upper end came to none: that of the standard deviation stands there."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Profile(Shown):
    """Profile-likelihood intervals, and the parameter sets at their ends."""

    intervals: Mapping[str, Interval]
    """95 % interval of every free parameter and combination, by name."""
    points: FloatArray
    """All parameters at the end of each interval, shape (points, parameters): sets that the data allow at 95 %."""


def profile_distance(identification: Identification) -> float:
    """Return how far a 95 % interval reaches, as root of twice the rise of the cost: 1.96 for a known covariance."""
    return NORMAL_95


def other_optima(identification: Identification) -> FloatArray:
    """Return the free parameters of the optima of the search beside the result, shape (optima, free).

    Those are left out that are unstable, cost more than any end of an interval or curve may, or are no other place than
    one before.
    """
    objective = identification.objective
    free = list(objective.free)
    width = objective.upper - objective.lower
    kept = [identification.values[free]]
    for cluster in identification.clusters:
        optimum = cluster.values[free]
        new = all(np.any(np.abs(optimum - one) > SAME_PLACE * width) for one in kept)
        allowed = 0.0 <= cluster.cost - identification.cost <= MOST_RISE
        if new and allowed and cluster.stable is not False:
            kept.append(optimum)
    return np.array(kept[1 : 1 + MOST_OPTIMA]).reshape(-1, len(free))


def profile_intervals(identification: Identification) -> dict[str, Interval]:
    """Return the 95 % profile-likelihood interval of every free parameter and combination, by name.

    A combination that is infinite at the estimate, as a quotient by a parameter at 0, has the whole axis.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance: its cost is no likelihood.
    """
    return dict(profile(identification).intervals)


def profile(identification: Identification, numbers: Sequence[Combination] = ()) -> Profile:
    """Return the profile-likelihood intervals with the parameter sets at their ends.

    Parameters
    ----------
    numbers
        Further numbers that follow from the parameters, such as stability margins; their formulas take and give arrays.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance: its cost is no likelihood.
    """
    expect_likelihood(identification)
    objective = identification.objective
    names = all_numbers(objective, numbers)
    best = identification.values[list(objective.free)]
    combinations = (*objective.combinations, *numbers)
    every = Numbers(objective, combinations, np.arange(len(names)))
    # A combination is infinite where a parameter that it divides by is at its bound 0: it has no end to look for.
    at_best = np.broadcast_to(best, (len(names), best.size))
    slopes = every.slopes(at_best, np.zeros_like(at_best))
    finite = np.flatnonzero(np.isfinite(every.values(at_best)) & np.isfinite(slopes).all(axis=1))
    numbers_of_ends = every.chosen(np.repeat(finite, 2))
    side = np.tile([-1.0, 1.0], finite.size)
    distance = np.full(side.size, profile_distance(identification))
    ends = furthest(numbers_of_ends, best, side, distance, optima=other_optima(identification))
    intervals = {
        name: Interval(name=name, lower=-np.inf, upper=np.inf, lower_open=True, upper_open=True) for name in names
    }
    stds = {one.name: one.std for one in (*identification.parameters, *identification.combinations)}
    for i, column in enumerate(finite):
        name = names[column]
        reach = NORMAL_95 * stds.get(name, np.inf)
        (lower, upper), (no_lower, no_upper) = ends.value[2 * i : 2 * i + 2], ends.failed[2 * i : 2 * i + 2]
        centre = float(every.chosen(np.array([column])).values(best[None])[0])
        intervals[name] = Interval(
            name=name,
            lower=min(float(lower), centre - reach) if no_lower else float(lower),
            upper=max(float(upper), centre + reach) if no_upper else float(upper),
            lower_open=bool(ends.is_open[2 * i]) or (bool(no_lower) and not np.isfinite(reach)),
            upper_open=bool(ends.is_open[2 * i + 1]) or (bool(no_upper) and not np.isfinite(reach)),
            lower_failed=bool(no_lower),
            upper_failed=bool(no_upper),
        )
    return Profile(intervals=intervals, points=frozen_float(objective.complete(ends.theta)))


def expect_likelihood(identification: Identification) -> None:
    """Refuse a fit whose cost is no likelihood.

    Raises IdentificationError if it was not weighted by the covariance.
    """
    if not identification.is_likelihood:
        raise IdentificationError(
            f"structure {identification.objective.name}: a profile likelihood needs a fit weighted by the "
            "covariance; fit with MaximumLikelihood()."
        )
