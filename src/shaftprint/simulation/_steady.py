"""Steady running: states and pasts that stay as they are."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models import Leaves, Program, Quantity, derivatives, evaluate

LARGEST_STEPS = 80
# How far from still the largest rate may be left, beside the sizes of what it is made of.
TOLERANCE = 1e-11


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Steady:
    """Values in steady running, and their derivatives to some parameters."""

    states: FloatArray
    """Shape (states,); those that go on for ever at zero."""
    pasts: FloatArray
    """Shape (pasts,)."""
    samples: FloatArray
    """Shape (samples,)."""
    lates: FloatArray
    """The signals of the pasts now, shape (pasts,)."""
    drifts: FloatArray
    """How fast they change: not at all, but for sums that go on for ever, shape (pasts,)."""
    outputs: FloatArray
    """Shape (outputs,)."""


class SteadyEquations:
    """What must vanish in steady running: rates, and the differences between pasts and their signals."""

    def __init__(self, program: Program) -> None:
        self.program = program
        self._still = [i for i, runs in enumerate(program.running) if not runs]
        self._places = [("state", i) for i in self._still]
        self._places += [("past", i) for i in range(len(program.pasts))]
        self._places += [("sample", i) for i in range(len(program.samples))]
        leaves = [Quantity(kind, place=place) for kind, place in self._places]
        formulas = [program.rates[i] for i in self._still]
        formulas += [
            late.signal - late.delay * late.drift - Quantity("past", place=i) for i, late in enumerate(program.pasts)
        ]
        formulas += [taken.value - Quantity("sample", place=i) for i, taken in enumerate(program.samples)]
        self._formulas = formulas
        self._slopes = [derivatives(formulas, leaf) for leaf in leaves]
        lates = [late.signal for late in program.pasts]
        self._wanted = [*lates, *(late.drift for late in program.pasts), *program.signals]

    def solve(self, values: FloatArray, inputs: FloatArray, states: FloatArray | None = None) -> Steady:
        """Return steady running at constant inputs, or what belongs to given states.

        Newton's method from rest at the working point; where states have no steady value of their own, the smallest
        change is taken.

        Parameters
        ----------
        values
            Parameter values, shape (parameters,).
        inputs
            Shape (inputs,).
        states
            States to keep, shape (states,); only the pasts are found then, as if they had always been so.

        Raises
        ------
        StructureError
            If there is no steady running.
        """
        known = self._known(values, inputs)
        at = np.zeros(len(self._places))
        rows = slice(None)
        if states is not None:
            at[: len(self._still)] = states[self._still]
            rows = slice(len(self._still), None)
        at = self._newton(known, at, rows)
        leaves = known | dict(zip(self._places, at, strict=True))
        if states is not None:
            leaves |= {("state", i): x for i, x in enumerate(states)}
        return self._filled(leaves, states)

    def slopes(self, steady: Steady, values: FloatArray, inputs: FloatArray, place: int, *, held: bool) -> Steady:
        """Return the derivatives of steady running to a parameter.

        Parameters
        ----------
        place
            Place of the parameter.
        held
            Whether the states were given.
        """
        leaves = self._leaves(steady, values, inputs)
        to = Quantity("parameter", place=place)
        moved = _array(evaluate(derivatives(self._formulas, to), leaves))
        rows = slice(len(self._still), None) if held else slice(None)
        change = np.zeros(len(self._places))
        matrix = self._jacobian(leaves)[rows, rows]
        change[rows] = np.linalg.lstsq(matrix, -moved[rows], rcond=None)[0]
        program = self.program
        along = dict(zip(self._places, change, strict=True)) | {("parameter", place): 1.0}
        formulas = self._wanted
        total = np.zeros(len(formulas))
        for (kind, number), slope in along.items():
            if slope != 0.0:
                parts = derivatives(formulas, Quantity(kind, place=number))
                total += float(slope) * _array(evaluate(parts, leaves))
        count, still = len(program.pasts), len(self._still)
        states = np.zeros(len(program.states))
        states[self._still] = change[:still]
        return Steady(
            states=states,
            pasts=change[still : still + count],
            samples=change[still + count :],
            lates=total[:count],
            drifts=total[count : 2 * count],
            outputs=total[2 * count :],
        )

    def _known(self, values: FloatArray, inputs: FloatArray) -> dict[tuple[str, int], FloatArray]:
        program = self.program
        known: dict[tuple[str, int], FloatArray] = {("step", 0): np.asarray(1.0)}
        known |= {("parameter", i): np.asarray(v) for i, v in enumerate(values)}
        known |= {("input", i): np.asarray(u) for i, u in enumerate(inputs)}
        for kind, count in (("input rate", len(inputs)), ("past rate", len(program.pasts))):
            known |= {(kind, i): np.asarray(0.0) for i in range(count)}
        known |= {("state", i): np.asarray(0.0) for i, runs in enumerate(program.running) if runs}
        return known

    def _leaves(self, steady: Steady, values: FloatArray, inputs: FloatArray) -> Leaves:
        leaves = self._known(values, inputs)
        leaves |= {("state", i): x for i, x in enumerate(steady.states)}
        leaves |= {("past", i): x for i, x in enumerate(steady.pasts)}
        return leaves | {("sample", i): x for i, x in enumerate(steady.samples)}

    def _jacobian(self, leaves: Leaves) -> FloatArray:
        columns = [_array(evaluate(slopes, leaves)) for slopes in self._slopes]
        return np.array(columns).T.reshape(len(self._formulas), len(columns))

    def _newton(self, known: dict[tuple[str, int], FloatArray], at: FloatArray, rows: slice) -> FloatArray:
        """Return a place where the equations of some rows vanish, moving their own unknowns only."""
        left = self._left(known, at)[rows]
        for _ in range(LARGEST_STEPS):
            if not left.size or np.abs(left).max() <= TOLERANCE * (1.0 + np.abs(at).max(initial=0.0)):
                return at
            matrix = self._jacobian(known | dict(zip(self._places, at, strict=True)))[rows, rows]
            if not np.all(np.isfinite(matrix)):
                break
            step = np.asarray(np.linalg.lstsq(matrix, -left, rcond=1e-12)[0], dtype=np.float64)
            at, left = self._shortened(known, at, left, rows, step)
        if np.all(np.isfinite(left)) and np.abs(left).max() <= np.sqrt(TOLERANCE):
            return at
        raise StructureError(
            f"structure {self.program.name}: no steady running was found at these inputs and parameters; is the engine "
            "strong enough for it, and are all gains positive?"
        )

    def _shortened(
        self, known: dict[tuple[str, int], FloatArray], at: FloatArray, left: FloatArray, rows: slice, step: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the place after a step, halved until what is left falls."""
        share = 1.0
        for _ in range(30):
            tried = at.copy()
            tried[rows] += share * step
            found = self._left(known, tried)[rows]
            if np.all(np.isfinite(found)) and np.linalg.norm(found) < np.linalg.norm(left):
                return tried, found
            share *= 0.5
        return tried, found

    def _left(self, known: dict[tuple[str, int], FloatArray], at: FloatArray) -> FloatArray:
        return _array(evaluate(self._formulas, known | dict(zip(self._places, at, strict=True))))

    def _filled(self, leaves: dict[tuple[str, int], FloatArray], states: FloatArray | None) -> Steady:
        program = self.program
        count = len(program.pasts)
        found = _array(evaluate(self._wanted, leaves))
        names = (("state", len(program.states)), ("past", len(program.pasts)), ("sample", len(program.samples)))
        taken = [np.array([float(leaves[kind, i]) for i in range(count)]) for kind, count in names]
        return Steady(
            states=taken[0] if states is None else states,
            pasts=taken[1],
            samples=taken[2],
            lates=found[:count],
            drifts=found[count : 2 * count],
            outputs=found[2 * count :],
        )


def _array(values: list[FloatArray]) -> FloatArray:
    return np.array(values, dtype=np.float64)
