"""Blocks of a structure that a drive file composes, and their parameters."""

from typing import Annotated, Literal, Self, TypeAlias

from pydantic import Field, model_validator

from shaftprint.settings import Name, Number, Settings

BlockKind: TypeAlias = Literal[
    "gain",
    "sum",
    "integrator",
    "first-order-lag",
    "second-order-lag",
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


class Block(Settings):
    """One block: from signals to a signal."""

    output: Name
    """Signal that comes out; each comes out of one block."""
    kind: BlockKind
    """What it does."""
    inputs: Annotated[tuple[Name, ...], Field(min_length=1)]
    """Signals that go in, added; one that begins with a minus is taken away, as in ``["u", "-friction"]``."""
    parameters: dict[str, Annotated[str | float, Field(union_mode="left_to_right")]] = Field(default_factory=dict)
    """Parameter of the block by its place in the equation: the name of a parameter of the file, or a number."""

    @model_validator(mode="after")
    def _no_signal_goes_in_twice(self) -> Self:
        names = [name.removeprefix("-") for name in self.inputs]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"expected each signal to go in once, found {', '.join(twice)} twice.")
        return self
