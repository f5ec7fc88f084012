"""A number with its unit and uncertainty, as a fingerprint keeps it."""

import math
from typing import Annotated, Final, TypeAlias

from pydantic import AfterValidator, BeforeValidator, PlainSerializer

from shaftprint.catalogue._roles import ROLES
from shaftprint.distributions import NORMAL_95
from shaftprint.models._role import Role
from shaftprint.records import Record

# An end of the interval further than this share of its width from the end that a standard deviation gives: only the
# interval is shown.
ENDS_ALIKE: Final = 0.25


def _not_negative(std: float) -> float:
    if std < 0.0:
        raise ValueError(f"expected a standard deviation that is not negative, found {std:g}")
    return std


Deviation: TypeAlias = Annotated[float, AfterValidator(_not_negative)]
"""A standard deviation; it may be infinite."""


def _role_of(name: object) -> object:
    """Return the role of a name that stands in a file."""
    if not isinstance(name, str):
        return name
    if name not in ROLES:
        raise ValueError(f"expected one of {', '.join(ROLES)}, found {name!r}")
    return ROLES[name]


def _name_of(role: Role | None) -> str | None:
    """Return the name of a role for a file; none for a role that only an own structure knows."""
    return role.name if role is not None and role.name in ROLES else None


NamedRole: TypeAlias = Annotated[
    Role | None,
    BeforeValidator(_role_of),
    PlainSerializer(_name_of, return_type=str | None),
]
"""A role, in files by its name."""


class Quantity(Record):
    """A number with its unit and uncertainty."""

    name: str
    """Field term or formula, such as ``K_p`` or ``t_d + t_sp``."""
    unit: str
    """Unit, ``-`` where there is none."""
    value: float
    """Estimate."""
    std: Deviation
    """Standard deviation to first order; infinite where the test says nothing about it."""
    interval_95: tuple[float, float] | None = None
    """95 % interval from the profile likelihood; None where there is none."""
    interval_open: tuple[bool, bool] = (False, False)
    """Whether an end of the interval is only a bound of the search: the data set none."""
    at_bound: bool = False
    """Whether the search stopped at a bound."""
    expected: float | None = None
    """Value from another source, such as the torsional vibration calculation."""
    expected_std: Deviation | None = None
    """Standard deviation of that value."""
    meaning: str = ""
    """What it stands for."""
    role: NamedRole = None
    """What it is in the line, one of ``catalogue.ROLES``; None where it has none, as in files of earlier versions."""

    @property
    def stated_std(self) -> float | None:
        """The standard deviation where it tells what the interval tells; None where only the interval should be shown.

        To first order a standard deviation at a bound, or where the likelihood is far from a parabola, is several times
        too large or too small, and says nothing about the side on which most of the interval lies.
        """
        if self.at_bound:
            return None
        if self.interval_95 is None or not math.isfinite(self.std) or any(self.interval_open):
            return self.std
        lower, upper = self.interval_95
        tolerance = ENDS_ALIKE * (upper - lower)
        alike = (
            abs(self.value - NORMAL_95 * self.std - lower) <= tolerance
            and abs(self.value + NORMAL_95 * self.std - upper) <= tolerance
        )
        return self.std if alike else None

    @property
    def limits_95(self) -> tuple[float, float]:
        """95 % interval: of the profile likelihood where there is one, else to first order; nan for an open end."""
        half = NORMAL_95 * self.std
        ends = self.interval_95 or (self.value - half, self.value + half)
        lower, upper = (math.nan if is_open else end for end, is_open in zip(ends, self.interval_open, strict=True))
        return lower, upper
