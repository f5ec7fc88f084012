"""One simulation: its step, where it starts, its run through the compiled kernel."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import StructureError
from shaftprint.simulation._compiled_structure import Built
from shaftprint.simulation._equation_text import LANES
from shaftprint.simulation._grid import Shift, stencils
from shaftprint.simulation._steady import Steady

# The step is shortened up to this many times for signals that are fast, and as often for a computer's period.
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

    start: Steady
    """Where the run starts."""
    given: bool
    """Whether the states at the start were given, so that they do not depend on parameters."""

    @classmethod
    def planned(
        cls,
        built: Built,
        values: FloatArray,
        inputs: FloatArray,
        interval_s: float,
        longest_step_s: float,
        *,
        hold: bool,
        initial: FloatArray | None,
    ) -> Self:
        """Choose the step and find what stays the same during the run.

        ``inputs``: inputs at the start, shape (inputs,). ``interval_s``: time between two samples [s]. ``initial``:
        states at the start, shape (states,); steady running if not given. Raises StructureError if a delay is negative,
        the states do not fit, there is no steady running, a time constant is too short, or a computer's period is no
        whole number of steps.
        """
        _, delay_s, shift_s, period_s = built.constants(values, interval_s)
        if np.any(delay_s.real < 0.0):
            raise StructureError(
                f"simulation of {built.program.name}: expected delays of at least 0 s, found {delay_s.real.min():g} s."
            )
        start = starting(built, values, inputs, initial)
        longest = built.steady.longest_step(values.real, inputs, start, delay_s.real)
        parts = steps_between(built.program.name, interval_s, longest_step_s, longest, period_s.real)
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
            start=start,
            given=initial is not None,
        )

    def run(
        self, inputs: FloatArray, wanted: tuple[str, ...], *, of_states: bool = False
    ) -> tuple[FloatArray, FloatArray]:
        """Return the outputs, shape (samples, outputs), and their derivatives, shape (samples, outputs, wanted).

        ``inputs``: inputs at the samples, shape (samples, inputs). ``of_states``: whether derivatives to the states at
        the start stand behind those to parameters.
        """
        states = len(self.built.program.states) if of_states else 0
        columns = [*wanted, *range(states)]
        moved = self.built.shifts_depend_on(wanted) or bool(np.any(self.shift_s != 0.0))
        every = 1 if moved else self.parts
        table = np.ascontiguousarray(np.concatenate([inputs, np.repeat(inputs[-1:], self._after, axis=0)]))
        nodes = (table.shape[0] - 1) * self.parts // every + 1
        count = len(self.built.program.signals)
        samples = inputs.shape[0]
        y = np.empty((nodes, count), dtype=np.result_type(self.constants, self.delay_s, float))
        if not columns:
            self.built.kernels.advance(*self._arguments(table, every), y)
        slopes = np.empty((samples, count, len(columns)))
        for first in range(0, len(columns), LANES):
            lanes = [self._lane(column, inputs[0]) for column in columns[first : first + LANES]]
            y_slopes = np.empty((nodes, count, LANES))
            rows = np.zeros((lanes[0].kernel.size, LANES))
            rows[:, : len(lanes)] = np.stack([lane.kernel for lane in lanes], axis=1)
            arguments = self._arguments(table, every)
            self.built.kernels.advance_with_derivatives(*arguments, y, rows.ravel(), y_slopes)
            lane_slopes = y_slopes[:, :, : len(lanes)]
            slopes[:, :, first : first + len(lanes)] = (
                self._shifted_slopes(y, lane_slopes, lanes, samples) if moved else lane_slopes
            )
        if not moved:
            return y, slopes
        values = [self._shift(i, samples).value(y[:, i], np.asarray(self.start.outputs[i])) for i in range(count)]
        return np.stack(values, axis=1), slopes

    def _shifted_slopes(self, y: FloatArray, slopes: FloatArray, lanes: "Sequence[Lane]", samples: int) -> FloatArray:
        """Return the derivatives of shifted outputs, shape (samples, outputs, lanes), from those at all nodes."""
        shifted = np.empty((samples, *slopes.shape[1:]))
        for i in range(slopes.shape[1]):
            shift = self._shift(i, samples)
            output_slopes = shift.value(slopes[:, i], np.array([lane.outputs[i] for lane in lanes]))
            moves = np.array([lane.shifts[i] for lane in lanes]) / self.step_s
            if np.any(moves):
                output_slopes = (
                    output_slopes - shift.change(y[:, i], np.asarray(self.start.outputs[i]))[:, None] * moves
                )
            shifted[:, i] = output_slopes
        return shifted

    @property
    def _after(self) -> int:
        """Samples beyond the end for outputs that are early; inputs stay as they are."""
        early = max(0.0, -float(self.shift_s.real.min(initial=0.0))) / (self.step_s * self.parts)
        return int(np.ceil(early)) + 1 if early > 0.0 else 0

    def _arguments(self, table: FloatArray, every: int) -> tuple[object, ...]:
        stencil = stencils(self.delay_s, self.step_s, varies=bool(self.built.hoisted.varying))
        start = self.start
        first = (start.states, start.pasts, start.drifts, start.samples, self.constants, start.lates)
        kind = np.result_type(self.constants, self.delay_s, float)
        return (
            self.step_s,
            self.parts,
            every,
            self.held,
            table,
            np.concatenate(first).astype(kind),
            stencil.first,
            stencil.weight.astype(kind),
            stencil.change.astype(kind),
            stencil.bend.astype(kind),
            stencil.mask,
            self.ticks,
            np.array(self.built.hoisted.varying, dtype=np.int64),
        )

    def _shift(self, output: int, samples: int) -> Shift:
        """Return the samples of an output."""
        return Shift(self.shift_s[output].item() / self.step_s, samples, self.parts)

    def _lane(self, column: str | int, inputs: FloatArray) -> "Lane":
        """Return the derivatives of all that the run starts from to a parameter, by name, or a state, by its place."""
        values = np.asarray(self.values.real, dtype=np.float64)
        if isinstance(column, str):
            constants, delays, shifts, _ = self.built.constant_slopes(values, self.step_s, column)
            index = self.built.program.parameters.index(column)
            steady = self.built.steady.slopes(self.start, values, inputs, index, held=self.given)
        else:
            constants, delays, shifts = (np.zeros(one.size) for one in (self.constants, self.delay_s, self.shift_s))
            steady = self.built.steady.state_slopes(self.start, values, inputs, column)
        parts = (steady.states, steady.pasts, steady.drifts, steady.samples, constants, steady.lates, delays)
        return Lane(kernel=np.concatenate(parts), shifts=shifts, outputs=steady.outputs)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Lane:
    """Derivatives to one parameter or state of all that a run starts from."""

    kernel: FloatArray
    """Of states, pasts, drifts, samples, constants, signals and delays, one after the other."""
    shifts: FloatArray
    """Of the shifts of the outputs [s]."""
    outputs: FloatArray
    """Of the outputs before the start."""


def starting(built: Built, values: FloatArray, inputs: FloatArray, initial: FloatArray | None) -> Steady:
    """Return where a run starts: steady running at the inputs, or the given states."""
    count = len(built.program.states)
    if initial is not None and initial.shape != (count,):
        raise StructureError(
            f"simulation of {built.program.name}: expected {count} states at the start "
            f"({', '.join(built.program.states)}), found shape {initial.shape}."
        )
    return built.steady.solve(values.real, inputs, initial)


def steps_between(name: str, interval_s: float, longest_step_s: float, followed_s: float, periods_s: FloatArray) -> int:
    """Return how many steps go between two samples.

    ``longest_step_s``, ``followed_s``: upper bound of the step [s]: as asked for, and that which small signals can
    follow; for the latter the steps are halved, so that a fit seldom meets a change of the step. ``periods_s``: periods
    of computers [s]; 0 for every step. Raises StructureError if that takes more than ``MOST_PARTS`` times as many steps
    as asked for.
    """
    least = parts = int(np.ceil(interval_s / longest_step_s - 1e-9))
    while interval_s / parts > followed_s:
        parts *= 2
        if parts > least * MOST_PARTS:
            raise StructureError(
                f"simulation of {name}: expected signals that steps of {longest_step_s / MOST_PARTS:.2g} s can follow, "
                f"found some that need {followed_s:.2g} s; hold a time constant that short at zero, or ask for a "
                "shorter longest_step_s."
            )
    most = parts * MOST_PARTS
    while not _divides(interval_s / parts, periods_s):
        parts += 1
        if parts > most:
            raise StructureError(
                f"simulation of {name}: expected a computer's period in a whole number of time steps, found "
                f"{periods_s.min():g} s with samples every {interval_s:g} s; choose times that fit it."
            )
    return parts


def _divides(step_s: float, periods_s: FloatArray) -> bool:
    """Return whether every period is a whole number of steps."""
    parts = periods_s / step_s
    return bool(np.all(np.abs(parts - np.rint(parts)) < 1e-6) and np.all((parts > 0.5) | (parts == 0.0)))
