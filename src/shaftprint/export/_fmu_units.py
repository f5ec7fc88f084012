"""Units of an FMU by what they are in base units of SI."""

from collections.abc import Iterable
from math import pi
from xml.etree.ElementTree import Element, SubElement

from shaftprint.units import SECONDS_PER_MINUTE

# Powers of base units and factor; a unit that does not stand here is declared by its name alone.
BASE_UNITS: dict[str, dict[str, float]] = {
    "-": {},
    "s": {"s": 1},
    "1/s": {"s": -1},
    "Hz": {"s": -1},
    "rad": {"rad": 1},
    "rad/s": {"rad": 1, "s": -1},
    "rpm": {"rad": 1, "s": -1, "factor": 2.0 * pi / SECONDS_PER_MINUTE},
    "N m": {"kg": 1, "m": 2, "s": -2},
    "kg m2": {"kg": 1, "m": 2},
}


def unit_name(unit: str) -> str:
    """Return how a unit is called in the model description, which has 1 for none."""
    return "1" if unit == "-" else unit


def unit_definitions(units: Iterable[str]) -> Element:
    """Return the definitions of units, each once."""
    definitions = Element("UnitDefinitions")
    for unit in dict.fromkeys(unit for unit in units if unit):
        definition = SubElement(definitions, "Unit", name=unit_name(unit))
        if unit in BASE_UNITS:
            powers = {name: repr(value) for name, value in BASE_UNITS[unit].items()}
            SubElement(definition, "BaseUnit", powers)
    return definitions
