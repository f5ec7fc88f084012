"""The unit of a channel, which may be spelled in many ways in a vessel file."""

from typing import Any

from pydantic import BeforeValidator

from shaftprint.units import plain_unit


def as_plain_unit(unit: Any) -> Any:
    """Return a unit as vessel files write it; what is no text as it is, to be refused with its field."""
    return plain_unit(unit) if isinstance(unit, str) else unit


PLAIN_UNIT = BeforeValidator(as_plain_unit)
"""Reads a unit in any of its spellings."""
