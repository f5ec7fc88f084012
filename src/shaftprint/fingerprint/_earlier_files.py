"""Fingerprints of earlier versions, whose numbers have no roles: those of a shipped structure get them from it."""

from collections.abc import Mapping

from shaftprint.catalogue import ROLES, ShipRole, shipped_structure
from shaftprint.errors import StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.fingerprint._quantity import Quantity
from shaftprint.models import Role

PHYSICAL: Mapping[str, Role] = {
    **{role.physical.name: role for role in ROLES.values() if role.physical is not None},
    GAUGE_ZERO: ShipRole.LOAD_SLOPE,
    "K_Q": ShipRole.TORQUE,
}


def with_roles(fingerprint: Fingerprint) -> Fingerprint:
    """Return a fingerprint with the roles of its structure where none of its numbers has one.

    A structure that the package does not know leaves it as it is: what its parameters stand for is in nobody's file.
    """
    numbers = (*fingerprint.parameters, *fingerprint.combinations, *fingerprint.physical, *fingerprint.margins)
    if any(number.role is not None for number in numbers):
        return fingerprint
    try:
        structure = shipped_structure(fingerprint.structure)
    except StructureError:
        return fingerprint
    combinations = {combination.name: combination.role for combination in structure.combinations}
    roles: dict[str, Role | None] = {**structure.roles, **combinations, **PHYSICAL}
    return fingerprint.model_copy(
        update={
            "parameters": _named(fingerprint.parameters, roles),
            "combinations": _named(fingerprint.combinations, roles),
            "physical": _named(fingerprint.physical, roles),
            "margins": tuple(number.model_copy(update={"role": ShipRole.LOOP_GAIN}) for number in fingerprint.margins),
        }
    )


def _named(numbers: tuple[Quantity, ...], roles: Mapping[str, Role | None]) -> tuple[Quantity, ...]:
    return tuple(number.model_copy(update={"role": roles.get(number.name)}) for number in numbers)
