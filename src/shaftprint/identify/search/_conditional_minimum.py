"""The lowest cost with one parameter held at given values, all values at once.

Parameters in which the residuals are affine are solved in closed form within their bounds (variable projection: Golub
and Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems whose variables separate,
1973). What is left is searched from several places at each value; then every value tries what its neighbours found,
until no one gains: that carries the best branch along where the search missed it.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.identify.search._affine_parameters import affine_parameters
from shaftprint.identify.search._bounded_least_squares import bounded_least_squares
from shaftprint.identify.search._levenberg_marquardt import descend
from shaftprint.identify.search._spread import spread

COARSE, FINE = 1e-3, 1e-9
ITERATIONS = 200
# A neighbour's branch is taken when it lowers the cost by more than this share.
WORTH_TAKING = 1e-6
# Problems that go through the array operations together: few enough for the processor's cache.
BLOCK = 1024


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Conditional:
    """A fit problem of which one parameter is held at a value that differs from row to row."""

    objective: Objective
    """The whole problem."""
    held: int
    """Place of that parameter among the free ones."""
    closed: tuple[int, ...]
    """Places of the parameters that are solved in closed form."""
    others: tuple[int, ...]
    """Places of all free parameters but the held one."""

    @classmethod
    def of(cls, objective: Objective, held: int) -> "Conditional":
        """Return the problem with what can be solved in closed form."""
        others = tuple(i for i in range(objective.lower.size) if i != held)
        return cls(objective=objective, held=held, closed=affine_parameters(objective, held), others=others)

    @property
    def searched(self) -> tuple[int, ...]:
        """Places of the parameters that must be searched."""
        return tuple(i for i in self.others if i not in self.closed)

    def lowest(self, at: FloatArray, optima: FloatArray, *, starts: int) -> tuple[FloatArray, FloatArray]:
        """Return the best free parameters of every value, shape (values, free), and their cost, shape (values,).

        ``at``: values of the held parameter, shape (values,). ``optima``: free parameters from which each value is
        tried too, shape (known, free). ``starts``: number of starts besides.
        """
        lower, upper = self.objective.lower, self.objective.upper
        if not self.searched:
            return self._solved_at(at)
        places = np.concatenate([spread(starts, lower, upper), optima])
        return self.carried(*self._best_of(at, np.repeat(places[None], at.size, axis=0)))

    def between(self, at: FloatArray, left: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the best free parameters of values between others whose optima are known, and their cost.

        ``at``: values of the held parameter, shape (values,). ``left``, ``right``: free parameters of the optima on
        both sides of each value, shape (values, free).
        """
        return self._best_of(at, np.stack([left, right], axis=1)) if self.searched else self._solved_at(at)

    def carried(self, theta: FloatArray, cost: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the optima after each value has tried those of its neighbours, as long as that helps.

        ``theta``, ``cost``: best free parameters and cost of ascending values of the held parameter; they are changed.
        """
        if not self.searched:
            return theta, cost
        for step in (1, -1):
            fresh = np.arange(cost.size)
            while fresh.size:
                to = fresh + step
                fresh, to = fresh[(to >= 0) & (to < cost.size)], to[(to >= 0) & (to < cost.size)]
                trial = theta[fresh]
                trial[:, self.held] = theta[to, self.held]
                # nearly all come back to the optimum that is known: only what is better is led to its end
                trial, lower = self._descended(trial, WORTH_TAKING)
                better = lower < cost[to] * (1.0 - WORTH_TAKING)
                fresh = to[better]
                theta[fresh], cost[fresh] = self._descended(trial[better], FINE)
        return theta, cost

    def _solved_at(self, at: FloatArray) -> tuple[FloatArray, FloatArray]:
        theta = np.tile(0.5 * (self.objective.lower + self.objective.upper), (at.size, 1))
        theta[:, self.held] = at
        return self._solved(theta)

    def _best_of(self, at: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the best optimum that several starts of each value, shape (values, starts, free), lead to."""
        theta = places.copy()
        theta[:, :, self.held] = at[:, None]
        size = theta.shape[2]
        theta, cost = self._descended(self._solved(theta.reshape(-1, size))[0], COARSE)
        best = np.argmin(cost.reshape(at.size, -1), axis=1)
        return self._descended(theta.reshape(at.size, -1, size)[np.arange(at.size), best], FINE)

    def slope(self, theta: FloatArray) -> FloatArray:
        """Return how the lowest cost changes with the held parameter at optima of the others, shape (rows,).

        There the others' share vanishes: it is the derivative of the cost alone.
        """
        residuals, slopes = self.objective.residuals(theta)
        return np.asarray(np.vecdot(slopes[:, self.held], residuals))

    def _solved(self, theta: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the rows with the closed-form parameters at their best, and the cost."""
        solved, cost = theta.copy(), np.empty(theta.shape[0])
        closed = list(self.closed)
        for first in range(0, theta.shape[0], BLOCK):
            rows = slice(first, first + BLOCK)
            residuals, slopes = self.objective.residuals(theta[rows])
            columns = slopes[:, closed]
            aim = np.einsum("rc,rcn->rn", theta[rows][:, closed], columns) - residuals
            bounds = self.objective.lower[closed], self.objective.upper[closed]
            best = bounded_least_squares(columns, aim, *bounds)
            remainder = aim - np.einsum("rc,rcn->rn", best, columns)
            solved[rows, closed], cost[rows] = best, 0.5 * np.vecdot(remainder, remainder)
        return solved, cost

    def _descended(self, theta: FloatArray, tolerance: float) -> tuple[FloatArray, FloatArray]:
        """Return where the rows end when all but the held parameter are searched, and the cost there."""
        ends, cost = theta.copy(), np.empty(theta.shape[0])
        others = list(self.others)
        for first in range(0, theta.shape[0], BLOCK):
            part = theta[first : first + BLOCK]

            def residuals(trial: FloatArray, rows: IntArray, part: FloatArray = part) -> tuple[FloatArray, FloatArray]:
                full_part = part[rows]
                full_part[:, others] = trial
                r, slopes = self.objective.residuals(full_part)
                return r, slopes[:, others]

            descent = descend(
                residuals,
                part[:, others],
                self.objective.lower[others],
                self.objective.upper[others],
                tolerance=tolerance,
                max_iterations=ITERATIONS,
            )
            ends[first : first + BLOCK, others] = descent.theta
            cost[first : first + BLOCK] = descent.cost
        return ends, cost
