"""Profile-likelihood intervals: right also where the standard deviation is not, because the cost is no parabola.

The profile of a number ``c(theta)`` is the lowest cost at each of its values. The 95 % interval are the values
whose profile exceeds the lowest cost by less than 1.92, half the 95 % point of chi-square with one degree of
freedom (Venzon and Moolgavkar, A method for computing profile-likelihood-based confidence intervals, 1988).

A point of the profile is found by pulling at the number: minimise ``cost + ((c - x) / w)^2 / 2``. Wherever ``c``
ends, no other parameters give that ``c`` at a lower cost, so (c, cost) there is a point of the profile, whatever
``x`` and ``w`` were. All numbers and both sides are pulled at in one batch; ``x`` is moved until the cost is right.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray, frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify._identification import NORMAL_95, Identification
from shaftprint.identify._levenberg_marquardt import descend
from shaftprint.identify._objective import Objective

ROUNDS = 14
# Width of the pull over the standard deviation that is expected: narrow enough to lead, wide enough to be well scaled.
PULL = 0.2
# The end of an interval is good when its distance in standard deviations is right to this share.
PRECISION = 0.005
PULL_TOLERANCE = 1e-7
PULL_ITERATIONS = 60
LARGEST_STRIDE = 2.5
# An end that moves by less than this share of the way to where it is pulled is held by a bound.
STUCK = 1e-4


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


@dataclass(frozen=True, slots=True, eq=False)
class _Pulls:
    """What is pulled at, one row a number and side."""

    of: tuple[Callable[[Mapping[str, FloatArray]], FloatArray], ...]
    scale: FloatArray
    side: FloatArray
    middle: FloatArray

    def chosen(self, rows: IntArray) -> "_Pulls":
        """Return some of the rows."""
        return _Pulls(tuple(self.of[i] for i in rows), self.scale[rows], self.side[rows], self.middle[rows])

    def values(self, objective: Objective, theta: FloatArray) -> FloatArray:
        """Return the number of each row, shape (rows,), for free parameters of shape (rows, free)."""
        complete = objective.complete(theta)
        names = objective.structure.names
        return np.array(
            [
                float(of({name: row[i] for i, name in enumerate(names)}))
                for of, row in zip(self.of, complete, strict=True)
            ]
        )

    def slopes(self, objective: Objective, theta: FloatArray) -> FloatArray:
        """Return the derivative of each row's number to the free parameters, shape (rows, free)."""
        found = np.empty_like(theta)
        width = 1e-6 * (objective.upper - objective.lower)
        for i in range(theta.shape[1]):
            ahead, behind = theta.copy(), theta.copy()
            ahead[:, i] += width[i]
            behind[:, i] -= width[i]
            found[:, i] = (self.values(objective, ahead) - self.values(objective, behind)) / (2.0 * width[i])
        return found


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Profile:
    """Profile-likelihood intervals, and the parameter sets at their ends."""

    intervals: Mapping[str, Interval]
    """95 % interval of every free parameter and combination, by name."""
    points: FloatArray
    """All parameters at the end of each interval, shape (points, parameters): sets that the data allow at 95 %."""


def profile_intervals(identification: Identification) -> dict[str, Interval]:
    """Return the 95 % profile-likelihood interval of every free parameter and combination, by name.

    A combination that is infinite at the estimate, as a quotient by a parameter at 0, has the whole axis.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance: its cost is no likelihood.
    """
    return dict(profile(identification).intervals)


def profile(identification: Identification) -> Profile:
    """Return the profile-likelihood intervals with the parameter sets at their ends.

    The sets lie on the contour of the likelihood that the intervals belong to, at its extremes along every parameter
    and combination. The smallest and largest value of any other number over them is its interval as far as these
    directions reach.

    Raises
    ------
    IdentificationError
        If the fit was not weighted by the covariance: its cost is no likelihood.
    """
    if not identification.is_likelihood:
        raise IdentificationError(
            f"structure {identification.structure.name}: a profile likelihood needs a fit weighted by the "
            "covariance; fit with MaximumLikelihood()."
        )
    objective = identification.objective
    pulls, names = _pulls_of(identification)
    search = _Search.begin(objective, pulls, identification.values[list(objective.free)])
    for _ in range(ROUNDS):
        search.advance()
        if search.working.size == 0:
            break
    ends = pulls.middle + pulls.side * pulls.scale * search.at
    found = {
        name: Interval(
            name=name,
            lower=float(ends[2 * i]),
            upper=float(ends[2 * i + 1]),
            lower_open=bool(search.open_end[2 * i]),
            upper_open=bool(search.open_end[2 * i + 1]),
        )
        for i, name in enumerate(names)
    }
    for estimate in (*identification.parameters, *identification.combinations):
        whole = Interval(name=estimate.name, lower=-np.inf, upper=np.inf, lower_open=True, upper_open=True)
        found.setdefault(estimate.name, whole)
    return Profile(
        intervals=found,
        points=frozen_float(objective.complete(search.theta)),
    )


@dataclass(slots=True, eq=False)
class _Search:
    """Where the search for every end stands; distances are in standard deviations from the estimate."""

    objective: Objective
    pulls: _Pulls
    lowest: float
    theta: FloatArray
    at: FloatArray
    target: FloatArray
    inner: FloatArray
    inner_root: FloatArray
    outer: FloatArray
    outer_root: FloatArray
    open_end: BoolArray
    working: IntArray

    @classmethod
    def begin(cls, objective: Objective, pulls: _Pulls, best: FloatArray) -> "_Search":
        """Start every search at the estimate, pulling to where a parabola would have its end."""
        rows = pulls.side.size
        return cls(
            objective=objective,
            pulls=pulls,
            lowest=float(_cost(objective, best[None, :])[0]),
            theta=np.broadcast_to(best, (rows, best.size)).copy(),
            at=np.zeros(rows),
            target=np.full(rows, NORMAL_95),
            inner=np.zeros(rows),
            inner_root=np.zeros(rows),
            outer=np.full(rows, np.inf),
            outer_root=np.full(rows, np.inf),
            open_end=np.zeros(rows, dtype=np.bool_),
            working=np.arange(rows),
        )

    def advance(self) -> None:
        """Pull once at every number whose end is not yet found."""
        rows, before = self.working, self.at[self.working]
        self.theta[rows] = _pulled(self.objective, self.pulls, rows, self.target, self.theta[rows])
        pulls = self.pulls.chosen(rows)
        values = pulls.values(self.objective, self.theta[rows])
        at = self.at[rows] = (values - pulls.middle) * pulls.side / pulls.scale
        root = np.sqrt(np.maximum(2.0 * (_cost(self.objective, self.theta[rows]) - self.lowest), 0.0))
        found = np.abs(root - NORMAL_95) < PRECISION * NORMAL_95
        inside = root < NORMAL_95
        low, high = rows[inside], rows[~inside]
        self.inner[low], self.inner_root[low] = at[inside], root[inside]
        self.outer[high], self.outer_root[high] = at[~inside], root[~inside]
        held = inside & ~found & np.isinf(self.outer[rows]) & (np.abs(at - before) < STUCK * self.target[rows])
        self.open_end[rows[held]] = True
        self.working = rows[~(found | held)]
        self.target[self.working] = self._next_target(self.working)

    def _next_target(self, rows: IntArray) -> FloatArray:
        """Return where to pull next: between the brackets, or further out where nothing is outside yet."""
        low, high = self.inner[rows], self.outer[rows]
        low_root, high_root = self.inner_root[rows], self.outer_root[rows]
        lag = self.target[rows] - self.at[rows]
        with np.errstate(invalid="ignore"):
            share = np.clip((NORMAL_95 - low_root) / (high_root - low_root), 0.02, 0.98)
            between = low + (high - low) * share + lag
        stride = np.clip(NORMAL_95 / np.maximum(low_root, 1e-3), 1.1, LARGEST_STRIDE)
        return np.where(np.isfinite(high), between, np.maximum(self.target[rows], low) * stride)


def _pulls_of(identification: Identification) -> tuple[_Pulls, tuple[str, ...]]:
    # A combination is infinite where a parameter that it divides by is at its bound 0: there is nothing to pull at.
    combinations = (e for e in identification.combinations if np.isfinite(e.value))
    estimates = (*identification.parameters, *combinations)
    of = {p.name: _parameter(p.name) for p in identification.structure.free}
    of |= {c.name: c.of for c in identification.structure.combinations}
    width = {p.name: p.upper - p.lower for p in identification.structure.free}
    scale = [
        e.std if np.isfinite(e.std) and e.std > 0.0 else 0.1 * width.get(e.name, 10.0 * abs(e.value)) for e in estimates
    ]
    return (
        _Pulls(
            of=tuple(of[e.name] for e in estimates for _ in (0, 1)),
            scale=np.repeat(scale, 2),
            side=np.tile([-1.0, 1.0], len(estimates)),
            middle=np.repeat([e.value for e in estimates], 2),
        ),
        tuple(e.name for e in estimates),
    )


def _parameter(name: str) -> Callable[[Mapping[str, FloatArray]], FloatArray]:
    return lambda values: values[name]


def _pulled(objective: Objective, pulls: _Pulls, rows: IntArray, target: FloatArray, theta: FloatArray) -> FloatArray:
    """Return where the parameters go when each row's number is pulled to its target."""
    goal = pulls.middle + pulls.side * pulls.scale * target

    def residuals(trial: FloatArray, starts: IntArray) -> tuple[FloatArray, FloatArray]:
        r, jacobian = objective.residuals(trial)
        at = pulls.chosen(rows[starts])
        width = PULL * at.scale
        pull = (at.values(objective, trial) - goal[rows[starts]]) / width
        slope = at.slopes(objective, trial) / width[:, None]
        return np.concatenate([r, pull[:, None]], axis=1), np.concatenate([jacobian, slope[:, :, None]], axis=2)

    # A quotient of parameters may pass through infinity on the way; the search turns back from there by itself.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found = descend(
            residuals,
            theta,
            objective.lower,
            objective.upper,
            tolerance=PULL_TOLERANCE,
            max_iterations=PULL_ITERATIONS,
        )
    return found.theta


def _cost(objective: Objective, theta: FloatArray) -> FloatArray:
    r, _ = objective.residuals(theta)
    return np.asarray(0.5 * np.einsum("sr,sr->s", r, r))
