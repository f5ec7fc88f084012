"""States at the start of a record that are parameters: what turned, or was wound up, when a record was cut.

A state ``x`` that begins at ``x_0`` is ``z + x_0`` with a ``z`` that begins at zero, in the same equations: the slope
of every output to ``x_0`` follows as to any parameter, and steady running and small signals are what they were.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

from shaftprint.drive._drive import Drive
from shaftprint.errors import SettingsError
from shaftprint.models._diagram import Diagram, Port
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number
from shaftprint.simulation._equilibrium import each_once
from shaftprint.spelling import meant


def begun(drive: Drive, structure: Structure) -> Structure:
    """Return a structure whose states begin at the parameters that the rows of ``[[start]]`` name.

    Raises SettingsError if a row names a state that the equations do not have, or the structure is no single diagram.
    """
    names = {row.name: row.value for row in drive.start if isinstance(row.value, str)}
    if not names:
        return structure
    diagrams = {id(port.diagram): port.diagram for port in structure.paths if isinstance(port, Port)}
    if len(diagrams) != 1 or not all(isinstance(port, Port) for port in structure.paths):
        raise SettingsError(
            f"drive {drive.name}, start: expected numbers for the states of {structure.name}, found "
            f"{next(iter(names.values()))!r}; parameters go for [[blocks]] and for the shipped structures of drives."
        )
    (diagram,) = diagrams.values()
    inside = {p.name for p in diagram.of}
    further = [p for p in parameters_of(drive) if p.name not in inside]
    shifted = replace(diagram, equations=_equations(drive, diagram, names), of=(*diagram.of, *further), _small={})
    # refuses names of states that there are not
    shifted.program()
    outputs = {output: shifted.paths(output) for output in structure.outputs}
    return replace(structure, outputs=outputs, parameters=(*structure.parameters, *further))


def parameters_of(drive: Drive) -> tuple[Parameter, ...]:
    """Return the rows of ``[[parameters]]`` as parameters."""
    return tuple(
        Parameter(one.name, one.unit, one.lower, one.upper, one.value, one.meaning) for one in drive.parameters
    )


def _equations(drive: Drive, diagram: Diagram, start: Mapping[str, str]) -> Any:
    def equations(flow: Flow, signal: Formula, p: Any) -> Mapping[str, Formula]:
        # once to hear what the states are called, which is known when they are all there
        trial = Flow(parameters=flow.parameters, inputs=flow.inputs)
        diagram.equations(trial, signal, p)
        names = each_once([state.name for state in trial.states])
        _expect_states(drive, start, [name for place, name in enumerate(names) if place not in trial.running])
        first = len(flow.states)
        begins = {first + place: getattr(p, start[name]) for place, name in enumerate(names) if name in start}
        moved = _Moved.beside(flow, begins)
        signals = diagram.equations(moved, signal, p)
        flow.opened = moved.opened
        for place in begins:
            flow.states[place] = replace(flow.states[place], name=trial.states[place - first].name)
        return signals

    return equations


def _expect_states(drive: Drive, start: Mapping[str, str], names: Sequence[str]) -> None:
    for name in start:
        if name not in names:
            raise SettingsError(
                f"drive {drive.name}, start: expected a state of the equations, one of {', '.join(names) or 'none'}, "
                f"found {name}.{meant(name, names)}"
            )


@dataclass(slots=True)
class _Moved(Flow):
    """A flow in which states of some places have another formula added, wherever they are asked for."""

    begins: Mapping[int, Formula] = field(default_factory=dict)
    leaves: dict[int, tuple[Formula, Formula]] = field(default_factory=dict)
    """A state's leaf, and the sum that stands for it, by the identity of the sum."""

    @classmethod
    def beside(cls, flow: Flow, begins: Mapping[int, Formula]) -> "_Moved":
        """Return a flow that adds to the equations of another."""
        return cls(**{one.name: getattr(flow, one.name) for one in fields(Flow)}, begins=begins)

    def state(self, name: str) -> Formula:
        """Return a new state, or the sum that stands for it."""
        leaf = Flow.state(self, name)
        if leaf.place not in self.begins:
            return leaf
        total = leaf + self.begins[leaf.place]
        self.leaves[id(total)] = (leaf, total)
        return total

    def rate(self, state: Formula, value: Number) -> None:
        """Say how fast a state changes."""
        leaf, _ = self.leaves.get(id(state), (state, state))
        Flow.rate(self, leaf, value)
