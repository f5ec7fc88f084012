"""A structure for small signals about any steady running."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._small_signal import SmallSignal
from shaftprint.models._structure import Structure
from shaftprint.models.equations._evaluate import Leaves
from shaftprint.notebook._shown import Shown
from shaftprint.simulation._compiled_structure import build
from shaftprint.simulation._equilibrium import Equilibrium, held_zeros, input_vector


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Linearisation(Shown):
    """The response to small signals about steady running, with exact delays."""

    equilibrium: Equilibrium
    """The steady running."""
    small_signal: SmallSignal
    """The linear equations."""
    values: FloatArray
    """Parameter values, shape (parameters,)."""
    at: Leaves
    """The steady running by leaves of the equations."""

    def response(self, s: ArrayLike, *, normalised: bool = False) -> ComplexArray:
        """Return the response of every output to the first input.

        ``s``: laplace variable [rad/s], shape (frequencies,). ``normalised``: whether to refer input and outputs, which
        are deviations over the values of the working point, to their values in this steady running instead: ``tau``,
        ``K_p`` and ``K_i`` are then those of the new working point (thesis eqs 2.14-2.25). Returns shape (outputs,
        frequencies).
        """
        laplace = np.atleast_1d(np.asarray(s, dtype=np.complex128))
        columns = [np.asarray([value]) for value in self.values]
        outputs = self.small_signal.program.outputs
        responses = [self.small_signal.response(laplace, columns, (), i, self.at)[0] for i in range(len(outputs))]
        if not normalised:
            return np.stack(responses)
        input_size = 1.0 + next(iter(self.equilibrium.inputs.values()))
        sizes = [input_size / (1.0 + self.equilibrium.outputs[name]) for name in outputs]
        return np.stack([size * response for size, response in zip(sizes, responses, strict=True)])


def linearise(structure: Structure, values: ArrayLike, inputs: Mapping[str, float]) -> Linearisation:
    """Return a structure for small signals about its steady running at constant inputs.

    Parameters
    ----------
    values
        Parameter values, shape (parameters,).
    inputs
        Value of each input, in the structure's own units.

    Raises
    ------
    StructureError
        If there is no such steady running, or an input is missing.
    """
    vector = np.asarray(values, dtype=np.float64)
    built = build(structure, held_zeros(structure, vector))
    program = built.program
    source = input_vector(structure, inputs)
    steady = built.steady.solve(vector, source)
    at: dict[tuple[str, int], FloatArray] = {("input", i): np.asarray(u) for i, u in enumerate(source)}
    for kind, at_rest in (("state", steady.states), ("past", steady.pasts), ("sample", steady.samples)):
        at |= {(kind, i): np.asarray(value) for i, value in enumerate(at_rest)}
    return Linearisation(
        equilibrium=Equilibrium.of(program, inputs, steady),
        small_signal=SmallSignal(program),
        values=vector,
        at=at,
    )
