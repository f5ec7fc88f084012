"""What the tests of sister ships say about their class: the nouns."""

from dataclasses import dataclass

from shaftprint.drift._causes import Cause
from shaftprint.drift._finding import ShipChange


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipStanding:
    """A ship against the class that its sisters tell."""

    name: str
    """What it is called."""
    tests: int
    """How many tests stand for it."""
    is_odd: bool
    """Whether it is not as its sisters are, by more than chance."""
    change: ShipChange
    """In what it is other than they are, with all causes that may have made it; the deviation of a size holds how much
    sisters differ as built."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipSize:
    """Where a ship stands along one cause, as if it were this cause alone."""

    size: float
    """Difference from the class: a share, or a time [s]."""
    std: float
    """Standard deviation of it that its tests leave."""
    shrunk: float
    """The part of it that is most likely this cause within what sisters differ, drawn to the mean of the class."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CauseSpread:
    """How much sister ships differ along one cause."""

    cause: Cause
    """The cause."""
    std: float
    """Standard deviation between ships: a share, or a time [s]."""
    half_width: float
    """Half the interval that holds the size of 95 % of new sisters, tested as much as those of the class."""
    ships: tuple[ShipSize, ...]
    """Every ship, in the order of the class."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipNumber:
    """A number of one ship of a class."""

    value: float
    """Mean of its tests."""
    std: float
    """Standard deviation of its difference from the class that its tests leave."""
    shrunk: float
    """The same drawn to the mean of the class, as far as its tests are uncertain."""
    is_outside: bool
    """Whether it is outside of where 95 % of new sisters are found, its own uncertainty counted."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NumberSpread:
    """A number in a class of ships."""

    name: str
    """Its name, such as ``K_Q``."""
    unit: str
    """Its unit."""
    mean: float
    """Mean of the class."""
    std: float
    """Standard deviation between ships."""
    interval_95: tuple[float, float]
    """Holds the true number of 95 % of new sisters."""
    ships: tuple[ShipNumber, ...]
    """Every ship, in the order of the class."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ClassFinding:
    """What the tests of a class of ships say."""

    ships: tuple[ShipStanding, ...]
    """Every ship; empty where nothing could be judged."""
    causes: tuple[CauseSpread, ...]
    """How they differ along each cause."""
    numbers: tuple[NumberSpread, ...]
    """How they differ in each number."""
    names: tuple[str, ...]
    """Numbers that were judged together."""
    left_out: dict[str, str]
    """Why others were not, by name."""
    not_judged: tuple[Cause, ...] = ()
    """Causes of numbers that were left out: they are not excluded."""
    because: str = ""
    """Why nothing could be judged; empty where something was."""

    @property
    def odd(self) -> tuple[ShipStanding, ...]:
        """Ships that are not as their sisters are, the clearest first."""
        return tuple(sorted((ship for ship in self.ships if ship.is_odd), key=lambda ship: ship.change.p_value))
