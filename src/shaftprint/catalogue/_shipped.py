"""Every structure that comes with the package by its name: those of the catalogue, with limits, and of drives.

The gauge-aware closed loop with limits is named by these: ``GAUGE-QUADRATIC``, ``GAUGE-TORQUE-RATE``; with an electric
machine beside the engine, ``HYBRID-QUADRATIC``, ``HYBRID-TORQUE-CLUTCH``.
"""

from collections.abc import Callable, Container, Mapping
from functools import cache

from shaftprint.catalogue._bent_line import B_SET, with_bend
from shaftprint.catalogue._drives import DRIVES
from shaftprint.catalogue._hybrid_at_large import limited_hybrid
from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._thesis import STRUCTURES, structure
from shaftprint.choices import CRASH_STOP
from shaftprint.errors import StructureError
from shaftprint.models._role import Role
from shaftprint.models._structure import Structure

_NONE = "QUADRATIC"
_LIMITS = ("TORQUE", "RATE", "DEADBAND", "SMOKE")
_AT_LARGE: Mapping[str, tuple[Callable[..., Structure], tuple[str, ...]]] = {
    "GAUGE-": (limited, _LIMITS),
    "HYBRID-": (limited_hybrid, (*_LIMITS, "CLUTCH")),
}


def shipped_structure(name: str, parameters: Container[str] = ()) -> Structure:
    """Return a structure of the package by its name, in capitals or not; the name is never a path.

    Parameters
    ----------
    name
        The name.
    parameters
        Names of its parameters in a file, or of those of a structure beside it: with the bend of the set point's line
        among them it is that of several speeds.

    Raises
    ------
    StructureError
        If there is none of that name, or its limits do not go together.
    """
    if name.upper() == CRASH_STOP:
        raise StructureError(
            f"{CRASH_STOP} is the structure of one ship, which is simulated alone: shaftprint simulate --structure "
            f"{CRASH_STOP} --vessel SHIP."
        )
    drive = DRIVES.get(name.upper())
    found = drive() if drive is not None else _limited_structure(name) or structure(name)
    return with_bend(found) if B_SET.name in parameters else found


def _limited_structure(name: str) -> Structure | None:
    """Return the structure with the limits that stand in a name; None if it names none."""
    upper = name.upper()
    if upper in STRUCTURES:
        return None
    for prefix, (build, known) in _AT_LARGE.items():
        limits = upper.removeprefix(prefix).split("-") if upper.startswith(prefix) else []
        if limits == [_NONE]:
            return build()
        if limits and set(limits) <= set(known) and len(set(limits)) == len(limits):
            return build(*(limit.lower() for limit in limits))
    return None


def expect_roles(structure: Structure) -> None:
    """Check that every parameter with name and unit of one of the ship says by its role whether it is that.

    Raises StructureError if one has no role: nothing that the ship is known by would reach it.
    """
    for parameter in structure.parameters:
        role = _shipped_roles().get((parameter.name, parameter.unit))
        if role is not None and parameter.role is None:
            raise StructureError(
                f"structure {structure.name}: parameter {parameter.name} has name and unit of a ship's {role.name}, "
                "but no role, so that the vessel file would say nothing of it; give it one, such as "
                f"role=ShipRole.{_attribute(role)}, or another name."
            )


@cache
def _shipped_roles() -> dict[tuple[str, str], Role]:
    """Return the roles of the catalogue's parameters by name and unit."""
    return {
        (parameter.name, parameter.unit): parameter.role
        for build in STRUCTURES.values()
        for parameter in build().parameters
        if parameter.role is not None
    }


def _attribute(role: Role) -> str:
    return next(name for name, candidate in vars(ShipRole).items() if candidate is role)
