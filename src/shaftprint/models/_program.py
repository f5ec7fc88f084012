"""The equations of a structure, complete: what is simulated, linearised and exported."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from shaftprint.errors import StructureError
from shaftprint.models._expression_flow import split_common_shift, split_shift
from shaftprint.models._structure import Structure
from shaftprint.models.equations._calculus import postorder, replaced, swept
from shaftprint.models.equations._flow import Flow, Past
from shaftprint.models.equations._formula import Formula, as_formula, number


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Late:
    """A signal that the equations ask for as it was some time ago."""

    signal: Formula
    """The signal."""
    drift: Formula
    """How fast it changes in steady running: not at all, but for sums that go on for ever."""
    delay: Formula
    """The time; a formula of parameters, or of signals where it varies."""

    @property
    def varies(self) -> bool:
        """Whether the delay depends on signals."""
        return any(not node.of and node.operation not in ("number", "parameter") for node in postorder([self.delay]))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Computed:
    """A value that a computer takes every period and holds."""

    value: Formula
    """What it takes."""
    period: Formula
    """The period; a formula of parameters."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Program:
    """Equations ``dx/dt = f(x, u, past, parameters)`` and ``y = g(...)`` with exact delays.

    Leaves of the formulas are numbers, parameters, inputs and how fast they change, states, pasts and how fast they
    change, and samples; their ``place`` is their place in these lists.
    """

    name: str
    """Name of the structure."""
    inputs: tuple[str, ...]
    """Names of the inputs."""
    parameters: tuple[str, ...]
    """Names of the structure's parameters."""
    states: tuple[str, ...]
    """What each state is."""
    rates: tuple[Formula, ...]
    """How fast each state changes."""
    running: tuple[bool, ...]
    """Whether each state goes on for ever in steady running."""
    pasts: tuple[Late, ...]
    """Signals that are asked for late."""
    samples: tuple[Computed, ...]
    """Values that a computer holds."""
    outputs: tuple[str, ...]
    """Names of the outputs."""
    signals: tuple[Formula, ...]
    """The outputs, before their shift."""
    shifts: tuple[Formula, ...]
    """Time by which each output is late, a formula of parameters; negative where it is early."""
    times: tuple[Formula, ...]
    """Times within which something follows what moves [s], formulas of parameters."""


def program_of(structure: Structure, zeros: Iterable[str] = ()) -> Program:
    """Return the equations of a structure.

    ``zeros``: names of parameters that are zero for good: a lag without time constant or a delay of nothing has no
    equations. Raises StructureError if a block has no equations in time, or there is an algebraic loop that cannot be
    solved.
    """
    inputs = {name: Formula("input", name=name, place=i) for i, name in enumerate(structure.inputs)}
    flow = Flow(parameters=_leaves(structure, frozenset(zeros)), inputs=inputs)
    return completed(
        flow,
        name=structure.name,
        inputs=structure.inputs,
        parameters=structure.names,
        outputs={name: _output(flow, structure, name, inputs) for name in structure.outputs},
    )


def _leaves(structure: Structure, zeros: frozenset[str]) -> dict[str, Formula]:
    """Return every parameter as the blocks take it: a leaf, a formula where it is tied, with factor and offset."""
    leaves = {
        name: number(0.0) if name in zeros else Formula("parameter", name=name, place=i)
        for i, name in enumerate(structure.names)
    }
    # a tie is a formula of whatever it is given
    values = dict(leaves)
    for tie in structure.ties:
        formula: Callable[..., Any] = tie.of
        values[tie.name] = as_formula(formula(*(leaves[argument] for argument in tie.arguments)))
    return {
        name: value * structure.factors.get(name, 1.0) + structure.offsets.get(name, 0.0)
        for name, value in values.items()
    }


def _output(flow: Flow, structure: Structure, output: str, inputs: Mapping[str, Formula]) -> tuple[Formula, Formula]:
    """Return an output and its shift."""
    paths = {
        source: path for (name, source), path in zip(structure.channels, structure.paths, strict=True) if name == output
    }
    if len(paths) == 1:
        ((source, path),) = paths.items()
        return split_shift(flow, path, inputs[source])
    parts, shift = split_common_shift(flow, [(path, inputs[source]) for source, path in paths.items()])
    total = number(0.0)
    for part in parts:
        total = total + part
    return total, shift


def completed(
    flow: Flow,
    *,
    name: str,
    inputs: tuple[str, ...],
    parameters: tuple[str, ...],
    outputs: Mapping[str, tuple[Formula, Formula]],
) -> Program:
    """Return a program from collected equations.

    ``outputs``: signal and shift of each output by its name. Raises StructureError if a state has no rate, or there is
    an algebraic loop that cannot be solved.
    """
    resolver = _Resolver(flow, name)
    missing = [state.name for state in flow.states if state.place not in flow.rates]
    if missing:
        raise StructureError(f"structure {name}: no rate is given for the state {', '.join(missing)}.")
    return Program(
        name=name,
        inputs=inputs,
        parameters=parameters,
        states=tuple(state.name for state in flow.states),
        rates=tuple(resolver.rate(i) for i in range(len(flow.states))),
        running=tuple(i in flow.running for i in range(len(flow.states))),
        pasts=tuple(_late(resolver, past) for past in flow.pasts),
        samples=tuple(Computed(value=resolver(s.value), period=resolver(s.period)) for s in flow.samples),
        outputs=tuple(outputs),
        signals=tuple(resolver(signal) for signal, _ in outputs.values()),
        shifts=tuple(resolver(shift) for _, shift in outputs.values()),
        times=tuple(resolver(time) for time in flow.times),
    )


def _late(resolver: "_Resolver", past: Past) -> Late:
    signal = resolver(past.signal)
    return Late(
        signal=signal,
        drift=resolver.drift(signal),
        delay=resolver(past.delay),
    )


class _Resolver:
    """Puts what is known by now into formulas: what unknown signals are, and how fast signals change."""

    def __init__(self, flow: Flow, name: str) -> None:
        self._flow = flow
        self._name = name
        self._done: dict[tuple[str, int], Formula] = {}
        self._open: set[tuple[str, int]] = set()
        self._kept: list[Formula] = []
        self._rates: dict[int, Formula] = {}
        self._drifting: set[int] = set()

    def __call__(self, formula: Formula) -> Formula:
        """Return the formula without unknown signals and without rates of change."""
        return replaced([formula], self._leaf)[0]

    def rate(self, state: int) -> Formula:
        """Return how fast a state changes."""
        if state not in self._rates:
            rate = self._flow.rates[state]
            self._rates[state] = self._once(("state", state), lambda: self(rate))
        return self._rates[state]

    def change(self, formula: Formula) -> Formula:
        """Return how fast a formula changes that has been resolved.

        Raises StructureError if it contains how fast an input or a late signal changes: those have corners, or are
        known too roughly.
        """
        return swept([formula], self._slope_in_time)[0]

    def drift(self, formula: Formula) -> Formula:
        """Return how fast a formula changes while only sums that go on for ever do, and what is late of them."""
        return swept([formula], self._slope_in_steady_running)[0]

    def _slope_in_steady_running(self, leaf: Formula) -> Formula | None:
        if leaf.operation == "state" and leaf.place in self._flow.running:
            return self.rate(leaf.place)
        if leaf.operation == "past" and leaf.place not in self._drifting:
            # a signal that is late of itself goes round a loop, which stands still in steady running
            self._drifting.add(leaf.place)
            slope = self.drift(self(self._flow.pasts[leaf.place].signal))
            self._drifting.discard(leaf.place)
            return slope
        return None

    def _slope_in_time(self, leaf: Formula) -> Formula | None:
        if leaf.operation == "state":
            return self.rate(leaf.place)
        if leaf.operation == "input":
            return Formula("input rate", name=leaf.name, place=leaf.place)
        if leaf.operation == "past":
            return Formula("past rate", name=leaf.name, place=leaf.place)
        if leaf.operation in ("input rate", "past rate"):
            raise StructureError(
                f"structure {self._name}: the equations need the second change of "
                f"{'an input' if leaf.operation == 'input rate' else 'a late signal'}; put a lag in series with it, "
                "or leave a power of s out of the numerator."
            )
        return None

    def _leaf(self, node: Formula) -> Formula | None:
        if node.operation == "unknown":
            value = self._flow.unknowns[node.place]
            return self._once(("unknown", node.place), lambda: self(value))
        if node.operation == "rate":
            self._kept.append(node)
            return self._once(("change", id(node)), lambda: self.change(self(node.of[0])))
        return None

    def _once(self, key: tuple[str, int], make: Callable[[], Formula]) -> Formula:
        if key in self._done:
            return self._done[key]
        if key in self._open:
            raise StructureError(
                f"structure {self._name}: algebraic loop through the change of a signal; put a lag or a delay into it."
            )
        self._open.add(key)
        formula = make()
        self._open.discard(key)
        self._done[key] = formula
        return formula
