"""A parameter of a structure: its name, unit, bounds, meaning and role."""

from dataclasses import dataclass, replace

from shaftprint.digits import after_number
from shaftprint.errors import StructureError
from shaftprint.models._role import Role


@dataclass(frozen=True, slots=True)
class Parameter:
    """One number of a model, free within its bounds or held at its value."""

    name: str
    """Symbol, the same in code, files, tables and documentation, such as ``K_p``."""
    unit: str
    """Unit, ``-`` where there is none."""
    lower: float
    """Lower bound of the search."""
    upper: float
    """Upper bound of the search."""
    value: float
    """Value where it is held, and the centre of a sensitivity analysis."""
    meaning: str
    """What it stands for, in a few words."""
    held: bool = False
    """Whether it keeps its value during a fit."""
    role: Role | None = None
    """What it stands for in its line, such as ``catalogue.ShipRole.INERTIA_DOWNSTREAM``; None for any other number."""

    def __post_init__(self) -> None:
        """Check the bounds.

        Raises StructureError if the bounds are not in order or the value lies outside them, or a text stands where a
        number belongs.
        """
        texts, numbers = (self.unit, self.meaning), (self.lower, self.upper, self.value)
        if not all(isinstance(text, str) for text in texts) or any(isinstance(number, str) for number in numbers):
            raise StructureError(
                f"parameter {self.name}: expected name, unit, lower bound, upper bound, value and meaning in this "
                f"order, found {self.unit!r}, {', '.join(map(repr, numbers))}, {self.meaning!r} after the name."
            )
        if self.role is not None and not isinstance(self.role, Role):
            raise StructureError(
                f"parameter {self.name}: expected a role such as ShipRole.LOOP_DELAY, found {self.role!r}."
            )
        if self.role is not None and self.role.unit not in ("", self.unit):
            raise StructureError(
                f"parameter {self.name}: expected the unit {self.role.unit} of the role {self.role.name}, found "
                f"{self.unit}; normalise it, or give it no role."
            )
        if not self.lower < self.upper:
            raise StructureError(
                f"parameter {self.name}: expected lower bound < upper bound, found {self.lower} and {self.upper}."
            )
        if not self.lower <= self.value <= self.upper:
            raise StructureError(
                f"parameter {self.name}: expected a value from {self.lower} to {self.upper}"
                f"{after_number(self.unit)}, found {self.value}; change the value or the bounds."
            )

    def held_at(self, value: float) -> "Parameter":
        """Return the parameter held at a value within its bounds.

        Raises
        ------
        StructureError
            If the value lies outside them.
        """
        return replace(self, value=value, held=True)

    def free_between(self, lower: float, upper: float) -> "Parameter":
        """Return the parameter free between two bounds, its value moved inside them."""
        return replace(self, lower=lower, upper=upper, value=min(max(self.value, lower), upper), held=False)
