"""Blocks of a structure that a drive file composes, and their parameters."""

from collections.abc import Mapping
from itertools import pairwise
from types import MappingProxyType
from typing import Annotated, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from shaftprint.settings import Name, Number, Settings, names_twice

Coefficient: TypeAlias = Annotated[str | float, Field(union_mode="left_to_right")]
"""The name of a parameter of the file, or a number."""

BlockKind: TypeAlias = Literal[
    "constant",
    "gain",
    "sum",
    "product",
    "abs",
    "power",
    "table",
    "integrator",
    "inertia",
    "first-order-lag",
    "second-order-lag",
    "ratio",
    "pi",
    "delay",
    "deadband",
    "limit",
    "coulomb-friction",
    "stribeck-friction",
    "backlash",
]
"""What a block does with what goes in; ``docs/drives.md`` has their equations and parameters."""


class FreeParameter(Settings):
    """A parameter of composed blocks."""

    name: Name
    """Its name, by which blocks ask for it."""
    unit: Name
    """Its unit, ``-`` where there is none."""
    lower: Number
    """Lower bound of the search."""
    upper: Number
    """Upper bound of the search."""
    value: Number
    """Usual value, at which it stays where it is known and held."""
    meaning: Name
    """What it is, in a few words."""


# What a row holds besides its parameters, by kind: numbers that are fixed, and lists.
_SHAPES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"power": ("exponent",), "table": ("points",), "ratio": ("numerator", "denominator")}
)
# Highest exponent of a power.
_HIGHEST = 9.0


class Block(Settings):
    """One block: from signals to a signal."""

    output: Name
    """Signal that comes out; each comes out of one block."""
    kind: BlockKind
    """What it does."""
    inputs: tuple[Name, ...] = ()
    """Signals that go in, added, or multiplied by a ``product``; one that begins with a minus is taken away, as in
    ``["u", "-friction"]``."""
    parameters: dict[str, Coefficient] = Field(default_factory=dict)
    """Parameter of the block by its place in the equation: the name of a parameter of the file, or a number."""
    exponent: Annotated[Number, Field(ge=1.0, le=_HIGHEST)] | None = None
    """Of a ``power``: its exponent, from 1 to 9."""
    keeps_sign: Annotated[bool, Field(strict=True)] = False
    """Of a ``power``: whether what is negative stays so, as the torque of a propeller that turns back does."""
    points: tuple[tuple[Number, Number], ...] | None = None
    """Of a ``table``: corner points ``[in, out]``, ascending; straight between them, constant beyond the ends."""
    numerator: Annotated[tuple[Coefficient, ...], Field(min_length=1)] | None = None
    """Of a ``ratio``: coefficients in ``s``, that of the highest power first."""
    denominator: Annotated[tuple[Coefficient, ...], Field(min_length=1)] | None = None
    """Of a ``ratio``: the same below the line."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of parameters of the file that the block asks for."""
        values = (*self.parameters.values(), *(self.numerator or ()), *(self.denominator or ()))
        return tuple(value for value in values if isinstance(value, str))

    @model_validator(mode="after")
    def _inputs_of_its_kind(self) -> Self:
        names = [name.removeprefix("-") for name in self.inputs]
        twice = names_twice(names)
        if twice:
            raise ValueError(f"expected each signal to go in once, found {', '.join(twice)} twice.")
        if self.kind == "constant" and names:
            raise ValueError(f"expected no inputs of a constant, found {', '.join(names)}.")
        fewest, words = (2, "two inputs") if self.kind == "product" else (1, "one input")
        if self.kind != "constant" and len(names) < fewest:
            raise ValueError(f"expected {words} or more of {self.kind}, found {', '.join(names) or 'none'}.")
        return self

    @model_validator(mode="after")
    def _shape_of_its_kind(self) -> Self:
        asked = _SHAPES.get(self.kind, ())
        given = [key for keys in _SHAPES.values() for key in keys if getattr(self, key) is not None]
        foreign = [key for key in given if key not in asked] + ["keeps_sign"] * (
            self.keeps_sign and self.kind != "power"
        )
        if foreign:
            raise ValueError(f"expected no {foreign[0]} of {self.kind}; leave it out.")
        missing = [key for key in asked if key not in given]
        if missing:
            raise ValueError(f"expected {missing[0]} of {self.kind}, found none.")
        if self.exponent is not None and not (self.keeps_sign or self.exponent.is_integer()):
            raise ValueError(f"expected a whole exponent, or keeps_sign = true, found {self.exponent:g}.")
        if self.points is not None and (
            len(self.points) < 2 or any(after[0] <= before[0] for before, after in pairwise(self.points))
        ):
            raise ValueError("expected two points or more, each further than the one before.")
        if self.numerator is not None and len(self.numerator) > len(self.denominator or ()):
            raise ValueError("expected a numerator of no higher power than the denominator; put a lag behind it.")
        if self.denominator is not None and self.denominator[0] == 0.0:
            raise ValueError("expected a first coefficient of the denominator other than 0; leave it out.")
        return self
