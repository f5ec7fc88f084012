"""The noun ``Wish``: how well which numbers are to be known."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import DesignError
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.spelling import meant

# Below this share of the value a smaller deviation is of no more use to anyone.
FLOOR = 0.0025


class _Stated(Protocol):
    """A number with its standard deviation: of a fit, of a prediction, or of a fingerprint."""

    @property
    def name(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def std(self) -> float: ...


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Wish(Shown):
    """Standard deviations that a test is to reach; without any, all numbers of the line as well as they can be."""

    relative: Mapping[str, float] = field(default_factory=dict)
    """Standard deviation over the value, by name of a parameter or combination of the structure, such as 0.03."""
    absolute: Mapping[str, float] = field(default_factory=dict)
    """Standard deviation in the unit of the number, by name: for numbers that may be zero."""
    floor: float = FLOOR
    """Standard deviation over the value (in the number's unit where that is zero) below which nothing is gained, for
    plans without wishes."""

    def __post_init__(self) -> None:
        """Check that the wishes can be meant.

        Raises DesignError if a standard deviation is not positive, or a number is wished for twice.
        """
        stated = [*self.relative.items(), *self.absolute.items(), ("floor", self.floor)]
        wrong = [f"{name} = {std:g}" for name, std in stated if not std > 0.0]
        twice = [name for name in self.relative if name in self.absolute]
        if wrong or twice:
            raise DesignError(
                f"wish: expected positive standard deviations, each number once, found "
                f"{', '.join([*wrong, *(f'{name} twice' for name in twice)])}."
            )

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the numbers that something is wished of."""
        return (*self.relative, *self.absolute)

    def targets(self, values: Mapping[str, float]) -> dict[str, float]:
        """Return the wished standard deviations in the numbers' units, by name.

        Parameters
        ----------
        values
            Value of every parameter and combination that the test can be asked for, by name.

        Raises
        ------
        DesignError
            If a name is not among them, or a relative wish is for a number that is zero.
        """
        unknown = [name for name in self.names if name not in values]
        if unknown:
            raise DesignError(
                f"wish {unknown[0]}: expected one of {', '.join(values)}.{meant(unknown[0], list(values))}"
            )
        zero = [name for name in self.relative if values[name] == 0.0]
        if zero:
            raise DesignError(f"wish {zero[0]}: its value is 0, so state the deviation in its own unit (absolute).")
        return {name: share * abs(values[name]) for name, share in self.relative.items()} | dict(self.absolute)


def no_worse_than(numbers: Sequence[_Stated], *, but: Sequence[str] = ()) -> Wish:
    """Return the wish to know numbers as well as a test has, or would have, made them known.

    Parameters
    ----------
    numbers
        Parameters and combinations with their standard deviations, as an ``Accuracy``, a fit or a fingerprint has them;
        those of which nothing is known are passed over.
    but
        Names of those of which nothing is wished.
    """
    known = {number.name: number.std for number in numbers if 0.0 < number.std < float("inf")}
    return Wish(absolute={name: std for name, std in known.items() if name not in but})


def numbers_of_line(structure: Structure) -> tuple[str, ...]:
    """Return the free parameters that a plan without wishes is made for: those of the line, not those of its sensors.

    The latency of the set point is one of the way to the ship: a test that knew it alone would be worth nothing.
    """
    return tuple(
        p.name
        for p in structure.free
        if p.role is None or not (p.role.of_sensor or p.role == ShipRole.SET_POINT_LATENCY)
    )
