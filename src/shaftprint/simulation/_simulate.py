"""The response of a structure in time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.simulation._compiled_structure import build
from shaftprint.simulation._equilibrium import held_zeros
from shaftprint.simulation._march import March


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Trace(Shown):
    """What a structure does in time."""

    time_s: FloatArray
    """Time [s], shape (samples,)."""
    outputs: Mapping[str, FloatArray]
    """Each output, shape (samples,)."""
    derivatives: Mapping[str, FloatArray]
    """Derivatives of each output to the wanted parameters, and to states at the start behind them where those are
    wanted, shape (wanted, samples)."""


@refusing_none(StructureError)
def simulate(
    structure: Structure,
    values: ArrayLike,
    time_s: ArrayLike,
    inputs: Mapping[str, ArrayLike],
    *,
    wanted: Sequence[str] = (),
    hold: bool = False,
    longest_step_s: float = 5e-3,
    initial: ArrayLike | None = None,
    of_states: bool = False,
) -> Trace:
    """Simulate a structure, linear or not, with exact delays.

    Fourth-order Runge-Kutta steps; delayed signals are interpolated by a cubic. Before the start everything stood as
    at the start.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).
    time_s
        Uniform times [s], shape (samples,).
    inputs
        Each input at these times, shape (samples,), in the structure's own units; straight in between.
    wanted
        Names of the parameters whose derivatives are wanted: exact ones of the computed values.
    hold
        Whether inputs keep each value until the next time, as those of a computer do, instead of being straight.
    longest_step_s
        Upper bound of the time step [s]; the step divides the interval of the times, and is shorter where the structure
        has faster small signals than that can follow.
    initial
        States at the start, shape (states,), see ``equilibrium``; steady running at the first inputs if not given.
    of_states
        Whether derivatives to the states at the start are wanted too.

    Raises
    ------
    StructureError
        If times are not uniform, inputs are missing or of another length, values or a formula of them are not finite,
        a delay is negative, a time constant is too short to be followed, or there is no steady running to start from.
    """
    vector = np.asarray(values)
    expect_values(structure, vector, wanted)
    time = np.asarray(time_s, dtype=np.float64)
    interval = uniform_interval(structure, time)
    table = input_table(structure, inputs, time.size)
    real = np.asarray(vector.real, dtype=np.float64)
    built = build(structure, held_zeros(structure, real, tuple(wanted)))
    states = None if initial is None else np.asarray(initial, dtype=np.float64)
    march = March.planned(built, vector, table[0], interval, longest_step_s, hold=hold, initial=states)
    outputs, slopes = march.run(table, tuple(wanted), of_states=of_states)
    names = built.program.outputs
    return Trace(
        time_s=frozen_float(time),
        outputs={name: outputs[:, i] for i, name in enumerate(names)},
        derivatives={name: slopes[:, i].T for i, name in enumerate(names)},
    )


def expect_values(structure: Structure, values: FloatArray, wanted: Sequence[str]) -> None:
    """Check the parameter values and the names of the wanted ones."""
    if values.shape != (len(structure.parameters),):
        raise StructureError(
            f"structure {structure.name}: expected {len(structure.parameters)} parameter values "
            f"({', '.join(structure.names)}), found an array of shape {values.shape}."
        )
    if not np.all(np.isfinite(values)):
        wrong = [name for name, value in zip(structure.names, values, strict=True) if not np.isfinite(value)]
        raise StructureError(f"structure {structure.name}: expected finite values, found none of {', '.join(wrong)}.")
    unknown = [name for name in wanted if name not in structure.names]
    if unknown:
        raise StructureError(
            f"structure {structure.name} has no parameter {', '.join(unknown)}; it has {', '.join(structure.names)}."
        )


def uniform_interval(structure: Structure, time: FloatArray) -> float:
    """Return the interval of uniform times."""
    if time.ndim != 1 or time.size < 2:
        raise StructureError(f"simulation of {structure.name}: expected two or more times, found shape {time.shape}.")
    interval = float(time[-1] - time[0]) / (time.size - 1)
    if not interval > 0.0 or np.abs(np.diff(time) - interval).max() > 1e-6 * interval + 1e-12 * abs(time[-1]):
        raise StructureError(f"simulation of {structure.name}: expected uniform ascending times.")
    return interval


def input_table(structure: Structure, inputs: Mapping[str, ArrayLike], samples: int) -> FloatArray:
    """Return the inputs in their order, shape (samples, inputs)."""
    if set(inputs) != set(structure.inputs):
        raise StructureError(
            f"simulation of {structure.name}: expected the inputs {', '.join(structure.inputs)}, found "
            f"{', '.join(inputs) or 'none'}."
        )
    table = np.empty((samples, len(structure.inputs)))
    for i, name in enumerate(structure.inputs):
        values = np.asarray(inputs[name], dtype=np.float64)
        if values.shape != (samples,) or not np.all(np.isfinite(values)):
            raise StructureError(
                f"simulation of {structure.name}, input {name}: expected {samples} finite values, found shape "
                f"{values.shape}{'' if np.all(np.isfinite(values)) else ' with values that are not finite'}."
            )
        table[:, i] = values
    return table
