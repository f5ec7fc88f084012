"""A structure made ready to be simulated: its equations, its compiled kernels, its constants."""

import weakref
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._program import Program, program_of
from shaftprint.models._structure import Structure
from shaftprint.models.equations._calculus import derivatives, postorder
from shaftprint.models.equations._formula import Formula
from shaftprint.simulation._compile import module_of
from shaftprint.simulation._exact_text import ExactText
from shaftprint.simulation._kernel_text import KernelText
from shaftprint.simulation._loop_invariants import Hoisted, hoisted
from shaftprint.simulation._plain_text import Plain, plain_function
from shaftprint.simulation._steady import SteadyEquations


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Built:
    """Equations and kernels of a structure."""

    program: Program
    """The equations."""
    hoisted: Hoisted
    """The same with constants in the place of formulas of parameters."""
    steady: SteadyEquations
    """What vanishes in steady running."""
    functions: dict[str | None, Plain]
    """Functions of constants, delays, shifts and periods, and of their derivatives by parameter; made when wanted."""
    modules: dict[type[KernelText | ExactText], ModuleType]
    """Compiled kernels by what their text is made of; made when wanted."""

    @property
    def kernels(self) -> ModuleType:
        """The compiled kernels on a uniform grid."""
        return self._module(KernelText)

    @property
    def exact_kernels(self) -> ModuleType:
        """The compiled kernel of exact steps."""
        return self._module(ExactText)

    def _module(self, kind: type[KernelText | ExactText]) -> ModuleType:
        if kind not in self.modules:
            self.modules[kind] = module_of(kind(self.hoisted, len(self.program.inputs)).text())
        return self.modules[kind]

    def constants(self, values: FloatArray, step_s: float) -> tuple[FloatArray, ...]:
        """Return constants, delays [s], shifts [s] and periods [s] at parameter values, each of shape (count,).

        Delays that vary are those at rest.

        Raises StructureError if a formula is not finite, as where it divides by a time constant of zero.
        """
        if None not in self.functions:
            self.functions[None] = plain_function(self._of_parameters)
        return self._split(self.functions[None], values, step_s)

    def constant_slopes(self, values: FloatArray, step_s: float, name: str) -> tuple[FloatArray, ...]:
        """Return the derivatives of the same to a parameter."""
        if name not in self.functions:
            to = Formula("parameter", place=self.program.parameters.index(name))
            self.functions[name] = plain_function(derivatives(self._of_parameters, to))
        return self._split(self.functions[name], values, step_s)

    def _split(self, function: Plain, values: FloatArray, step_s: float) -> tuple[FloatArray, ...]:
        program = self.program
        counts = (len(self.hoisted.constants), len(program.pasts), len(program.shifts), len(program.samples))
        zeros = [0.0] * max(len(program.states), len(program.pasts), len(program.inputs), len(program.samples))
        with np.errstate(all="ignore"):
            numbers = np.array(
                function(values.tolist(), zeros, zeros, zeros, zeros, step_s), dtype=np.result_type(values, 0.0)
            )
        if not np.all(np.isfinite(numbers)):
            zero = [name for name, value in zip(program.parameters, values, strict=True) if value == 0.0]
            raise StructureError(
                f"simulation of {program.name}: expected equations that are finite, found a division by zero or a "
                f"number that is none; at zero are {', '.join(zero) or 'no parameters'}: bound a time constant away "
                "from zero, or hold it there with held_at and leave it out of what is wanted."
            )
        parts, begin = [], 0
        for count in counts:
            parts.append(numbers[begin : begin + count])
            begin += count
        return tuple(parts)

    def shifts_depend_on(self, names: Sequence[str]) -> bool:
        """Return whether a parameter shifts an output."""
        parameters = {node.name for node in postorder(self.program.shifts) if node.operation == "parameter"}
        return not parameters.isdisjoint(names)

    @property
    def _of_parameters(self) -> list[Formula]:
        program = self.program
        delays = [late.delay for late in program.pasts]
        periods = [sample.period for sample in program.samples]
        return [*self.hoisted.constants, *delays, *program.shifts, *periods]


_BUILT: "weakref.WeakKeyDictionary[Structure, dict[frozenset[str], Built]]" = weakref.WeakKeyDictionary()


def build(structure: Structure, zeros: frozenset[str]) -> Built:
    """Return the equations and kernels of a structure, made once.

    ``zeros``: names of parameters that are zero for good.
    """
    built = _BUILT.setdefault(structure, {})
    if zeros not in built:
        program = program_of(structure, zeros)
        ready = hoisted(program)
        built[zeros] = Built(
            program=program,
            hoisted=ready,
            steady=SteadyEquations(program),
            functions={},
            modules={},
        )
    return built[zeros]
