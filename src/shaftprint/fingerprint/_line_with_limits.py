"""The line with its limits as a fingerprint keeps it: the whole model for large moves, with one covariance.

It stands beside the numbers of the linear fit and repeats their values, so that it can be used without them: a joint
fit gives all of them other values.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Final, Literal, Self, TypeAlias

from pydantic import Field, FiniteFloat, model_validator

from shaftprint.arrays import FloatArray, block_of
from shaftprint.catalogue._limited import limited
from shaftprint.errors import StructureError
from shaftprint.fingerprint._covariance_check import covariance_fault
from shaftprint.fingerprint._number import Number, NumberOfLimit
from shaftprint.records import Record

# More corners than any full-load curve has; the equations of the model grow with them.
MOST_CORNERS: Final = 200
LimitName = Literal["torque", "rate", "deadband", "ramp", "smoke"]

FoundBy: TypeAlias = Literal["limits", "joint fit"]
"""Which fit gave a line with its limits."""


class LineWithLimits(Record):
    """Governor, limits, engine, shaft and a propeller that takes the square of the speed, with their values."""

    found_by: FoundBy
    """``limits``: the linear fit to small signals, and limits found on the governor beside it; ``joint fit``: all in
    one likelihood."""
    limits: tuple[LimitName, ...]
    """Limits that the structure has, by the names of ``catalogue.limited``; empty where none acts."""
    curve: Annotated[tuple[tuple[FiniteFloat, FiniteFloat], ...], Field(max_length=MOST_CORNERS)] = ()
    """Shape of the full-load torque: deviation of the speed, and torque over that at the working-point speed."""
    numbers: tuple[NumberOfLimit, ...]
    """Levels, rates and widths in the units of the ship; those of a set point that is held or rounded, which the
    structure does not have, too."""
    not_seen: tuple[str, ...] = ()
    """Up to which level the test excludes each limit that does not act, in words."""
    parameters: tuple[Number, ...]
    """Parameters of the whole model that were identified, normalised."""
    held: dict[str, FiniteFloat]
    """The others."""
    covariance: tuple[tuple[float, ...], ...]
    """Covariance of the identified parameters, in their order."""

    def covariance_of(self, names: Sequence[str]) -> FloatArray:
        """Return the covariance of some of the identified parameters, shape (names, names)."""
        return block_of(self.covariance, [quantity.name for quantity in self.parameters], names)

    @model_validator(mode="after")
    def _expect_a_model(self) -> Self:
        fault = covariance_fault(self.covariance, [quantity.std for quantity in self.parameters])
        if fault:
            raise ValueError(f"covariance: {fault}")
        speeds = [speed for speed, _ in self.curve]
        if any(one >= next_one for one, next_one in pairwise(speeds)) or len(speeds) == 1:
            raise ValueError("curve: expected two or more corners whose speeds ascend, found others")
        try:
            names = limited(*self.limits).names
        except StructureError as error:
            raise ValueError(f"limits: {error}") from None
        stated = [*(quantity.name for quantity in self.parameters), *self.held]
        if sorted(stated) != sorted(names):
            apart = sorted({*stated} ^ {*names}) or stated
            raise ValueError(f"parameters: expected each of the model once, found a difference in {', '.join(apart)}")
        return self
