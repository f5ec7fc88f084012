"""Factors between the units of one quantity, for the signals of drives."""

import math
from collections.abc import Mapping
from types import MappingProxyType

from shaftprint.units import NM_PER_UNIT, SECONDS_PER_MINUTE, plain_unit

_QUANTITIES: tuple[Mapping[str, float], ...] = tuple(
    MappingProxyType(dict(units))
    for units in (
        {"V": 1.0, "mV": 1e-3, "kV": 1e3},
        {"A": 1.0, "mA": 1e-3, "kA": 1e3},
        {"rad/s": 1.0, "deg/s": math.pi / 180.0, "rpm": 2.0 * math.pi / SECONDS_PER_MINUTE, "rev/s": 2.0 * math.pi},
        {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "rev": 2.0 * math.pi},
        {**NM_PER_UNIT, "mN m": 1e-3, "N cm": 1e-2},
        {"N": 1.0, "kN": 1e3, "mN": 1e-3},
        {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
        {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3},
        {"-": 1.0, "%": 1e-2},
    )
)
"""Size of each unit in the first of its quantity."""


_ANYWHERE = ("rad", "m", "degC", "K")


def zero_is_anywhere(unit: str) -> bool:
    """Return whether a sensor of a unit has its zero where it was put, as an encoder or a thermometer has."""
    return any(unit_factor(unit, one) is not None for one in _ANYWHERE)


def unit_factor(given: str, wanted: str) -> float | None:
    """Return what a number in one unit is multiplied by to be in another; None where they are of other quantities."""
    one, other = plain_unit(given), plain_unit(wanted)
    if one == other:
        return 1.0
    return next((units[one] / units[other] for units in _QUANTITIES if one in units and other in units), None)
