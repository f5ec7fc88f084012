"""Fingerprints of other versions: of earlier ones, which have less, and of later ones, which have more.

What an earlier schema lacks stays empty, and the numbers of a shipped structure get their roles from it. Schema 2.N
adds fields to 2.0 and changes none, so what is known here is read of every one of them.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from shaftprint.catalogue._roles import ROLES, ShipRole
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.errors import FingerprintError, StructureError
from shaftprint.fingerprint._conditions import WATER
from shaftprint.fingerprint._fingerprint import SCHEMA_VERSION, Fingerprint
from shaftprint.fingerprint._physical import GAUGE_ZERO
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.models._role import Role
from shaftprint.notebook._summary import shortened

PHYSICAL: Mapping[str, Role] = {
    **{role.physical.name: role for role in ROLES.values() if role.physical is not None},
    GAUGE_ZERO: ShipRole.LOAD_SLOPE,
    "K_Q": ShipRole.TORQUE,
}


NEW_IN: Mapping[int, tuple[str, ...]] = {
    1: ("with_limits", "validation"),
    2: ("joint", "conditions.ship", *(f"conditions.{name}" for name in WATER)),
}
"""Fields that came with each schema 2.N, dots between their steps."""

# what pydantic calls a field that a model, and one that a dataclass, does not know
_UNKNOWN = ("extra_forbidden", "unexpected_keyword_argument")


def of_earlier_schema(text: str) -> Fingerprint:
    """Return the fingerprint of a file of an earlier schema: 1 has neither legs nor noise, 2.0 no limits.

    Raises ValidationError if a field is wrong.
    """
    content = json.loads(text)
    earlier = Fingerprint.model_validate_json(json.dumps(content | {"schema_version": SCHEMA_VERSION}))
    schema = str(content["schema_version"])
    minor = int(schema.partition(".")[2] or 0)
    for name in (name for later, names in NEW_IN.items() if later > minor for name in names):
        if _is_there(content, name.split(".")):
            raise FingerprintError(f"{name}: expected no such field in schema {schema}.")
    return earlier


def _is_there(content: Any, steps: Sequence[str]) -> bool:
    for step in steps:
        if not isinstance(content, dict) or step not in content:
            return False
        content = content[step]
    return True


def of_later_schema(text: str) -> Fingerprint:
    """Return what is known here of a file of a later schema 2.N; a finding says what is not.

    Raises ValidationError if a field that is known here is wrong.
    """
    content = json.loads(text)
    later = content["schema_version"]
    content["schema_version"] = SCHEMA_VERSION
    try:
        return Fingerprint.model_validate_json(json.dumps(content))
    except ValidationError as error:
        unknown = [details["loc"] for details in error.errors() if details["type"] in _UNKNOWN]
        if not unknown:
            raise
    for place in unknown:
        _leave_out(content, place)
    fingerprint = Fingerprint.model_validate_json(json.dumps(content))
    names = shortened(".".join(str(step) for step in place) for place in unknown)
    finding = f"The file is of schema {later}; what is not known in {SCHEMA_VERSION} was left out: {names}."
    return fingerprint.model_copy(update={"findings": (*fingerprint.findings, finding)})


def _leave_out(content: Any, place: Sequence[int | str]) -> None:
    """Take a field out of the content of a file."""
    for step in place[:-1]:
        content = content[step]
    del content[place[-1]]


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
            "margins": tuple(replace(number, role=ShipRole.LOOP_GAIN) for number in fingerprint.margins),
        }
    )


def _named(numbers: tuple[Estimate, ...], roles: Mapping[str, Role | None]) -> tuple[Estimate, ...]:
    return tuple(replace(number, role=roles.get(number.name)) for number in numbers)
