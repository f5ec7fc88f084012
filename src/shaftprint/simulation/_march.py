"""One simulation: its step, where it starts, its run through the compiled kernel."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import StructureError
from shaftprint.simulation._built import Built
from shaftprint.simulation._grid import Shift, Stencils, stencils
from shaftprint.simulation._kernel_text import LANES
from shaftprint.simulation._steady import Steady

# A computer's period must be a whole number of steps; the step is shortened up to this many times for it.
MOST_PARTS = 64


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class March:
    """A simulation that is about to run."""

    built: Built
    """Equations and kernels."""
    values: FloatArray
    """Parameter values, complex where a derivative is taken by a complex step."""
    parts: int
    """Steps between two samples."""
    step_s: float
    """Length of a step [s]."""
    held: bool
    """Whether inputs are held between samples."""
    constants: FloatArray
    """Formulas of parameters."""
    delay_s: FloatArray
    """Delays [s]."""
    shift_s: FloatArray
    """Shifts of the outputs [s]."""
    ticks: IntArray
    """Steps in each computer's period."""

    @classmethod
    def planned(cls, built: Built, values: FloatArray, interval_s: float, longest_step_s: float, *, hold: bool) -> Self:
        """Choose the step and find what stays the same during the run.

        Raises
        ------
        StructureError
            If a delay is negative, or a computer's period is no whole number of steps.
        """
        _, delay_s, shift_s, period_s = built.constants(values, interval_s)
        name = built.program.name
        if np.any(delay_s.real < 0.0):
            raise StructureError(
                f"simulation of {name}: expected delays of at least 0 s, found {delay_s.real.min():g} s."
            )
        least = int(np.ceil(interval_s / longest_step_s - 1e-9))
        parts = least
        while not _divides(interval_s / parts, period_s.real):
            parts += 1
            if parts > least * MOST_PARTS:
                raise StructureError(
                    f"simulation of {name}: expected a computer's period in a whole number of time steps, found "
                    f"{period_s.real.min():g} s with samples every {interval_s:g} s; choose times that fit it."
                )
        step_s = interval_s / parts
        return cls(
            built=built,
            values=values,
            parts=parts,
            step_s=step_s,
            held=hold,
            constants=built.constants(values, step_s)[0],
            delay_s=delay_s,
            shift_s=shift_s,
            ticks=np.maximum(np.rint(period_s.real / step_s), 1.0).astype(np.int64),
        )

    def start(self, inputs: FloatArray, initial: FloatArray | None) -> Steady:
        """Return where the run starts: steady running at the inputs, or the given states."""
        count = len(self.built.program.states)
        if initial is not None and initial.shape != (count,):
            raise StructureError(
                f"simulation of {self.built.program.name}: expected {count} states at the start "
                f"({', '.join(self.built.program.states)}), found shape {initial.shape}."
            )
        return self.built.steady.solve(self.values.real, inputs, initial)

    def run(
        self, inputs: FloatArray, start: Steady, wanted: tuple[str, ...], *, given: bool
    ) -> tuple[FloatArray, FloatArray]:
        """Return the outputs, shape (samples, outputs), and their derivatives, shape (samples, outputs, wanted).

        Parameters
        ----------
        inputs
            Inputs at the samples, shape (samples, inputs).
        given
            Whether the states at the start were given, so that they do not depend on parameters.
        """
        moved = self.built.shifts_depend_on(wanted) or bool(np.any(self.shift_s != 0.0))
        every = 1 if moved else self.parts
        table = np.ascontiguousarray(np.concatenate([inputs, np.repeat(inputs[-1:], self._after, axis=0)]))
        nodes = (table.shape[0] - 1) * self.parts // every + 1
        count = len(self.built.program.signals)
        samples = inputs.shape[0]
        y = np.empty((nodes, count), dtype=np.result_type(self.constants, self.delay_s, float))
        if not wanted:
            self.built.kernels.advance(*self._arguments(table, start, every), y)
        slopes = np.empty((samples, count, len(wanted)))
        for first in range(0, len(wanted), LANES):
            names = wanted[first : first + LANES]
            y_slopes = np.empty((nodes, count, LANES))
            lanes = [self._lane(name, inputs[0], start, given=given) for name in names]
            rows = np.zeros((lanes[0].kernel.size, LANES))
            rows[:, : len(names)] = np.stack([lane.kernel for lane in lanes], axis=1)
            self.built.kernels.advance_with_derivatives(*self._arguments(table, start, every), y, rows, y_slopes)
            for i in range(count):
                own = y_slopes[:, i, : len(names)]
                if moved:
                    shift = self._shift(i, samples)
                    own = shift.value(own, np.array([lane.outputs[i] for lane in lanes]))
                    moves = np.array([lane.shifts[i] for lane in lanes]) / self.step_s
                    if np.any(moves):
                        own = own - shift.change(y[:, i], np.asarray(start.outputs[i]))[:, None] * moves
                slopes[:, i, first : first + len(names)] = own
        if not moved:
            return y, slopes
        values = [self._shift(i, samples).value(y[:, i], np.asarray(start.outputs[i])) for i in range(count)]
        return np.stack(values, axis=1), slopes

    @property
    def _after(self) -> int:
        """Samples beyond the end for outputs that are early; inputs stay as they are."""
        early = max(0.0, -float(self.shift_s.real.min(initial=0.0))) / (self.step_s * self.parts)
        return int(np.ceil(early)) + 1 if early > 0.0 else 0

    def _arguments(self, table: FloatArray, start: Steady, every: int) -> tuple[object, ...]:
        stencil = self._stencil
        first = (start.states, start.pasts, start.samples, start.lates, start.drifts)
        kind = np.result_type(self.constants, self.delay_s, float)
        return (
            self.step_s,
            self.parts,
            every,
            self.held,
            table,
            self.constants.astype(kind),
            np.concatenate(first).astype(kind),
            stencil.first,
            stencil.weight.astype(kind),
            stencil.change.astype(kind),
            stencil.mask,
            self.ticks,
        )

    @property
    def _stencil(self) -> Stencils:
        return stencils(self.delay_s, self.step_s, varies=bool(self.built.hoisted.varying))

    def _shift(self, output: int, samples: int) -> Shift:
        """Return the samples of an output."""
        return Shift(self.shift_s[output] / self.step_s, samples, self.parts)

    def _lane(self, name: str, inputs: FloatArray, start: Steady, *, given: bool) -> "Lane":
        """Return the derivatives to one parameter of all that the run starts from."""
        values = np.asarray(self.values.real, dtype=np.float64)
        constants, delays, shifts, _ = self.built.constant_slopes(values, self.step_s, name)
        place = self.built.program.parameters.index(name)
        steady = self.built.steady.slopes(start, values, inputs, place, held=given)
        parts = (steady.states, steady.pasts, steady.samples, steady.lates, steady.drifts, delays, constants)
        return Lane(kernel=np.concatenate(parts), shifts=shifts, outputs=steady.outputs)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Lane:
    """Derivatives to one parameter of all that a run starts from."""

    kernel: FloatArray
    """Of states, pasts, samples, signals, drifts, delays and constants, one after the other."""
    shifts: FloatArray
    """Of the shifts of the outputs [s]."""
    outputs: FloatArray
    """Of the outputs before the start."""


def _divides(step_s: float, periods_s: FloatArray) -> bool:
    """Return whether every period is a whole number of steps."""
    parts = periods_s / step_s
    return bool(np.all(np.abs(parts - np.rint(parts)) < 1e-6) and np.all((parts > 0.5) | (parts == 0.0)))
