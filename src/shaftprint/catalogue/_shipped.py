"""Every structure that comes with the package by its name: those of the catalogue, and those with limits.

The gauge-aware closed loop with limits is named by these: ``GAUGE-QUADRATIC``, ``GAUGE-TORQUE-RATE``.
"""

from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._thesis import STRUCTURES, structure
from shaftprint.models import Structure

_PREFIX, _NONE = "GAUGE-", "QUADRATIC"
_LIMITS = ("TORQUE", "RATE", "DEADBAND", "SMOKE")


def shipped_structure(name: str) -> Structure:
    """Return a structure of the package by its name, in capitals or not; the name is never a path.

    Raises
    ------
    StructureError
        If there is none of that name, or its limits do not go together.
    """
    return _limited_structure(name) or structure(name)


def _limited_structure(name: str) -> Structure | None:
    """Return the structure with the limits that stand in a name; None if it names none."""
    upper = name.upper()
    if upper in STRUCTURES or not upper.startswith(_PREFIX):
        return None
    limits = upper.removeprefix(_PREFIX).split("-")
    if limits == [_NONE]:
        return limited()
    return limited(*(limit.lower() for limit in limits)) if set(limits) <= set(_LIMITS) else None
