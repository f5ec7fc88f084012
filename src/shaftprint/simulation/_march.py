"""One simulation: its step, where it starts, its run through the compiled kernel."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import StructureError
from shaftprint.simulation._built import Built
from shaftprint.simulation._evaluate import Array
from shaftprint.simulation._grid import Stencils, shifted, stencils
from shaftprint.simulation._kernel_text import LANES
from shaftprint.simulation._steady import Steady

# A computer's period must be a whole number of steps; the step is shortened up to this many times for it.
MOST_PARTS = 64


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class March:
    """A simulation that is about to run."""

    built: Built
    """Equations and kernels."""
    values: Array
    """Parameter values, complex where a derivative is taken by a complex step."""
    parts: int
    """Steps between two samples."""
    step_s: float
    """Length of a step [s]."""
    held: bool
    """Whether inputs are held between samples."""
    constants: Array
    """Formulas of parameters."""
    delay_s: Array
    """Delays [s]."""
    shift_s: Array
    """Shifts of the outputs [s]."""
    ticks: IntArray
    """Steps in each computer's period."""

    @classmethod
    def planned(cls, built: Built, values: Array, interval_s: float, longest_step_s: float, *, hold: bool) -> Self:
        """Choose the step and find what stays the same during the run.

        Raises
        ------
        StructureError
            If a delay is negative, or a computer's period is no whole number of steps.
        """
        constants, delay_s, shift_s, period_s = built.constants(values)
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
            constants=constants,
            delay_s=delay_s,
            shift_s=shift_s,
            ticks=np.rint(period_s.real / step_s).astype(np.int64),
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
    ) -> tuple[Array, FloatArray]:
        """Return the outputs, shape (samples, outputs), and their derivatives, shape (samples, outputs, wanted).

        Parameters
        ----------
        inputs
            Inputs at the samples, shape (samples, inputs).
        given
            Whether the states at the start were given, so that they do not depend on parameters.
        """
        every = 1 if np.any(self.shift_s != 0.0) else self.parts
        # what is early needs a little of what comes after the end: inputs stay as they are
        early = int(np.ceil(max(0.0, -float(self.shift_s.real.min(initial=0.0))) / (self.step_s * self.parts)))
        after = early + 1 if early else 0
        table = np.ascontiguousarray(np.concatenate([inputs, np.repeat(inputs[-1:], after, axis=0)]))
        nodes = (table.shape[0] - 1) * self.parts // every + 1
        count = len(self.built.program.signals)
        if not wanted:
            y = np.empty((nodes, count), dtype=np.result_type(self.constants, self.delay_s, float))
            self.built.kernels.advance(*self._arguments(table, start, every), y)
            values = [self._sampled(y[:, i], start.outputs[i], i, inputs.shape[0])[0] for i in range(count)]
            return np.stack(values, axis=1), np.empty((inputs.shape[0], count, 0))
        slopes = np.empty((inputs.shape[0], count, len(wanted)))
        for first in range(0, len(wanted), LANES):
            names = wanted[first : first + LANES]
            y, y_slopes = np.empty((nodes, count)), np.empty((nodes, count, LANES))
            lanes = [self._lane(name, inputs[0], start, given=given) for name in names]
            rows = np.zeros((lanes[0].kernel.size, LANES))
            rows[:, : len(names)] = np.stack([lane.kernel for lane in lanes], axis=1)
            self.built.kernels.advance_with_derivatives(*self._arguments(table, start, every), y, rows, y_slopes)
            found = []
            for i in range(count):
                value, change = self._sampled(y[:, i], start.outputs[i], i, inputs.shape[0])
                before = np.array([lane.outputs[i] for lane in lanes])
                own, _ = self._sampled(y_slopes[:, i, : len(names)], before, i, inputs.shape[0])
                own = own - change[:, None] * np.array([lane.shifts[i] for lane in lanes])
                slopes[:, i, first : first + len(names)] = own
                found.append(value)
        return np.stack(found, axis=1), slopes

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
        return stencils(self.delay_s, self.step_s)

    def _sampled(self, y: Array, before: Array, output: int, samples: int) -> tuple[Array, Array]:
        """Return an output at the samples and how fast it changes there [1/s]; the latter only where it is shifted."""
        shift = self.shift_s[output]
        if not np.any(self.shift_s != 0.0):
            return y, np.zeros(samples)
        if shift == 0.0 and not np.iscomplexobj(shift):
            value, change = (
                y[: samples * self.parts : self.parts],
                np.gradient(y, axis=0)[: samples * self.parts : self.parts],
            )
            return value, change / self.step_s
        value, change = shifted(y, np.asarray(before), shift / self.step_s, samples, self.parts)
        return value, change / self.step_s

    def _lane(self, name: str, inputs: FloatArray, start: Steady, *, given: bool) -> "Lane":
        """Return the derivatives to one parameter of all that the run starts from."""
        values = np.asarray(self.values.real, dtype=np.float64)
        constants, delays, shifts, _ = self.built.constant_slopes(values, name)
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
    return bool(np.all(np.abs(parts - np.rint(parts)) < 1e-6) and np.all(parts > 0.5))
