"""The steady running of a structure at constant inputs."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import StructureError
from shaftprint.models._program import Program
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.simulation._compiled_structure import build
from shaftprint.simulation._steady import Steady


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Equilibrium(Shown):
    """Steady running at constant inputs."""

    inputs: Mapping[str, float]
    """The inputs, in the structure's own units."""
    states: FloatArray
    """The states, shape (states,)."""
    state_names: tuple[str, ...]
    """What the equations call them, each once: the second of two of one name has a 2 behind it."""
    outputs: Mapping[str, float]
    """The outputs."""

    @classmethod
    def of(cls, program: Program, inputs: Mapping[str, float], steady: Steady) -> Self:
        """Return the steady running of a program by name."""
        return cls(
            inputs=dict(inputs),
            states=frozen_float(steady.states),
            state_names=each_once(program.states),
            outputs=dict(zip(program.outputs, (float(value) for value in steady.outputs), strict=True)),
        )


def equilibrium(structure: Structure, values: ArrayLike, inputs: Mapping[str, float]) -> Equilibrium:
    """Return the steady running of a structure at constant inputs.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).
    inputs
        Value of each input, in the structure's own units.

    Raises
    ------
    StructureError
        If there is none, or an input is missing.
    """
    vector = np.asarray(values, dtype=np.float64)
    built = build(structure, held_zeros(structure, vector))
    return Equilibrium.of(built.program, inputs, built.steady.solve(vector, input_vector(structure, inputs)))


def state_names(structure: Structure, values: ArrayLike) -> tuple[str, ...]:
    """Return what the equations of a structure call their states, each once, as ``Equilibrium`` does.

    ``values``: parameter values, shape (parameters,): a lag that is held at zero has no state.
    """
    vector = np.asarray(values, dtype=np.float64)
    return each_once(build(structure, held_zeros(structure, vector)).program.states)


def each_once(names: Sequence[str]) -> tuple[str, ...]:
    """Return names with a number behind those that came before."""
    counts = [names[: index + 1].count(name) for index, name in enumerate(names)]
    return tuple(name if count == 1 else f"{name} {count}" for name, count in zip(names, counts, strict=True))


def input_vector(structure: Structure, inputs: Mapping[str, float]) -> FloatArray:
    """Return the inputs in their order.

    Raises StructureError if one is missing, or not one of the structure's.
    """
    if set(inputs) != set(structure.inputs):
        raise StructureError(
            f"structure {structure.name}: expected the inputs {', '.join(structure.inputs)}, found "
            f"{', '.join(inputs) or 'none'}."
        )
    return np.array([float(inputs[name]) for name in structure.inputs])


def held_zeros(structure: Structure, values: FloatArray, wanted: tuple[str, ...] = ()) -> frozenset[str]:
    """Return the parameters that are zero and stay so: lags and delays that are not there."""
    pairs = zip(structure.parameters, values, strict=True)
    return frozenset(p.name for p, value in pairs if p.held and value == 0.0 and p.name not in wanted)
