"""The response of equations to small signals about rest, with exact delays and exact derivatives."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._program import Program
from shaftprint.models.equations._calculus import derivatives
from shaftprint.models.equations._evaluate import Array, Leaves, evaluate
from shaftprint.models.equations._formula import Formula


class SmallSignal:
    """Linear equations ``s X = A X + B P + ...`` of a program at rest.

    Unknown are the states, the pasts ``P = exp(-s d) L`` of late signals ``L`` and the samples of a computer, which
    holds what it takes, ``(1 - exp(-s T)) / (s T)``; what changes is ``s`` times what it is. The derivatives follow
    from ``M z = b`` by ``M dz = db - dM z``.
    """

    def __init__(self, program: Program) -> None:
        self.program = program
        self._unknown = [("state", i) for i in range(len(program.rates))]
        self._unknown += [("past", i) for i in range(len(program.pasts))]
        self._unknown += [("sample", i) for i in range(len(program.samples))]
        self._formulas = [
            *program.rates,
            *(late.signal for late in program.pasts),
            *(sample.value for sample in program.samples),
            *program.signals,
        ]
        self._columns = [*self._unknown, *(("input", i) for i in range(len(program.inputs)))]
        self._slopes = [self._column(kind, index) for kind, index in self._columns]
        self._times = [*(late.delay for late in program.pasts), *(sample.period for sample in program.samples)]
        self._times += program.shifts
        self._moved: dict[int, tuple[list[tuple[list[Formula], list[Formula]]], list[Formula]]] = {}

    def _column(self, kind: str, index: int) -> tuple[list[Formula], list[Formula]]:
        """Return the derivatives to a signal and to how fast it changes."""
        plain = derivatives(self._formulas, Formula(kind, place=index))
        if kind not in ("past", "input"):
            return plain, []
        return plain, derivatives(self._formulas, Formula(f"{kind} rate", place=index))

    def response(
        self,
        s: ComplexArray,
        values: Sequence[FloatArray],
        wanted: Sequence[int],
        output: int,
        at: Leaves | None = None,
        *,
        source: int = 0,
    ) -> tuple[ComplexArray, list[ComplexArray]]:
        """Return the response from an input to an output and its derivatives.

        ``s``: laplace variable [rad/s], shape (frequencies,). ``values``: each parameter, shape (..., 1) or (...,
        frequencies). ``wanted``: places of the parameters whose derivatives are wanted. ``at``: inputs, states and
        pasts of another steady running than rest; derivatives are those with it kept. ``source``: place of the input.
        Returns response, shape (..., frequencies), and derivatives, one of the same shape for each wanted parameter.
        """
        leaves = self._leaves(values, at or {})
        shape = np.broadcast_shapes(s.shape, *(np.shape(value) for value in values))
        columns = [*range(len(self._unknown)), len(self._unknown) + source]
        table = self._table([self._slopes[parameter] for parameter in columns], leaves, s, shape)
        times = [np.broadcast_to(time, shape) for time in evaluate(self._times, leaves)]
        size, rates = len(self._unknown), len(self.program.rates)
        late = self._lateness(s, times, shape)
        matrix, right = self._system(table, late, s, size, rates)
        unknowns = _solved(matrix, right)
        row = size + output
        shift = np.exp(-s * times[len(self.program.pasts) + len(self.program.samples) + output])
        plain = np.einsum("...j,...j->...", table[..., row, :size], unknowns) + table[..., row, size]
        slopes = []
        for parameter in wanted:
            moved, moved_times = self._moved_by(parameter)
            change = self._table([moved[column] for column in columns], leaves, s, shape)
            time_slopes = [np.broadcast_to(time, shape) for time in evaluate(moved_times, leaves)]
            d_late = self._lateness_slope(s, times, time_slopes, late)
            d_found = _solved(matrix, self._moved_right(table, change, late, d_late, unknowns, size))
            d_plain = np.einsum("...j,...j->...", change[..., row, :size], unknowns) + change[..., row, size]
            d_plain += np.einsum("...j,...j->...", table[..., row, :size], d_found)
            d_shift = -s * time_slopes[len(self.program.pasts) + len(self.program.samples) + output]
            slopes.append(np.asarray(shift * (d_plain + d_shift * plain)))
        return np.asarray(shift * plain), slopes

    def _leaves(self, values: Sequence[FloatArray], at: Leaves) -> dict[tuple[str, int], Array]:
        """Return all at rest or where it is given, and the parameters."""
        leaves: dict[tuple[str, int], Array] = {("step", 0): np.asarray(1.0)}
        leaves |= {("parameter", i): value for i, value in enumerate(values)}
        for kind, count in (("input", len(self.program.inputs)), ("past", len(self.program.pasts))):
            for i in range(count):
                leaves[kind, i] = leaves[f"{kind} rate", i] = np.asarray(0.0)
        leaves |= {pair: np.asarray(0.0) for pair in self._unknown if pair[0] != "past"}
        return leaves | {pair: np.asarray(value) for pair, value in at.items()}

    def _moved_by(self, parameter: int) -> tuple[list[tuple[list[Formula], list[Formula]]], list[Formula]]:
        if parameter not in self._moved:
            to = Formula("parameter", place=parameter)
            columns = [(derivatives(plain, to), derivatives(change, to)) for plain, change in self._slopes]
            self._moved[parameter] = columns, derivatives(self._times, to)
        return self._moved[parameter]

    def _table(
        self,
        columns: Sequence[tuple[list[Formula], list[Formula]]],
        leaves: dict[tuple[str, int], Array],
        s: ComplexArray,
        shape: tuple[int, ...],
    ) -> ComplexArray:
        """Return the derivative of every formula to every signal, shape (..., frequencies, formulas, signals)."""
        table = np.zeros((*shape, len(self._formulas), len(columns)), dtype=np.complex128)
        for j, (plain, change) in enumerate(columns):
            for i, value in enumerate(evaluate(plain, leaves)):
                table[..., i, j] = value
            for i, value in enumerate(evaluate(change, leaves)):
                table[..., i, j] += s * value
        return table

    def _lateness(self, s: ComplexArray, times: Sequence[Array], shape: tuple[int, ...]) -> ComplexArray:
        """Return what stands before each formula: 1 of a rate, ``exp(-s d)`` of a past, the hold of a sample."""
        late = np.ones((*shape, len(self._unknown)), dtype=np.complex128)
        rates, pasts = len(self.program.rates), len(self.program.pasts)
        for i in range(pasts):
            late[..., rates + i] = np.exp(-s * times[i])
        for i in range(len(self.program.samples)):
            x = s * times[pasts + i]
            late[..., rates + pasts + i] = np.where(x == 0.0, 1.0, -np.expm1(-x) / np.where(x == 0.0, 1.0, x))
        return late

    def _lateness_slope(
        self, s: ComplexArray, times: Sequence[Array], slopes: Sequence[Array], late: ComplexArray
    ) -> ComplexArray:
        change = np.zeros_like(late)
        rates, pasts = len(self.program.rates), len(self.program.pasts)
        for i in range(pasts):
            change[..., rates + i] = -s * slopes[i] * late[..., rates + i]
        for i in range(pasts, pasts + len(self.program.samples)):
            x = s * times[i]
            divisor = np.where(x == 0.0, 1.0, x)
            falling = np.where(x == 0.0, -0.5, (np.exp(-x) - late[..., rates + i]) / divisor)
            change[..., rates + i] = s * slopes[i] * falling
        return change

    @staticmethod
    def _system(
        table: ComplexArray, late: ComplexArray, s: ComplexArray, size: int, rates: int
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return matrix and right side of the equations of all unknown signals."""
        matrix = -late[..., None] * table[..., :size, :size]
        diagonal = np.concatenate(
            [np.broadcast_to(s[:, None], (s.size, rates)), np.ones((s.size, size - rates))], axis=1
        )
        matrix[..., np.arange(size), np.arange(size)] += diagonal
        return matrix, late * table[..., :size, size]

    @staticmethod
    def _moved_right(
        table: ComplexArray,
        change: ComplexArray,
        late: ComplexArray,
        d_late: ComplexArray,
        unknowns: ComplexArray,
        size: int,
    ) -> ComplexArray:
        signals = np.einsum("...ij,...j->...i", table[..., :size, :size], unknowns) + table[..., :size, size]
        moved = np.einsum("...ij,...j->...i", change[..., :size, :size], unknowns) + change[..., :size, size]
        return np.asarray(d_late * signals + late * moved)


def _solved(matrix: ComplexArray, right: ComplexArray) -> ComplexArray:
    return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0], dtype=np.complex128)
