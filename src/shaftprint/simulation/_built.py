"""A structure made ready to be simulated: its equations, its compiled kernels, its constants."""

import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.models import Leaves, Program, Quantity, Structure, derivatives, evaluate, postorder, program_of
from shaftprint.simulation._compile import module_of
from shaftprint.simulation._exact_text import ExactText
from shaftprint.simulation._hoisted import Hoisted, hoisted
from shaftprint.simulation._kernel_text import KernelText
from shaftprint.simulation._steady import SteadyEquations


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Built:
    """Equations and kernels of a structure."""

    program: Program
    """The equations."""
    hoisted: Hoisted
    """The same with constants in the place of formulas of parameters."""
    text: str
    """Source text of the kernels."""
    steady: SteadyEquations
    """What vanishes in steady running."""
    slopes: dict[str, tuple[list[Quantity], ...]]
    """Derivatives of constants, delays and shifts to a parameter, by its name; found when first asked for."""

    @property
    def kernels(self) -> ModuleType:
        """The compiled kernels."""
        return module_of(self.text)

    @property
    def exact_kernels(self) -> ModuleType:
        """The compiled kernel of exact steps."""
        return module_of(ExactText(self.hoisted, len(self.program.inputs)).text())

    def constants(self, values: FloatArray, step_s: float) -> tuple[FloatArray, ...]:
        """Return constants, delays, shifts and periods at parameter values, each of shape (count,)."""
        leaves = _leaves(self.program, values, step_s)
        return tuple(np.array(evaluate(part, leaves)) for part in self._of_parameters)

    def constant_slopes(self, values: FloatArray, step_s: float, name: str) -> tuple[FloatArray, ...]:
        """Return the derivatives of the same to a parameter."""
        if name not in self.slopes:
            to = Quantity("parameter", place=self.program.parameters.index(name))
            self.slopes[name] = tuple(derivatives(part, to) for part in self._of_parameters)
        leaves = _leaves(self.program, values, step_s)
        return tuple(np.array(evaluate(part, leaves)) for part in self.slopes[name])

    def shifts_depend_on(self, names: Sequence[str]) -> bool:
        """Return whether a parameter shifts an output."""
        found = {node.name for node in postorder(self.program.shifts) if node.operation == "parameter"}
        return not found.isdisjoint(names)

    @property
    def _of_parameters(self) -> tuple[Sequence[Quantity], ...]:
        program = self.program
        delays = [late.delay for late in program.pasts]
        return self.hoisted.constants, delays, program.shifts, [taken.period for taken in program.samples]


def _leaves(program: Program, values: FloatArray, step_s: float) -> Leaves:
    """Return parameters, and everything else at rest: delays that vary start from there."""
    leaves: dict[tuple[str, int], FloatArray] = {("step", 0): np.asarray(step_s)}
    for kind, count in (("input", len(program.inputs)), ("state", len(program.states)), ("past", len(program.pasts))):
        leaves |= {(kind, i): np.asarray(0.0) for i in range(count)}
    return leaves | {("parameter", i): np.asarray(value) for i, value in enumerate(values)}


_BUILT: "weakref.WeakKeyDictionary[Structure, dict[frozenset[str], Built]]" = weakref.WeakKeyDictionary()


def build(structure: Structure, zeros: frozenset[str]) -> Built:
    """Return the equations and kernels of a structure, made once.

    Parameters
    ----------
    zeros
        Names of parameters that are zero for good.
    """
    known = _BUILT.setdefault(structure, {})
    if zeros not in known:
        program = program_of(structure, zeros)
        ready = hoisted(program)
        known[zeros] = Built(
            program=program,
            hoisted=ready,
            text=KernelText(ready, len(program.inputs)).text(),
            steady=SteadyEquations(program),
            slopes={},
        )
    return known[zeros]
