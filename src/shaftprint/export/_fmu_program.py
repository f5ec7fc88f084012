"""The equations of an exported model, with every output in the present."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.models._program import Late, Program, program_of
from shaftprint.models._structure import Structure
from shaftprint.models.equations._calculus import derivatives, postorder
from shaftprint.models.equations._evaluate import evaluate
from shaftprint.models.equations._formula import Formula, maximum

_COMPARED = ("minimum", "maximum", "choose")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FmuProgram:
    """Equations whose outputs need no future, and what steady running and events follow from."""

    program: Program
    """The equations; what shifts an output late is one of its pasts."""
    gone: frozenset[str]
    """Parameters that are zero for good: lags and delays that are not there."""
    lateness: tuple[Formula, ...]
    """By how much each output is later than the one that was identified, which has a time stamp in its past [s]."""

    @property
    def still(self) -> tuple[int, ...]:
        """Places of the states that stand still in steady running."""
        return tuple(i for i, runs in enumerate(self.program.running) if not runs)

    @property
    def unknowns(self) -> list[Formula]:
        """States, pasts and samples that steady running is to be solved for."""
        program = self.program
        return [
            *(Formula("state", place=i) for i in self.still),
            *(Formula("past", place=i) for i in range(len(program.pasts))),
            *(Formula("sample", place=i) for i in range(len(program.samples))),
        ]

    @property
    def left_over(self) -> list[Formula]:
        """What must vanish in steady running, in the order of the unknowns."""
        program = self.program
        return [
            *(program.rates[i] for i in self.still),
            *(p.signal - p.delay * p.drift - Formula("past", place=i) for i, p in enumerate(program.pasts)),
            *(sample.value - Formula("sample", place=i) for i, sample in enumerate(program.samples)),
        ]

    @property
    def left_over_slopes(self) -> list[Formula]:
        """Their derivatives, row by row."""
        return _rows(self.left_over, self.unknowns)

    @property
    def state_slopes(self) -> list[Formula]:
        """Derivatives of how fast states change to the states, row by row."""
        states = [Formula("state", place=i) for i in range(len(self.program.states))]
        return _rows(self.program.rates, states)

    @property
    def feeds(self) -> tuple[bool, ...]:
        """Whether each past is part of the equations; of the others only an output is made."""
        program = self.program
        inner = [
            *program.rates,
            *(sample.value for sample in program.samples),
            *(late.signal for late in program.pasts),
            *(late.delay for late in program.pasts),
        ]
        pasts = {node.place for node in postorder(inner) if node.operation == "past"}
        return tuple(index in pasts for index in range(len(program.pasts)))

    @property
    def indicators(self) -> list[Formula]:
        """Differences that change sign where a limit begins or ends to act.

        Not among them is what a computer without a period compares with: that goes with the length of the step, so that
        a solver that ends its step there meets it again in every step.
        """
        program = self.program
        formulas = [*program.rates, *(late.signal for late in program.pasts), *(s.value for s in program.samples)]
        indicators = []
        for node in postorder(formulas):
            if node.operation in _COMPARED and not all(part.is_number for part in node.of[:2]):
                indicators.append(node.of[0] - node.of[1])
            elif node.operation == "absolute":
                indicators.append(node.of[0])
            elif node.operation == "table":
                indicators += [node.of[0] - corner for corner, _ in node.points]
        return [one for one in indicators if all(leaf.operation != "step" for leaf in postorder([one]))]

    @property
    def asks_input_rates(self) -> bool:
        """Whether the equations need how fast an input changes, which a solver outside does not tell."""
        program = self.program
        formulas = [*program.rates, *(late.signal for late in program.pasts), *program.signals]
        return any(node.operation == "input rate" for node in postorder(formulas))

    def reached(self, formula: Formula) -> tuple[list[int], list[int]]:
        """Return the places of the inputs and of the states on which a formula depends at once."""
        nodes = list(postorder([formula]))
        inputs = sorted({node.place for node in nodes if node.operation == "input"})
        return inputs, sorted({node.place for node in nodes if node.operation == "state"})


def fmu_program(structure: Structure, values: FloatArray) -> FmuProgram:
    """Return the equations of a structure for export.

    ``values``: parameter values, shape (parameters,); those that are held at zero are taken out of the equations.
    Raises StructureError if a block has no equations in time.
    """
    pairs = zip(structure.parameters, values, strict=True)
    gone = frozenset(p.name for p, value in pairs if p.held and value == 0.0)
    program = program_of(structure, gone)
    pasts, signals, lateness = list(program.pasts), [], []
    for signal, shift in zip(program.signals, program.shifts, strict=True):
        lateness.append(maximum(-shift, 0.0) if not shift.equals(0.0) else shift)
        if shift.equals(0.0):
            signals.append(signal)
            continue
        signals.append(Formula("past", name="past", place=len(pasts)))
        pasts.append(Late(signal=signal, drift=_drift(program, signal), delay=maximum(shift, 0.0)))
    ready = replace(program, pasts=tuple(pasts), signals=tuple(signals))
    return FmuProgram(program=ready, gone=gone, lateness=tuple(lateness))


def _drift(program: Program, signal: Formula) -> Formula:
    """Return how fast a signal changes in steady running, where only sums that go on for ever do."""
    moving = [(Formula("state", place=i), program.rates[i]) for i, runs in enumerate(program.running) if runs]
    moving += [(Formula("past", place=i), late.drift) for i, late in enumerate(program.pasts)]
    drift = Formula("number", value=0.0)
    for leaf, rate in moving:
        drift = drift + derivatives([signal], leaf)[0] * rate
    return drift


def _rows(formulas: Sequence[Formula], leaves: Sequence[Formula]) -> list[Formula]:
    columns = [derivatives(formulas, leaf) for leaf in leaves]
    return [column[row] for row in range(len(formulas)) for column in columns]


def largest_pole(ready: FmuProgram, values: FloatArray) -> float:
    """Return the size of the fastest pole about the working point [rad/s], while late signals stand still.

    ``values``: parameter values, shape (sets, parameters): the largest of all sets is returned.
    """
    program, sets = ready.program, values.shape[0]
    if not program.states:
        return 0.0
    leaves = {("parameter", i): values[:, i] for i in range(values.shape[1])} | {("step", 0): np.asarray(1.0)}
    counts = {"state": len(program.states), "past": len(program.pasts), "past rate": len(program.pasts)}
    counts |= {"sample": len(program.samples), "input": len(program.inputs), "input rate": len(program.inputs)}
    leaves |= {(kind, i): np.asarray(0.0) for kind, count in counts.items() for i in range(count)}
    size = len(program.states)
    entries = [np.broadcast_to(entry, (sets,)) for entry in evaluate(ready.state_slopes, leaves)]
    matrices = np.stack(entries, axis=-1).reshape(sets, size, size)
    if not np.all(np.isfinite(matrices)):
        return float("inf")
    return float(np.abs(np.linalg.eigvals(matrices)).max())
