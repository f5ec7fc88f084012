"""Steady running: states and pasts that stay as they are."""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._program import Program
from shaftprint.models.equations._calculus import derivatives
from shaftprint.models.equations._formula import Formula
from shaftprint.simulation._plain_text import Plain, plain_function

LARGEST_STEPS = 80
HALVINGS = 30
# In how many steps inputs are led from rest to where they are, until one number is enough.
LEADING_STEPS = (8, 64)
# The steps in which motion from rest settles, where Newton's method does not find its end.
SETTLING_STEPS_S = np.geomspace(1e-5, 1e4, 120)
# How far small signals may move in a step: those that swing by this angle [rad], any by this times their rate.
MOST_ANGLE = 0.3
MOST_DECAY = 1.0
MOST_EXTRAPOLATED = 0.1
# Small signals that are slower need no shorter step [1/s].
SLOWEST = 1e-6
# How far from still the largest rate may be left, relative to the sizes of what it is made of.
TOLERANCE = 1e-11


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Steady:
    """Values in steady running, or their derivatives to a parameter."""

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
        places = [("state", i) for i in self._still]
        places += [("past", i) for i in range(len(program.pasts))]
        places += [("sample", i) for i in range(len(program.samples))]
        self._unknown = [Formula(kind, place=index) for kind, index in places]
        formulas = [program.rates[i] for i in self._still]
        formulas += [
            late.signal - late.delay * late.drift - Formula("past", place=i) for i, late in enumerate(program.pasts)
        ]
        formulas += [sample.value - Formula("sample", place=i) for i, sample in enumerate(program.samples)]
        self._formulas = formulas
        self._left = plain_function(formulas)
        self._matrix = plain_function([slope for leaf in self._unknown for slope in derivatives(formulas, leaf)])
        states = [Formula("state", place=index) for index in range(len(program.states))]
        self._own = plain_function([slope for leaf in states for slope in derivatives(program.rates, leaf)])
        self._times = plain_function(list(program.times))
        lates = [late.signal for late in program.pasts]
        self._shown = [*lates, *(late.drift for late in program.pasts), *program.signals]
        self._show = plain_function(self._shown)
        self._show_slopes: Plain | None = None
        self._moved: dict[tuple[str, int], Plain] = {}

    def solve(self, values: FloatArray, inputs: FloatArray, states: FloatArray | None = None) -> Steady:
        """Return steady running at constant inputs, or what belongs to given states.

        Newton's method from rest at the working point; where states have no steady value of their own, the smallest
        change is taken.

        ``values``: parameter values, shape (parameters,). ``inputs``: shape (inputs,). ``states``: states to keep,
        shape (states,); only the pasts are found then, as if they had always been so. Raises StructureError if there is
        no steady running.
        """
        at, rows = np.zeros(len(self._unknown)), slice(None)
        kept_states = np.zeros(len(self.program.states)) if states is None else states
        if states is not None:
            at[: len(self._still)] = states[self._still]
            rows = slice(len(self._still), None)
        unknowns = self._newton(values, inputs, at, rows, kept_states)
        if unknowns is None and states is None:
            unknowns = self._led(values, inputs)
        if unknowns is None and states is None:
            unknowns = self._settled(values, inputs)
        if unknowns is None:
            raise StructureError(
                f"structure {self.program.name}: no steady running was found at these inputs and parameters; is what "
                "drives it strong enough, and are all gains positive?"
            )
        return self._split(unknowns, kept_states, self._at(self._show, values, inputs, unknowns, kept_states))

    def slopes(self, steady: Steady, values: FloatArray, inputs: FloatArray, parameter: int, *, held: bool) -> Steady:
        """Return the derivatives of steady running to a parameter.

        ``parameter``: place of the parameter. ``held``: whether the states were given.
        """
        return self._slopes(steady, values, inputs, ("parameter", parameter), held=held)

    def state_slopes(self, steady: Steady, values: FloatArray, inputs: FloatArray, state: int) -> Steady:
        """Return the derivatives to a given state, by its place, of what belongs to given states."""
        slopes = self._slopes(steady, values, inputs, ("state", state), held=True)
        return replace(slopes, states=np.eye(len(self.program.states))[state])

    def _slopes(
        self, steady: Steady, values: FloatArray, inputs: FloatArray, leaf: tuple[str, int], *, held: bool
    ) -> Steady:
        count = len(self._formulas)
        if leaf not in self._moved:
            to = Formula(leaf[0], place=leaf[1])
            self._moved[leaf] = plain_function([*derivatives(self._formulas, to), *derivatives(self._shown, to)])
        arguments = (values, inputs, steady.states, steady.pasts, steady.samples)
        moved = self._call(self._moved[leaf], *arguments)
        change = np.zeros(count)
        rows = slice(len(self._still), None) if held else slice(None)
        if np.any(moved[:count][rows]):
            matrix = self._call(self._matrix, *arguments).reshape(count, count).T[rows, rows]
            change[rows] = np.linalg.lstsq(matrix, -moved[:count][rows], rcond=None)[0]
        shown = moved[count:]
        if np.any(change):
            shown = shown + self._call(self._show_slope_function(), *arguments).reshape(count, -1).T @ change
        return self._split(change, np.zeros(len(self.program.states)), shown)

    def _show_slope_function(self) -> Plain:
        if self._show_slopes is None:
            self._show_slopes = plain_function(
                [slope for leaf in self._unknown for slope in derivatives(self._shown, leaf)]
            )
        return self._show_slopes

    def _led(self, values: FloatArray, inputs: FloatArray) -> FloatArray | None:
        """Return steady running reached by leading the inputs there from rest: no limit is met on the way in vain."""
        kept_states = np.zeros(len(self.program.states))
        for steps in LEADING_STEPS:
            at: FloatArray | None = np.zeros(len(self._unknown))
            for share in np.linspace(0.0, 1.0, steps + 1):
                if at is not None:
                    at = self._newton(values, share * inputs, at, slice(None), kept_states)
            if at is not None:
                return at
        return None

    def _settled(self, values: FloatArray, inputs: FloatArray) -> FloatArray | None:
        """Return steady running reached as the motion reaches it from rest, in ever longer implicit steps; None if not.

        Dry friction jumps where motion begins: there Newton's steps point back and forth, and motion goes on (Kelley
        and Keyes, Convergence analysis of pseudo-transient continuation, 1998).
        """
        kept_states, at = np.zeros(len(self.program.states)), np.zeros(len(self._unknown))
        for step_s in SETTLING_STEPS_S:
            residual = self._at(self._left, values, inputs, at, kept_states)
            matrix = self._at(self._matrix, values, inputs, at, kept_states).reshape(at.size, at.size).T
            if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(residual))):
                return None
            at = at + np.linalg.lstsq(np.eye(at.size) / step_s - matrix, residual, rcond=None)[0]
        return self._newton(values, inputs, at, slice(None), kept_states)

    @staticmethod
    def _call(
        function: Plain,
        values: FloatArray,
        inputs: FloatArray,
        states: FloatArray,
        pasts: FloatArray,
        samples: FloatArray,
    ) -> FloatArray:
        with np.errstate(all="ignore"):
            results = function(values.tolist(), states.tolist(), pasts.tolist(), samples.tolist(), inputs.tolist(), 1.0)
        return np.asarray(results, dtype=np.float64)

    def longest_step(self, values: FloatArray, inputs: FloatArray, steady: Steady, delay_s: FloatArray) -> float:
        """Return the longest step that still follows small signals about steady running, and motion beside it [s].

        The fastest of them must not move by more than ``MOST_DECAY``, and the fastest that swings not by more than
        ``MOST_ANGLE``: with late signals that stand still, as for short times they do, and with late signals that are
        prompt, as for long times they are. Runge and Kutta's rule is stable up to 2.8. What holds still at rest and
        follows motion, as dry friction does, must not move by more either. Where a delay is shorter than the step, late
        signals are extrapolated, which loops bear up to about ``MOST_EXTRAPOLATED`` only.

        ``delay_s``: delays [s], shape (pasts,).
        """
        arguments = (values, inputs, steady.states, steady.pasts, steady.samples)
        count, still, states = len(self._unknown), len(self._still), len(self.program.states)
        matrix = self._call(self._matrix, *arguments).reshape(count, count).T
        state_matrix = self._call(self._own, *arguments).reshape(states, states)
        if not still or not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(state_matrix))):
            return np.inf
        through = np.linalg.lstsq(matrix[still:, still:], matrix[still:, :still], rcond=None)[0]
        prompt = np.linalg.eigvals(matrix[:still, :still] - matrix[:still, still:] @ through)
        rates = np.concatenate([np.linalg.eigvals(state_matrix), prompt])
        step = 1.0 / max(np.abs(rates).max() / MOST_DECAY, np.abs(rates.imag).max() / MOST_ANGLE, SLOWEST)
        step = min(step, MOST_DECAY * float(self._call(self._times, *arguments).min(initial=np.inf)))
        shortest = float(delay_s.min(initial=np.inf))
        extrapolated = MOST_EXTRAPOLATED / max(np.abs(prompt).max(), SLOWEST)
        return float(min(step, max(shortest, extrapolated)))

    def _at(
        self, function: Plain, values: FloatArray, inputs: FloatArray, at: FloatArray, kept_states: FloatArray
    ) -> FloatArray:
        """Return formulas at a place of the unknowns."""
        still, pasts = len(self._still), len(self.program.pasts)
        states = kept_states.copy()
        states[self._still] = at[:still]
        return self._call(function, values, inputs, states, at[still : still + pasts], at[still + pasts :])

    def _newton(
        self, values: FloatArray, inputs: FloatArray, at: FloatArray, rows: slice, kept_states: FloatArray
    ) -> FloatArray | None:
        """Return a place where the equations of some rows vanish, moving their own unknowns only; None if not found."""
        residual = self._at(self._left, values, inputs, at, kept_states)[rows]
        for _ in range(LARGEST_STEPS):
            if not residual.size or np.abs(residual).max() <= TOLERANCE * (1.0 + np.abs(at).max(initial=0.0)):
                return at
            square = self._at(self._matrix, values, inputs, at, kept_states).reshape(at.size, at.size).T
            matrix = square[rows, rows]
            if not (np.all(np.isfinite(matrix)) and np.all(np.isfinite(residual))):
                return None
            step = np.asarray(np.linalg.lstsq(matrix, -residual, rcond=1e-12)[0], dtype=np.float64)
            moved = self._shortened(values, inputs, at, residual, rows, kept_states, step)
            if moved is None:
                break
            at, residual = moved
        return at if np.abs(residual).max() <= np.sqrt(TOLERANCE) else None

    def _shortened(
        self,
        values: FloatArray,
        inputs: FloatArray,
        at: FloatArray,
        residual: FloatArray,
        rows: slice,
        kept_states: FloatArray,
        step: FloatArray,
    ) -> tuple[FloatArray, FloatArray] | None:
        """Return the place after a step, halved until what is left falls; None if it does not."""
        share = 1.0
        for _ in range(HALVINGS):
            tried = at.copy()
            tried[rows] += share * step
            after = self._at(self._left, values, inputs, tried, kept_states)[rows]
            if np.all(np.isfinite(after)) and np.linalg.norm(after) < np.linalg.norm(residual):
                return tried, after
            share *= 0.5
        return None

    def _split(self, at: FloatArray, kept_states: FloatArray, shown: FloatArray) -> Steady:
        still, pasts = len(self._still), len(self.program.pasts)
        states = kept_states.copy()
        states[self._still] = at[:still]
        return Steady(
            states=states,
            pasts=at[still : still + pasts],
            samples=at[still + pasts :],
            lates=shown[:pasts],
            drifts=shown[pasts : 2 * pasts],
            outputs=shown[2 * pasts :],
        )
