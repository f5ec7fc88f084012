"""The profile of one number as a curve: the lowest cost at each of its values, beside the parabola of its deviation."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.uncertainty._contour import furthest
from shaftprint.identify.uncertainty._numbers import Numbers, all_numbers
from shaftprint.identify.uncertainty._profile import expect_likelihood, other_optima, profile_distance
from shaftprint.models._combination import Combination

# How far the curve goes beyond the ends of the 95 % interval, in roots of the rise of the cost.
REACH = 1.3
FEWEST = 3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ProfileCurve:
    """The profile likelihood of one number, through its estimate."""

    name: str
    """Name of the parameter, combination or further number."""
    unit: str
    """Unit, ``-`` where there is none."""
    value: float
    """Estimate."""
    std: float
    """Standard deviation to first order; infinite where the data say nothing."""
    values: FloatArray
    """Values of the number, ascending, shape (points,); fewer than asked for where a bound stops it."""
    rise: FloatArray
    """Lowest cost at each value above that at the estimate, shape (points,)."""
    limit: float
    """Rise of the cost at the ends of the 95 % interval."""

    @property
    def parabola(self) -> FloatArray:
        """Rise that the standard deviation would have, shape (points,)."""
        return np.asarray(0.5 * ((self.values - self.value) / self.std) ** 2)


def profile_curve(identification: Identification, number: str | Combination, *, points: int = 21) -> ProfileCurve:
    """Return the profile of a parameter, a combination by its name, or a further number.

    The points lie evenly in the root of the rise: of a parabola they are evenly spaced values.

    ``number``: name of a free parameter or of a combination of the structures, or a number that follows from the
    parameters. ``points``: number of points, odd, three or more; the middle one is the estimate. Raises
    IdentificationError if the fit was not weighted by the covariance, the number is not known or infinite, or the
    points are few.
    """
    expect_likelihood(identification)
    if points < FEWEST or points % 2 == 0:
        raise IdentificationError(f"profile curve: expected an odd number of points from {FEWEST} on, found {points}.")
    objective = identification.objective
    more = () if isinstance(number, str) else (number,)
    names = all_numbers(objective, more)
    name = number if isinstance(number, str) else number.name
    if name not in names:
        raise IdentificationError(
            f"profile curve: structure {objective.name} has no number {name}; it has {', '.join(names)}."
        )
    combinations = (*objective.combinations, *more)
    of = {c.name: c for c in combinations}
    units = {p.name: p.unit for p in objective.free_parameters} | {c.name: c.unit for c in combinations}
    estimate = identification.derived(name, units[name], of[name].of if name in of else lambda named: named[name])
    if not np.isfinite(estimate.value):
        raise IdentificationError(f"profile curve: {name} is infinite at the estimate; it has no profile.")
    side = np.repeat([-1.0, 1.0], points // 2)
    steps = np.linspace(0.0, REACH * profile_distance(identification), points // 2 + 1)[1:]
    numbers_of_points = Numbers(objective, combinations, np.full(side.size, len(names) - 1 - names[::-1].index(name)))
    best = identification.values[list(objective.free)]
    ends = furthest(numbers_of_points, best, side, np.tile(steps, 2), optima=other_optima(identification))
    # Of the points that a bound stopped only the first of each side is one: the others are the same.
    stopped = ends.is_open | ends.failed
    repeated = stopped & np.roll(stopped, 1) & (np.roll(side, 1) == side)
    theta = np.concatenate([best[None, :], ends.theta[~repeated]])
    residuals, _ = objective.residuals(theta)
    cost = 0.5 * np.vecdot(residuals, residuals)
    values, first = np.unique(np.concatenate([[estimate.value], ends.value[~repeated]]), return_index=True)
    return ProfileCurve(
        name=name,
        unit=units[name],
        value=estimate.value,
        std=estimate.std,
        values=frozen_float(values),
        rise=frozen_float(np.maximum(cost - cost[0], 0.0)[first]),
        limit=0.5 * profile_distance(identification) ** 2,
    )
