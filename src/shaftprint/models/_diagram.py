"""A part of a structure written as equations of signals, with limits, products and whatever else is not linear.

Equations of several signals ask for the further ones with ``flow.input``: these are inputs of the structure, named in
``further``. A structure names a path for each of its inputs; the one from the first input holds the equations, those
from the others are ``port(output, source)``, which in time add nothing to it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._expression import Dual, Gradient, Walk
from shaftprint.models._parameter import Parameter
from shaftprint.models._program import Program, completed
from shaftprint.models._small_signal import SmallSignal
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, number

Equations = Callable[[Flow, Formula, Any], Mapping[str, Formula]]


@dataclass(frozen=True, slots=True, eq=False)
class Diagram:
    """Equations from signals to signals, in deviations from a working point at which all of them are at rest.

    From the equations follow the simulation in time with its derivatives, and for small signals the frequency response
    at the working point, with exact delays and exact derivatives too.
    """

    name: str
    """What it is, for messages."""
    input: str
    """Name of the signal that goes in."""
    outputs: tuple[str, ...]
    """Names of the signals that come out."""
    equations: Equations
    """Takes a ``Flow``, the signal that goes in, and parameters as attributes ``p.K_p``; gives the outputs by name."""
    of: tuple[Parameter, ...]
    """Its parameters."""
    further: tuple[str, ...] = ()
    """Names of inputs of the structure that the equations ask for besides the signal that goes in."""
    asked_as: Mapping[str, str] = field(default_factory=dict)
    """What the equations call parameters that have been renamed, by their name of today."""
    _small: dict[frozenset[str], SmallSignal] = field(default_factory=dict, repr=False)
    """Linear equations, by the parameters that are held at zero; made when first asked for."""

    @property
    def inputs(self) -> tuple[str, ...]:
        """Names of all signals that go in."""
        return (self.input, *self.further)

    def ports(self) -> "dict[str, Port]":
        """Return each output as a block that goes from the signal to it."""
        return {output: Port(self, output) for output in self.outputs}

    def port(self, output: str, source: str = "") -> "Port":
        """Return the block that goes from the signal, or from a further input, to one output.

        Raises
        ------
        StructureError
            If there is no output or further input of that name.
        """
        if source and source not in self.further:
            names = ", ".join(self.further) or "none"
            raise StructureError(f"diagram {self.name} has no further input {source}; it has {names}.")
        if output not in self.outputs:
            raise StructureError(f"diagram {self.name} has no output {output}; it has {', '.join(self.outputs)}.")
        return Port(self, output, source)

    def paths(self, output: str) -> "dict[str, Port]":
        """Return the blocks that go to one output, by the input that each comes from."""
        return {source: self.port(output, "" if source == self.input else source) for source in self.inputs}

    def renamed(self, names: Mapping[str, str]) -> "Diagram":
        """Return the diagram with other names for some parameters, which its equations ask for by ``p`` as before."""
        of = tuple(replace(p, name=names.get(p.name, p.name)) for p in self.of)
        asked_as = {names.get(p.name, p.name): self.asked_as.get(p.name, p.name) for p in self.of}
        return replace(self, of=of, asked_as=asked_as, _small={})

    def signals(self, flow: Flow, signal: Formula) -> Mapping[str, Formula]:
        """Return the outputs for a signal, adding the equations to a flow.

        Raises
        ------
        StructureError
            If the equations do not give the outputs.
        """
        parameters = SimpleNamespace(**{self.asked_as.get(p.name, p.name): flow.parameter(p.name) for p in self.of})
        signals = self.equations(flow, signal, parameters)
        if set(signals) != set(self.outputs):
            raise StructureError(
                f"diagram {self.name}: expected equations of {', '.join(self.outputs)}, found {', '.join(signals)}."
            )
        return signals

    def program(self, zeros: frozenset[str] = frozenset()) -> Program:
        """Return its equations alone.

        Parameters
        ----------
        zeros
            Names of parameters that are zero for good.
        """
        names = tuple(p.name for p in self.of)
        inputs = {name: Formula("input", name=name, place=i) for i, name in enumerate(self.inputs)}
        flow = Flow.of_parameters(names, zeros, inputs)
        signals = self.signals(flow, inputs[self.input])
        return completed(
            flow,
            name=self.name,
            inputs=self.inputs,
            parameters=names,
            outputs={output: (signals[output], number(0.0)) for output in self.outputs},
        )

    def small_signal(self, zeros: frozenset[str]) -> SmallSignal:
        """Return its linear equations about rest."""
        if zeros not in self._small:
            self._small[zeros] = SmallSignal(self.program(zeros))
        return self._small[zeros]


@dataclass(frozen=True, slots=True, eq=False)
class Port(Block):
    """One output of a diagram, seen from one of its inputs."""

    diagram: Diagram
    """The diagram."""
    output: str
    """Name of the output."""
    source: str = ""
    """Name of the further input; empty for the signal that goes in."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of the diagram."""
        return self.diagram.of

    @property
    def is_linear(self) -> bool:
        """Whether the diagram is: it is taken not to be."""
        return False

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the response to small signals."""
        response, _ = self._solved(s, values, ())
        return response

    def evaluate(self, walk: Walk) -> Dual:
        """Return the response to small signals and its derivatives."""
        names = [p.name for p in self.parameters]
        wanted = tuple(i for i, name in enumerate(names) if name in walk.wanted)
        response, slopes = self._solved(walk.s, [walk.values[name] for name in names], wanted)
        gradient: Gradient = {names[i]: slope for i, slope in zip(wanted, slopes, strict=True)}
        return response, gradient

    def flow(self, flow: Flow, signal: Formula) -> Formula:
        """Return the output in time; the equations are added once for all outputs of a diagram.

        They hold all inputs, so that seen from a further input nothing is left to add.
        """
        if self.source:
            return number(0.0)
        key = (id(self.diagram), id(signal))
        if key not in flow.diagrams:
            flow.kept += [self.diagram, signal]
            flow.diagrams[key] = self.diagram.signals(flow, signal)
        return flow.diagrams[key][self.output]

    def _solved(
        self, s: ComplexArray, values: "list[FloatArray] | tuple[FloatArray, ...]", wanted: tuple[int, ...]
    ) -> tuple[ComplexArray, list[ComplexArray]]:
        zeros = frozenset(
            p.name
            for i, (p, value) in enumerate(zip(self.parameters, values, strict=True))
            if i not in wanted and not np.any(value)
        )
        output, source = self.diagram.outputs.index(self.output), self.source or self.diagram.input
        return self.diagram.small_signal(zeros).response(
            s, values, wanted, output, source=self.diagram.inputs.index(source)
        )
