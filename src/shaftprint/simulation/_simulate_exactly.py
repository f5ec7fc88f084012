"""The response of a structure to jumps, exact on both sides of each."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ExactStepsError
from shaftprint.models._structure import Structure
from shaftprint.simulation._compiled_structure import Built, build
from shaftprint.simulation._equilibrium import held_zeros
from shaftprint.simulation._exact_grid import PRE, ExactGrid, jump_times
from shaftprint.simulation._simulate import Trace, expect_values, input_table, uniform_interval

# A delay is resolved by at least so many steps.
PARTS = 4


def simulate_exactly(
    structure: Structure,
    values: ArrayLike,
    time_s: ArrayLike,
    inputs: Mapping[str, ArrayLike],
    *,
    hold: bool = False,
    longest_step_s: float = 5e-3,
) -> Trace:
    """Simulate a structure with steps that end wherever a jump or a corner of an input arrives, however late.

    The method of steps (Bellman and Cooke, Differential-Difference Equations, 1963, chapter 3) with Runge-Kutta steps
    of fourth order and cubic interpolation that never reaches across a jump: the error falls with the fourth power of
    the step, also where signals jump. For fits and long records ``simulate`` is faster.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).
    time_s
        Uniform times [s], shape (samples,).
    inputs
        Each input at these times, shape (samples,), in the structure's own units; straight in between.
    hold
        Whether inputs keep each value until the next time; at that time the output is what it is after the jump.
    longest_step_s
        Upper bound of the time step [s]; a delay has at least four steps.

    Raises
    ------
    ExactStepsError
        If a delay varies, a computer takes values, or jumps are too many to be followed.
    StructureError
        In the cases of ``simulate``.
    """
    vector = np.asarray(values, dtype=np.float64)
    expect_values(structure, vector, ())
    time = np.asarray(time_s, dtype=np.float64)
    uniform_interval(structure, time)
    table = input_table(structure, inputs, time.size)
    built = build(structure, held_zeros(structure, vector))
    if built.program.samples or built.hoisted.varying:
        raise ExactStepsError(
            f"simulation of {structure.name}: exact steps need constant delays and no computer's period; use simulate."
        )
    outputs = _run(built, vector, time, table, hold=hold, longest_step_s=longest_step_s)
    return Trace(
        time_s=frozen_float(time),
        outputs={name: outputs[:, i] for i, name in enumerate(built.program.outputs)},
        derivatives={name: np.empty((0, time.size)) for name in built.program.outputs},
    )


def _run(
    built: Built, values: FloatArray, time: FloatArray, table: FloatArray, *, hold: bool, longest_step_s: float
) -> FloatArray:
    constants, delay_s, shift_s, _ = built.constants(values, longest_step_s)
    start = built.steady.solve(values, table[0], None)
    longest_step_s = min(longest_step_s, built.steady.longest_step(values, table[0], start, delay_s))
    wanted = time[:, None] - shift_s[None, :]
    # one step more, so that the last sample is the start of a step too
    stop = max(float(time[-1]), float(wanted.max())) + longest_step_s
    jumps = jump_times(time[_corners(table, hold=hold)], delay_s, stop)
    keys = np.unique(np.concatenate([time, wanted[wanted > time[0]].ravel(), jumps, [stop]]))
    keys = keys[np.concatenate([[True], np.diff(keys) > 1e-12 * max(1.0, abs(stop))])]
    positive = delay_s[delay_s > 0.0]
    shortest = min(longest_step_s, float(positive.min()) / PARTS) if positive.size else longest_step_s
    grid = ExactGrid.between(keys, _nearest(keys, jumps), shortest)
    times = grid.with_past(delay_s)
    u, rise = _stage_inputs(grid, time, table, hold=hold)
    before = start.lates[None, :] + (times[:PRE, None] - times[PRE]) * start.drifts[None, :]
    y = np.empty((grid.step_s.size, len(built.program.signals)))
    built.exact_kernels.advance(times, u, rise, constants, start.states, before, delay_s, grid.first_nodes(delay_s), y)
    # the last node that stands at a time is the one after its jump
    node = np.searchsorted(grid.time_s, wanted + 1e-12 * max(1.0, abs(stop)), side="right") - 1
    sampled = np.take_along_axis(y, np.clip(node, 0, y.shape[0] - 1), axis=0)
    return np.where(wanted < time[0], start.outputs[None, :], sampled)


def _corners(table: FloatArray, *, hold: bool) -> FloatArray:
    """Return whether an input jumps, or turns a corner, at each time."""
    change = np.diff(table, axis=0)
    if not hold:
        change = np.diff(np.concatenate([np.zeros((1, table.shape[1])), change]), axis=0)
        return np.concatenate([np.any(change != 0.0, axis=1), [True]])
    return np.concatenate([[False], np.any(change != 0.0, axis=1)])


def _nearest(keys: FloatArray, jumps: FloatArray) -> FloatArray:
    """Return the keys at which jumps are, those that differ by rounding taken for one."""
    index = np.clip(np.searchsorted(keys, jumps), 1, keys.size - 1)
    closer = np.abs(keys[index - 1] - jumps) < np.abs(keys[index] - jumps)
    return np.unique(keys[np.where(closer, index - 1, index)])


def _stage_inputs(grid: ExactGrid, time: FloatArray, table: FloatArray, *, hold: bool) -> tuple[FloatArray, FloatArray]:
    """Return the inputs at start, middle and end of each step, shape (steps, 3, inputs), and their slopes [1/s]."""
    step = grid.step_s
    middle = grid.time_s[:-1] + 0.5 * step
    row = np.clip(np.searchsorted(time, middle, side="right") - 1, 0, time.size - 1)
    # an empty step stands on the left of its jump
    empty = step == 0.0
    row = np.where(empty & (row > 0) & (np.abs(time[row] - middle) < 1e-9), row - 1, row)
    after = np.minimum(row + 1, time.size - 1)
    if hold:
        held = np.repeat(table[row][:, None], 3, axis=1)
        return np.ascontiguousarray(held), np.zeros((step.size, table.shape[1]))
    length = np.where(after > row, time[after] - time[row], 1.0)[:, None]
    rise = (table[after] - table[row]) / length
    at = grid.time_s[:-1, None] + step[:, None] * np.array([0.0, 0.5, 1.0]) - time[row][:, None]
    return table[row][:, None] + at[:, :, None] * rise[:, None], rise
