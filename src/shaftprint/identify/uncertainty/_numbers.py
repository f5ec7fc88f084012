"""Numbers that follow from the parameters, at many parameter sets at once, with their slopes.

A free parameter is the simplest of them; a combination such as ``v K_p / tau`` or a stability margin are others.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.identify.likelihood._objective import Objective
from shaftprint.models._combination import Combination

# Step of a numerical slope over the standard deviation of a parameter when all others are known.
STEP = 1e-4
# The same over the width between the bounds, for a parameter without influence.
STEP_OF_WIDTH = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """What is asked of each row of a table of parameter sets: one of several numbers."""

    objective: Objective
    """Says which parameters there are and what they are called."""
    combinations: tuple[Combination, ...]
    """The numbers behind the free parameters."""
    of_row: IntArray
    """Which number each row is asked for, shape (rows,): free parameters first, then the combinations."""

    def chosen(self, rows: IntArray) -> "Numbers":
        """Return the questions of some of the rows."""
        return Numbers(self.objective, self.combinations, self.of_row[rows])

    def values(self, theta: FloatArray) -> FloatArray:
        """Return the number of each row, shape (rows,), for free parameters of shape (rows, free).

        A quotient by zero is infinite or not a number.
        """
        free = theta.shape[1]
        parameter = self.of_row < free
        values = np.empty(self.of_row.size)
        values[parameter] = theta[parameter, self.of_row[parameter]]
        for number in np.unique(self.of_row[~parameter]):
            rows = np.flatnonzero(self.of_row == number)
            values[rows] = self._combination(int(number) - free, theta[rows])
        return values

    def slopes(self, theta: FloatArray, curvature: FloatArray) -> FloatArray:
        """Return the derivatives of each row's number to the free parameters, shape (rows, free).

        ``curvature``: second derivative of the cost to each free parameter, shape (rows, free); it sets the numerical
        steps.
        """
        free = theta.shape[1]
        parameter = np.flatnonzero(self.of_row < free)
        slopes = np.zeros_like(theta)
        slopes[parameter, self.of_row[parameter]] = 1.0
        if parameter.size == self.of_row.size:
            return slopes
        width = STEP_OF_WIDTH * (self.objective.upper - self.objective.lower)
        with np.errstate(divide="ignore"):
            step = np.minimum(STEP / np.sqrt(curvature), width)
        for number in np.unique(self.of_row[self.of_row >= free]):
            rows = np.flatnonzero(self.of_row == number)
            moves = np.eye(free)[:, None, :] * step[rows]
            ahead = self._combination(int(number) - free, (theta[rows] + moves).reshape(-1, free))
            behind = self._combination(int(number) - free, (theta[rows] - moves).reshape(-1, free))
            with np.errstate(invalid="ignore"):
                slopes[rows] = (ahead - behind).reshape(free, -1).T / (2.0 * step[rows])
        return slopes

    def _combination(self, index: int, theta: FloatArray) -> FloatArray:
        """Return one of the combinations at many parameter sets, shape (sets,)."""
        named = self.objective.named(self.objective.complete(theta))
        with np.errstate(all="ignore"):
            return np.broadcast_to(self.combinations[index].of(named), theta.shape[:1])


def all_numbers(objective: Objective, more: Sequence[Combination] = ()) -> tuple[str, ...]:
    """Return the names of the free parameters, of the structures' combinations and of more numbers, in this order."""
    return (
        *(p.name for p in objective.free_parameters),
        *(c.name for c in objective.combinations),
        *(c.name for c in more),
    )
