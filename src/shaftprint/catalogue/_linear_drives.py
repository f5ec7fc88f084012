"""Drives along a line: the same equations with ways, forces and masses in place of angles, torques and inertias."""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

LEVER_M = 0.01
"""Radius of a pinion or screw between the two [m], by which bounds and usual values of a line go."""

# Unit along a line of each unit that turns, and the power of the lever between them.
_ALONG: Mapping[str, tuple[str, int]] = MappingProxyType(
    {
        "rad": ("m", 1),
        "rad/s": ("m/s", 1),
        "N m": ("N", -1),
        "N m/A": ("N/A", -1),
        "kg m2": ("kg", -2),
        "N m/rad": ("N/m", -2),
        "N m s/rad": ("N s/m", -2),
    }
)
_WORDS = (("inertia", "mass"), ("torque", "force"), ("angle", "way"), ("one rad/s", "one m/s"), ("rotor", "slide"))


def unit_along(unit: str) -> str:
    """Return the unit along a line of one that turns; any other stays."""
    return _ALONG.get(unit, (unit, 0))[0]


def along_a_line(structure: Structure) -> Structure:
    """Return a structure of a drive that turns with the units of one that goes straight."""
    return replace(structure, parameters=tuple(_along(parameter) for parameter in structure.parameters))


def _along(parameter: Parameter) -> Parameter:
    unit, power = _ALONG.get(parameter.unit, (parameter.unit, 0))
    factor, meaning = LEVER_M**power, parameter.meaning
    for turning, straight in _WORDS:
        meaning = meaning.replace(turning, straight)
    return replace(
        parameter,
        unit=unit,
        lower=factor * parameter.lower,
        upper=factor * parameter.upper,
        value=factor * parameter.value,
        meaning=meaning,
    )
