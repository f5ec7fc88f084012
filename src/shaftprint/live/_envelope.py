"""What must not be passed while the program plays: limits of ship and engine, each with the time that it may last."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Bound:
    """Lowest and highest value of one quantity, and how long it may be beyond them."""

    quantity: str
    """What is bounded: ``engine speed``, ``shaft torque``, ``set point``, or the name of a channel."""
    unit: str
    """Its unit."""
    lowest: float
    """Lowest value [unit]; minus infinity without one."""
    highest: float
    """Highest value [unit]; infinity without one."""
    persistence_s: float
    """How long it may be beyond before the test is aborted [s]."""

    def holds(self, value: float) -> bool:
        """Return whether a value is within; what is not a number is not."""
        return self.lowest <= value <= self.highest


@dataclass(frozen=True, kw_only=True, slots=True)
class Envelope:
    """All bounds of a test on one shaft line."""

    bounds: tuple[Bound, ...]
    """Bounds of quantities that are measured, on every block."""
    barred_rpm: tuple[tuple[float, float], ...] = ()
    """Ranges of engine speed in which the line must not stay, with their margin [rpm]."""
    barred_passage_s: float = 5.0
    """How long passing one may take [s]."""
    highest_slew_v_per_s: float
    """Fastest change of the set point [V/s]."""
    longest_s: float
    """Longest time for which the program may rule the set point [s]."""

    def bound_of(self, quantity: str) -> Bound | None:
        """Return the bound of a quantity; None without one."""
        return next((bound for bound in self.bounds if bound.quantity == quantity), None)
