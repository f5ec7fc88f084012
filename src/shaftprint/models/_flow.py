"""The equations of a structure while they are collected: states, delays, loops.

A block is asked what it makes of a signal (``Block.flow``), and answers with a formula; on the way it may ask for
states and for the past of a signal. Loops are closed by a signal that is not known yet.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Self

from shaftprint.errors import StructureError
from shaftprint.models._calculus import depends, derivative, replaced
from shaftprint.models._quantity import Number, Quantity, number, quantity


@dataclass(frozen=True, slots=True, eq=False)
class Past:
    """A signal and the time by which it is asked for late."""

    signal: Quantity
    delay: Quantity
    leaf: Quantity


@dataclass(frozen=True, slots=True, eq=False)
class Sampled:
    """A value that a computer takes every period and holds; ``first`` holds before the start."""

    period: Quantity
    value: Quantity
    leaf: Quantity


@dataclass(slots=True)
class Flow:
    """Equations that blocks add to; a working object, not a result."""

    parameters: Mapping[str, Quantity]
    """Every parameter by name, tied ones as formulas and those held at zero as numbers."""
    inputs: Mapping[str, Quantity] = field(default_factory=dict)
    """Every input by name, for equations of several."""
    states: list[Quantity] = field(default_factory=list)
    """Leaves of the states."""
    rates: dict[int, Quantity] = field(default_factory=dict)
    """Rate of each state by its place."""
    running: set[int] = field(default_factory=set)
    """Places of states that go on for ever in steady running, such as an angle."""
    pasts: list[Past] = field(default_factory=list)
    """Signals that are asked for late."""
    samples: list[Sampled] = field(default_factory=list)
    """Values that a computer holds."""
    unknowns: dict[int, Quantity] = field(default_factory=dict)
    """What each unknown signal turned out to be."""
    known: dict[tuple[int, int], Quantity] = field(default_factory=dict)
    """What an expression makes of a signal, once asked."""
    kept: list[object] = field(default_factory=list)
    """Expressions and signals behind ``known``, so that their identities stay theirs."""
    diagrams: dict[tuple[int, int], Mapping[str, Quantity]] = field(default_factory=dict)
    """Outputs of a diagram for a signal, once asked."""
    opened: int = 0
    """How many unknown signals there have been."""

    @classmethod
    def of_parameters(
        cls, names: Iterable[str], zeros: Iterable[str] = (), inputs: Mapping[str, Quantity] | None = None
    ) -> Self:
        """Return a flow without equations, its parameters leaves or the number zero."""
        none = frozenset(zeros)
        leaves = {n: Quantity("parameter", name=n, place=i) for i, n in enumerate(names)}
        parameters = {n: number(0.0) if n in none else leaf for n, leaf in leaves.items()}
        return cls(parameters=parameters, inputs=inputs or {})

    def parameter(self, name: str) -> Quantity:
        """Return a parameter."""
        return self.parameters[name]

    def input(self, name: str) -> Quantity:
        """Return an input of the whole structure.

        Raises
        ------
        StructureError
            If it has no input of that name.
        """
        if name not in self.inputs:
            raise StructureError(f"expected an input {name}, found {', '.join(self.inputs) or 'none'}.")
        return self.inputs[name]

    def state(self, name: str) -> Quantity:
        """Return a new state; give it a rate with ``rate``."""
        leaf = Quantity("state", name=name, place=len(self.states))
        self.states.append(leaf)
        return leaf

    def rate(self, state: Quantity, value: Number) -> None:
        """Say how fast a state changes."""
        self.rates[state.place] = quantity(value)

    def running_sum(self, name: str, rate: Number) -> Quantity:
        """Return a new state that starts at zero and goes on for ever in steady running, such as an angle."""
        leaf = self.state(name)
        self.rate(leaf, rate)
        self.running.add(leaf.place)
        return leaf

    def delayed(self, signal: Quantity, delay: Number) -> Quantity:
        """Return what a signal was some time ago; exactly the signal where the delay is the number zero."""
        late = quantity(delay)
        if late.equals(0.0) or signal.is_number:
            return signal
        for past in self.pasts:
            if past.signal is signal and past.delay is late:
                return past.leaf
        leaf = Quantity("past", name="past", place=len(self.pasts))
        self.pasts.append(Past(signal, late, leaf))
        return leaf

    def mean(self, signal: Quantity, window: Number) -> Quantity:
        """Return the mean of a signal over the time window that ends now; the signal where the window is zero."""
        width = quantity(window)
        if width.equals(0.0):
            return signal
        area = self.running_sum("running sum", signal)
        return (area - self.delayed(area, width)) / width

    def sampled(self, value: Quantity | Callable[[Quantity], Quantity], period: Number) -> Quantity:
        """Return a value that is taken every period and held until the next.

        Parameters
        ----------
        value
            The value, or a function of the last one that was taken.
        period
            The period [s]; 0 for every step of the simulation.
        """
        leaf = Quantity("sample", name="sample", place=len(self.samples))
        # its place is taken before the value asks for further ones
        self.samples.append(Sampled(quantity(period), leaf, leaf))
        taken = value(leaf) if callable(value) else value
        self.samples[leaf.place] = Sampled(quantity(period), taken, leaf)
        return leaf

    @staticmethod
    def period(period: Number) -> Quantity:
        """Return the time between two values of a computer [s]; the step of the simulation where it is zero."""
        given = quantity(period)
        return Quantity("step", name="step") if given.equals(0.0) else given

    def change(self, signal: Quantity) -> Quantity:
        """Return how fast a signal changes."""
        return Quantity("rate", (signal,))

    def unknown(self) -> Quantity:
        """Return a signal that is to be known later; say what it is with ``close``."""
        self.opened += 1
        return Quantity("unknown", name="unknown", place=self.opened)

    def close(self, signal: Quantity, value: Quantity, where: str) -> Quantity:
        """Say what an unknown signal is, solving for it where it depends on itself at once.

        Raises
        ------
        StructureError
            If it depends on itself at once, and not linearly.
        """
        value = self._without_closed(value)
        if depends(value, signal):
            slope = derivative(value, signal)
            if depends(slope, signal):
                raise StructureError(
                    f"{where}: a loop without delay or state is not linear; put a lag or a delay into it."
                )
            (rest,) = replaced([value], lambda node: number(0.0) if node is signal else None)
            value = rest / (1.0 - slope)
        self.unknowns[signal.place] = value
        return signal

    def _without_closed(self, value: Quantity) -> Quantity:
        """Return a formula with what unknown signals turned out to be: a loop may run through one of them."""
        found = value
        while True:
            (opened,) = replaced([found], self._closed)
            if opened is found:
                return found
            found = opened

    def _closed(self, node: Quantity) -> Quantity | None:
        return self.unknowns.get(node.place) if node.operation == "unknown" else None
