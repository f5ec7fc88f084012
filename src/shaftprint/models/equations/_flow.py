"""The equations of a structure while they are collected: states, delays, loops.

A block is asked what it makes of a signal (``Block.flow``), and answers with a formula; on the way it may ask for
states and for the past of a signal. Loops are closed by a signal that is not known yet.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Self

from shaftprint.errors import StructureError
from shaftprint.models.equations._calculus import depends, derivative, replaced
from shaftprint.models.equations._formula import Formula, Number, as_formula, number


@dataclass(frozen=True, slots=True, eq=False)
class Past:
    """A signal and the time by which it is asked for late."""

    signal: Formula
    delay: Formula
    leaf: Formula


@dataclass(frozen=True, slots=True, eq=False)
class Sampled:
    """A value that a computer takes every period and holds; ``first`` holds before the start."""

    period: Formula
    value: Formula
    leaf: Formula


@dataclass(slots=True)
class Flow:
    """Equations that blocks add to; a working object, not a result."""

    parameters: Mapping[str, Formula]
    """Every parameter by name, tied ones as formulas and those held at zero as numbers."""
    inputs: Mapping[str, Formula] = field(default_factory=dict)
    """Every input by name, for equations of several."""
    states: list[Formula] = field(default_factory=list)
    """Leaves of the states."""
    rates: dict[int, Formula] = field(default_factory=dict)
    """Rate of each state by its place."""
    running: set[int] = field(default_factory=set)
    """Places of states that go on for ever in steady running, such as an angle."""
    pasts: list[Past] = field(default_factory=list)
    """Signals that are asked for late."""
    samples: list[Sampled] = field(default_factory=list)
    """Values that a computer holds."""
    times: list[Formula] = field(default_factory=list)
    """Times within which something follows what moves, which small signals about rest do not show."""
    unknowns: dict[int, Formula] = field(default_factory=dict)
    """What each unknown signal turned out to be."""
    known: dict[tuple[int, int], Formula] = field(default_factory=dict)
    """What an expression makes of a signal, once asked."""
    kept: list[object] = field(default_factory=list)
    """Expressions and signals behind ``known``, so that their identities stay theirs."""
    diagrams: dict[tuple[int, int], Mapping[str, Formula]] = field(default_factory=dict)
    """Outputs of a diagram for a signal, once asked."""
    opened: int = 0
    """How many unknown signals there have been."""

    @classmethod
    def of_parameters(
        cls, names: Iterable[str], zeros: Iterable[str] = (), inputs: Mapping[str, Formula] | None = None
    ) -> Self:
        """Return a flow without equations, its parameters leaves or the number zero."""
        none = frozenset(zeros)
        leaves = {n: Formula("parameter", name=n, place=i) for i, n in enumerate(names)}
        parameters = {n: number(0.0) if n in none else leaf for n, leaf in leaves.items()}
        return cls(parameters=parameters, inputs=inputs or {})

    def parameter(self, name: str) -> Formula:
        """Return a parameter.

        Raises StructureError if there is none of that name.
        """
        if name not in self.parameters:
            raise StructureError(
                f"expected a parameter {name}, found {', '.join(self.parameters) or 'none'}; one that equations ask "
                "for by its name, and not of what they are given, cannot be called otherwise."
            )
        return self.parameters[name]

    def input(self, name: str) -> Formula:
        """Return an input of the whole structure.

        Raises StructureError if it has no input of that name.
        """
        if name not in self.inputs:
            raise StructureError(f"expected an input {name}, found {', '.join(self.inputs) or 'none'}.")
        return self.inputs[name]

    def state(self, name: str) -> Formula:
        """Return a new state; give it a rate with ``rate``."""
        leaf = Formula("state", name=name, place=len(self.states))
        self.states.append(leaf)
        return leaf

    def rate(self, state: Formula, value: Number) -> None:
        """Say how fast a state changes."""
        self.rates[state.place] = as_formula(value)

    def follows_within(self, time: Number) -> None:
        """Say how fast something follows once there is motion: steps of a simulation are no longer than that [s]."""
        self.times.append(as_formula(time))

    def running_sum(self, name: str, rate: Number) -> Formula:
        """Return a new state that starts at zero and goes on for ever in steady running, such as an angle."""
        leaf = self.state(name)
        self.rate(leaf, rate)
        self.running.add(leaf.place)
        return leaf

    def delayed(self, signal: Formula, delay: Number) -> Formula:
        """Return what a signal was some time ago; exactly the signal where the delay is the number zero."""
        late = as_formula(delay)
        if late.equals(0.0) or signal.is_number:
            return signal
        for past in self.pasts:
            if past.signal is signal and past.delay is late:
                return past.leaf
        leaf = Formula("past", name="past", place=len(self.pasts))
        self.pasts.append(Past(signal, late, leaf))
        return leaf

    def mean(self, signal: Formula, window: Number) -> Formula:
        """Return the mean of a signal over the time window that ends now; the signal where the window is zero."""
        width = as_formula(window)
        if width.equals(0.0):
            return signal
        area = self.running_sum("running sum", signal)
        return (area - self.delayed(area, width)) / width

    def sampled(self, value: Formula | Callable[[Formula], Formula], period: Number) -> Formula:
        """Return a value that is taken every period and held until the next.

        ``value``: the value, or a function of the last one that was taken. ``period``: the period [s]; 0 for every step
        of the simulation.
        """
        leaf = Formula("sample", name="sample", place=len(self.samples))
        # its place is taken before the value asks for further ones
        self.samples.append(Sampled(as_formula(period), leaf, leaf))
        sample = value(leaf) if callable(value) else value
        self.samples[leaf.place] = Sampled(as_formula(period), sample, leaf)
        return leaf

    @staticmethod
    def period(period: Number) -> Formula:
        """Return the time between two values of a computer [s]; the step of the simulation where it is zero."""
        period_s = as_formula(period)
        return Formula("step", name="step") if period_s.equals(0.0) else period_s

    def change(self, signal: Formula) -> Formula:
        """Return how fast a signal changes."""
        return Formula("rate", (signal,))

    def unknown(self) -> Formula:
        """Return a signal that is to be known later; say what it is with ``close``."""
        self.opened += 1
        return Formula("unknown", name="unknown", place=self.opened)

    def close(self, signal: Formula, value: Formula, where: str) -> Formula:
        """Say what an unknown signal is, solving for it in an algebraic loop.

        Raises StructureError if the algebraic loop is not linear.
        """
        value = self._without_closed(value)
        if depends(value, signal):
            slope = derivative(value, signal)
            if depends(slope, signal):
                raise StructureError(
                    f"{where}: an algebraic loop (no delay, no state) is not linear; put a lag or a delay into it."
                )
            (constant,) = replaced([value], lambda node: number(0.0) if node is signal else None)
            value = constant / (1.0 - slope)
        self.unknowns[signal.place] = value
        return signal

    def _without_closed(self, value: Formula) -> Formula:
        """Return a formula with what unknown signals turned out to be: a loop may run through one of them."""
        formula = value
        while True:
            (opened,) = replaced([formula], self._closed)
            if opened is formula:
                return formula
            formula = opened

    def _closed(self, node: Formula) -> Formula | None:
        return self.unknowns.get(node.place) if node.operation == "unknown" else None
