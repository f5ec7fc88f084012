"""Equations in which nothing asks how fast a late signal changes."""

from dataclasses import replace

from shaftprint.errors import ExportError
from shaftprint.models._program import Computed, Late, Program
from shaftprint.models.equations._calculus import derivatives, postorder, replaced
from shaftprint.models.equations._formula import Formula


def without_past_rates(program: Program) -> Program:
    """Return the same equations, with how fast a late signal changes as a separate late signal.

    Of ``w = z(t - d)`` with a constant delay the change is ``w' = z'(t - d)``, and ``z'`` is a formula of states, of
    how fast they change and of other late signals.

    Raises ExportError if the change of an input is asked for, a second change, or that of a delay that varies.
    """
    maker = _Maker(program)
    rates = tuple(maker.replaced(rate) for rate in program.rates)
    signals = tuple(maker.replaced(signal) for signal in program.signals)
    samples = tuple(Computed(value=maker.replaced(s.value), period=s.period) for s in program.samples)
    return replace(program, rates=rates, signals=signals, samples=samples, pasts=maker.pasts())


class _Maker:
    """Adds late signals for those whose change is asked for."""

    def __init__(self, program: Program) -> None:
        self._program = program
        self._pasts = list(program.pasts)
        self._made: dict[int, Formula] = {}
        self._kept: list[Formula] = []

    def replaced(self, formula: Formula) -> Formula:
        """Return a formula with late signals in the place of how fast others change."""
        return replaced([formula], self._leaf)[0]

    def pasts(self) -> tuple[Late, ...]:
        """Return all late signals; looking at one may add another."""
        index = 0
        while index < len(self._pasts):
            late = self._pasts[index]
            self._pasts[index] = replace(late, signal=self.replaced(late.signal), delay=self.replaced(late.delay))
            index += 1
        return tuple(self._pasts)

    def _leaf(self, node: Formula) -> Formula | None:
        if node.operation == "input rate":
            raise ExportError(
                f"export of {self._program.name}: the equations need how fast the input {node.name} changes, which no "
                "program that takes the input alone can know; put a lag behind it."
            )
        return self._rate(node.place) if node.operation == "past rate" else None

    def _rate(self, index: int) -> Formula:
        if index not in self._made:
            late = self._pasts[index]
            if late.varies:
                raise ExportError(
                    f"export of {self._program.name}: the equations need how fast a signal changes behind a delay that "
                    "varies; hold the delay constant."
                )
            self._made[index] = Formula("past", name="past", place=len(self._pasts))
            self._pasts.append(Late(signal=self._change(late.signal), drift=Formula("number"), delay=late.delay))
        return self._made[index]

    def _change(self, formula: Formula) -> Formula:
        """Return how fast a formula changes."""
        leaves = {(node.operation, node.place): node for node in postorder([formula]) if not node.of}
        if any(kind == "past rate" for kind, _ in leaves):
            raise ExportError(
                f"export of {self._program.name}: the equations need the second change of a late signal; put a lag "
                "in series with it."
            )
        change = Formula("number")
        for (kind, index), leaf in leaves.items():
            if kind == "state":
                change = change + derivatives([formula], leaf)[0] * self._program.rates[index]
            elif kind in ("past", "input"):
                moved = Formula(f"{kind} rate", name=leaf.name, place=index)
                change = change + derivatives([formula], leaf)[0] * moved
        self._kept.append(change)
        return change
