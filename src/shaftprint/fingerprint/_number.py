"""Numbers as they stand in a fingerprint: an ``Estimate``, whose role is a name."""

import math
from dataclasses import replace
from typing import Annotated, Any, Final, TypeAlias

from pydantic import AfterValidator, BeforeValidator, PlainSerializer

from shaftprint.catalogue._roles import ROLES
from shaftprint.identify.fit._estimate import Estimate

_FIELDS: Final = (
    *("name", "unit", "value", "std", "interval_95", "interval_open", "at_bound", "expected", "expected_std"),
    *("meaning", "role"),
)
_OF_LIMIT: Final = ("limit", "name", "unit", "value", "std", "interval_95", "meaning", "doubt")


def _not_negative(std: float) -> float:
    if std < 0.0:
        raise ValueError(f"expected a standard deviation that is not negative, found {std:g}")
    return std


Deviation: TypeAlias = Annotated[float, AfterValidator(_not_negative)]
"""A standard deviation; it may be infinite."""


def _named_role(content: Any) -> Any:
    """Return a number of a file with the role of that name."""
    role = content.get("role") if isinstance(content, dict) else None
    if role is None:
        return content
    if not isinstance(role, str) or role not in ROLES:
        raise ValueError(f"role: expected one of {', '.join(ROLES)}, found {role!r}")
    return content | {"role": ROLES[role]}


def _possible(number: Estimate) -> Estimate:
    """Return a number whose deviations can be."""
    for name, std in (("std", number.std), ("expected_std", number.expected_std)):
        if std is not None and std < 0.0:
            raise ValueError(f"{name}: expected a standard deviation that is not negative, found {std:g}")
    return number


def _written(number: Estimate) -> dict[str, Any]:
    """Return what stands in a file: no name of a role that only an own structure knows."""
    role = number.role
    named = role.name if role is not None and role.name in ROLES else None
    return {name: getattr(number, name) for name in _FIELDS} | {"role": named}


Number: TypeAlias = Annotated[
    Estimate, BeforeValidator(_named_role), AfterValidator(_possible), PlainSerializer(_written)
]
"""A number in a file."""


def _of_limit(number: Estimate) -> Estimate:
    """Return a number of a limit of a file, where an end of its interval that the data did not set is infinite."""
    if not number.limit or number.interval_95 is None:
        raise ValueError("expected the limit that the number belongs to, and its interval_95")
    lower, upper = number.interval_95
    return replace(_possible(number), interval_open=(math.isinf(lower), math.isinf(upper)))


def _written_of_limit(number: Estimate) -> dict[str, Any]:
    return {name: getattr(number, name) for name in _OF_LIMIT}


NumberOfLimit: TypeAlias = Annotated[Estimate, AfterValidator(_of_limit), PlainSerializer(_written_of_limit)]
"""A number of a limit in the units of the ship, as ``limits`` states it."""
