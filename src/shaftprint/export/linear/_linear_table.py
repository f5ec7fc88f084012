"""Slopes of equations at rest as one table: what each row becomes for one of each column."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import ExportError
from shaftprint.models._program import Program
from shaftprint.models.equations._calculus import derivatives
from shaftprint.models.equations._evaluate import Leaves, evaluate
from shaftprint.models.equations._formula import Formula


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LinearTable:
    """Slopes with labelled rows and columns.

    A row of a state is how fast it changes, that of a late signal the signal as it is now, that of a sample the value
    that is taken.
    """

    rows: tuple[tuple[str, int], ...]
    """What each row is: kind and place."""
    columns: tuple[tuple[str, int], ...]
    """What each column is."""
    matrix: FloatArray
    """Shape (rows, columns)."""

    def part(self, rows: Sequence[str], columns: Sequence[str]) -> FloatArray:
        """Return the rows and columns of some kinds, kinds slowest."""
        down = [i for kind in rows for i, label in enumerate(self.rows) if label[0] == kind]
        along = [i for kind in columns for i, label in enumerate(self.columns) if label[0] == kind]
        return self.matrix[np.ix_(down, along)]

    def closed(self, labels: Sequence[tuple[str, int]]) -> "LinearTable":
        """Return the table without signals that are at once what their row says.

        With the columns ``v`` of these signals and ``v = V v + R r``, ``v = (1 - V)^-1 R r``.

        Raises ExportError if an algebraic loop has no solution.
        """
        down, along = [self.rows.index(label) for label in labels], [self.columns.index(label) for label in labels]
        others = [i for i in range(len(self.rows)) if i not in down]
        others_in = [i for i in range(len(self.columns)) if i not in along]
        loop = np.eye(len(labels)) - self.matrix[np.ix_(down, along)]
        try:
            solved = np.linalg.solve(loop, self.matrix[np.ix_(down, others_in)])
        except np.linalg.LinAlgError:
            raise ExportError(
                "export: algebraic loop (no delay, no state) without a solution; put a lag into it."
            ) from None
        return LinearTable(
            rows=tuple(self.rows[i] for i in others),
            columns=tuple(self.columns[i] for i in others_in),
            matrix=self.matrix[np.ix_(others, others_in)] + self.matrix[np.ix_(others, along)] @ solved,
        )

    def held(self, sample: tuple[str, int], period_s: float, state: int, past: int) -> "LinearTable":
        """Return the table with a held value as the mean of what is taken over its last period.

        ``h = (a - a(t - T)) / T`` with ``da/dt = v``: ``(1 - exp(-s T)) / (s T)``, what a hold does without the images
        of its sampling.

        ``sample``: label of the held value. ``period_s``: its period ``T`` [s]. ``state``, ``past``: places of the new
        state ``a`` and of the new late signal.
        """
        along = self.columns.index(sample)
        effect = self.matrix[:, along : along + 1] / period_s
        matrix = np.hstack([np.delete(self.matrix, along, axis=1), effect, -effect])
        columns = (*self.columns[:along], *self.columns[along + 1 :], ("state", state), ("past", past))
        rows = tuple(("state", state) if label == sample else label for label in self.rows)
        area = np.zeros((1, len(columns)))
        area[0, -2] = 1.0
        return LinearTable(rows=(*rows, ("past", past)), columns=columns, matrix=np.vstack([matrix, area]))

    def ordered(self) -> "LinearTable":
        """Return the table with rows and columns in the order of their places."""
        down = sorted(range(len(self.rows)), key=lambda i: self.rows[i])
        along = sorted(range(len(self.columns)), key=lambda i: self.columns[i])
        return LinearTable(
            rows=tuple(self.rows[i] for i in down),
            columns=tuple(self.columns[i] for i in along),
            matrix=self.matrix[np.ix_(down, along)],
        )


def linear_table(program: Program, leaves: Leaves) -> LinearTable:
    """Return the slopes of equations.

    ``leaves``: values of all leaves where the slopes are wanted, parameters included.
    """
    rows = {("state", i): rate for i, rate in enumerate(program.rates)}
    rows |= {("past", i): late.signal for i, late in enumerate(program.pasts)}
    rows |= {("sample", i): sample.value for i, sample in enumerate(program.samples)}
    rows |= {("output", i): signal for i, signal in enumerate(program.signals)}
    columns = [label for label in rows if label[0] != "output"]
    columns += [("input", i) for i in range(len(program.inputs))]
    formulas = list(rows.values())
    slopes = [evaluate(derivatives(formulas, Formula(kind, place=index)), leaves) for kind, index in columns]
    matrix = np.array(slopes, dtype=np.float64).reshape(len(columns), len(rows)).T
    return LinearTable(rows=tuple(rows), columns=tuple(columns), matrix=matrix)
