"""The cost along one parameter: every optimum of a delay, not only the one that a search happened to reach.

A delay is the parameter in which a response has many optima: one for every turn of the fast lines' phase. With the
delay held, the gains of an open loop are a linear problem that needs no search, so that the whole curve is exact
(delay profile). For other parameters and structures the same curve comes from a batched search at every point.
Stability is not asked: the curve is that of the data.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.digits import after_number
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._conditional_minimum import Conditional
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.models._parameter import Parameter

# Values that are searched from all starts; between them neighbours lead on.
FIRST_POINTS = 17
# Halvings of an interval of the first grid: of all of them, and of those that the curve asks for.
ALWAYS, LEVELS = 2, 7
# An interval is resolved when its middle lies within this share of the curve's height of the cubic through its ends.
RESOLVED = 2e-3
# Optima of the fit that are starts of the search at each value.
KNOWN = 6
POLISH_TOLERANCE, POLISH_ITERATIONS = 1e-14, 200
# Optima closer than this share of the width between the bounds are one.
SAME_PLACE = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Minimum:
    """An optimum on the curve."""

    value: float
    """Where, in the parameter's unit."""
    cost: float
    """Half the sum of squared residuals there, all parameters at their best."""
    values: FloatArray
    """All parameters, shape (parameters,)."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Scan:
    """The lowest cost along one parameter, and its optima."""

    parameter: Parameter
    """The parameter that was held at each value of the grid."""
    grid: FloatArray
    """Its values, ascending, shape (points,)."""
    cost: FloatArray
    """Lowest cost at each of them, shape (points,)."""
    values: FloatArray
    """All parameters there, shape (points, parameters)."""
    closed_form: tuple[str, ...]
    """Names of the parameters that were solved in closed form: the response is linear in them all."""
    minima: tuple[Minimum, ...]
    """Optima of the whole problem that the curve leads to, lowest cost first."""

    @property
    def best(self) -> Minimum:
        """The lowest optimum."""
        return self.minima[0]

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the curve says, in words."""
        name, unit = self.parameter.name, after_number(self.parameter.unit)
        solved = f"; {', '.join(self.closed_form)} solved in closed form" if self.closed_form else ""
        where = f"from {self.grid[0]:.4g} to {self.grid[-1]:.4g}{unit} ({self.grid.size} values{solved})"
        if len(self.minima) == 1:
            return (f"The cost along {name} {where} has one optimum, at {self.best.value:.4g}{unit}.",)
        listed = ", ".join(f"{m.value:.4g}{unit} (cost {m.cost:.4g})" for m in self.minima[:6])
        more = f" and {len(self.minima) - 6} more" if len(self.minima) > 6 else ""
        return (f"The cost along {name} {where} has {len(self.minima)} optima: {listed}{more}.",)


def scan(identification: Identification, parameter: str, *, grid: ArrayLike | None = None, starts: int = 8) -> Scan:
    """Return the lowest cost along a parameter of an identified structure.

    Parameters
    ----------
    identification
        Its data, weights, priors and bounds are used; its optima are starts of the search.
    parameter
        Name of a free parameter.
    grid
        Values of the parameter, ascending; from bound to bound when not given, as fine as the curve asks for.
    starts
        Starts of the search at each value, for parameters that cannot be solved in closed form.

    Raises
    ------
    IdentificationError
        If the parameter is not free or a value lies outside its bounds.
    """
    objective = identification.objective
    names = _free_names(objective)
    if parameter not in names:
        raise IdentificationError(
            f"scan of {parameter}: structure {objective.name} has the free parameters "
            f"{', '.join(names)}; free another with free_between()."
        )
    conditional = Conditional.of(objective, names.index(parameter))
    clusters = identification.clusters[:KNOWN]
    optima = np.array([cluster.values for cluster in clusters])[:, list(objective.free)]
    if grid is None:
        at, theta, cost = _refined(conditional, optima, starts)
    else:
        at = _checked(objective, parameter, grid)
        theta, cost = conditional.lowest(at, optima, starts=starts)
    return Scan(
        parameter=objective.free_parameters[conditional.held],
        grid=frozen_float(at),
        cost=frozen_float(cost),
        values=frozen_float(objective.complete(theta)),
        closed_form=tuple(names[i] for i in conditional.closed),
        minima=_minima(conditional, at, theta, cost),
    )


def _free_names(objective: Objective) -> tuple[str, ...]:
    return tuple(p.name for p in objective.free_parameters)


def _checked(objective: Objective, parameter: str, grid: ArrayLike) -> FloatArray:
    at = np.asarray(grid, dtype=np.float64)
    column = _free_names(objective).index(parameter)
    lower, upper = objective.lower[column], objective.upper[column]
    inside = at.ndim == 1 and at.size > 0 and bool(np.all((at >= lower) & (at <= upper)))
    if not inside or not np.all(np.diff(at) > 0.0):
        raise IdentificationError(
            f"scan of {parameter}: expected ascending values from {lower:g} to {upper:g}, its bounds, found {at}."
        )
    return at


def _refined(conditional: Conditional, optima: FloatArray, starts: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return values from bound to bound, their optima and costs: finer where a cubic does not follow the curve."""
    column = conditional.held
    at = np.linspace(conditional.objective.lower[column], conditional.objective.upper[column], FIRST_POINTS)
    theta, cost = conditional.lowest(at, optima, starts=starts)
    open_ends = np.ones(at.size - 1, dtype=np.bool_)
    for level in range(LEVELS):
        lower_ends = np.flatnonzero(open_ends)
        if lower_ends.size == 0:
            break
        slope, width = conditional.slope(theta), np.diff(at)[lower_ends]
        predicted = (
            0.5 * (cost[lower_ends] + cost[lower_ends + 1]) + width * (slope[lower_ends] - slope[lower_ends + 1]) / 8.0
        )
        middle = 0.5 * (at[lower_ends] + at[lower_ends + 1])
        between, lowest = conditional.between(middle, theta[lower_ends], theta[lower_ends + 1])
        height = float(np.ptp(np.concatenate([cost, lowest])))
        rough = (np.abs(lowest - predicted) > RESOLVED * height) | (level < ALWAYS)
        open_ends = np.repeat(False, at.size - 1)
        open_ends[lower_ends] = rough
        open_ends = np.insert(open_ends, lower_ends + 1, rough)
        at, cost = np.insert(at, lower_ends + 1, middle), np.insert(cost, lower_ends + 1, lowest)
        theta = np.insert(theta, lower_ends + 1, between, axis=0)
    theta, cost = conditional.carried(theta, cost)
    return at, theta, cost


def _minima(conditional: Conditional, at: FloatArray, theta: FloatArray, cost: FloatArray) -> tuple[Minimum, ...]:
    """Return the optima that the lowest points of the curve lead to, each once, lowest cost first."""
    objective, held = conditional.objective, conditional.held
    slope = conditional.slope(theta)
    falling, rising = slope < 0.0, slope > 0.0
    low = np.zeros(at.size, dtype=np.bool_)
    inner = np.flatnonzero(~rising[:-1] & ~falling[1:])
    low[np.where(cost[inner] <= cost[inner + 1], inner, inner + 1)] = True
    low[0] |= not falling[0]
    low[-1] |= not rising[-1]
    low[np.argmin(cost)] = True
    descent = descend(
        objective.of_starts,
        theta[low],
        objective.lower,
        objective.upper,
        tolerance=POLISH_TOLERANCE,
        max_iterations=POLISH_ITERATIONS,
    )
    width = objective.upper[held] - objective.lower[held]
    minima: list[Minimum] = []
    for row in np.argsort(descent.cost, kind="stable"):
        value = float(descent.theta[row, held])
        if all(abs(value - other.value) > SAME_PLACE * width for other in minima):
            values = frozen_float(objective.complete(descent.theta[row]))
            minima.append(Minimum(value=value, cost=float(descent.cost[row]), values=values))
    return tuple(minima)
