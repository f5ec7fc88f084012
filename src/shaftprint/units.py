"""Conversions between the units of the trade and SI; speeds are revolutions a second inside shaftprint.

========================= ============================================================
quantity                  unit inside
========================= ============================================================
rotational speed ``n``    rev/s (engine side unless the name says ``shaft``)
torque ``M``              N m
angle of a shaft          rev (of that shaft); phase of a response: rad
frequency of a test line  Hz; ``omega`` in rad/s
time                      s since the start of the recording
========================= ============================================================
"""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

SECONDS_PER_MINUTE = 60.0
SECONDS_PER_HOUR = 3600.0
M_S_PER_KNOT = 1852.0 / SECONDS_PER_HOUR
PERCENT, MILLI, PPM = 100.0, 1e3, 1e6
"""How many hundredths, thousandths and millionths there are in one."""

# Ways in which loggers and people write the units that vessel files know.
_SPELLINGS = {
    "volt": "V", "volts": "V", "v": "V", "nm": "N m", "n·m": "N m", "n*m": "N m", "n.m": "N m", "newton metre": "N m",
    "n-m": "N m", "newton-meter": "N m", "newton meters": "N m",
    "mv/v": "mV/V", "mv / v": "mV/V", "percentage": "%",
    "knm": "kN m", "kn·m": "kN m", "kn.m": "kN m", "kn-m": "kN m", "percent": "%", "pct": "%", "kt": "kn",
    "kts": "kn", "knot": "kn",
    "knots": "kn", "rpm": "rpm", "1/min": "rpm", "min-1": "rpm", "min^-1": "rpm", "rev/min": "rpm", "r/min": "rpm",
    "min⁻¹": "rpm", "u/min": "rpm", "rps": "rev/s", "rad/sec": "rad/s", "milliampere": "mA", "ma": "mA",
    "mv": "mV", "millivolt": "mV", "millivolts": "mV", "µv": "uV", "μv": "uV", "uv": "uV", "a": "A", "amp": "A",
    "ampere": "A", "µa": "uA", "μa": "uA", "ua": "uA",
    "degree": "deg", "degrees": "deg", "°": "deg", "°/s": "deg/s", "radian": "rad", "radians": "rad", "turn": "rev",
    "turns": "rev", "revolution": "rev", "revolutions": "rev", "count": "counts", "cts": "counts", "tick": "counts",
    "ticks": "counts",
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "m s-1": "m/s",
    "l/h": "L/h", "l/hr": "L/h", "lph": "L/h", "litre/h": "L/h", "liter/h": "L/h",
    "m s^-1": "m/s", "mps": "m/s", "hertz": "Hz", "hz": "Hz",
}  # fmt: skip
# Those that a capital letter tells apart.
_BY_LETTER = {"MNm": "MN m", "MN·m": "MN m", "MN.m": "MN m", "mNm": "mN m", "mN·m": "mN m", "mN.m": "mN m"}

ANGLES_REV: Mapping[str, float] = MappingProxyType({"rev": 1.0, "deg": 1.0 / 360.0, "rad": 0.5 / math.pi})
"""Turns of a shaft for one unit of those in which angles are given [rev]."""

REV_S_PER_UNIT: Mapping[str, float] = MappingProxyType(
    {"rev/s": 1.0, "rpm": 1.0 / SECONDS_PER_MINUTE, "rad/s": 0.5 / math.pi, "deg/s": 1.0 / 360.0}
)
"""Rotational speed for one unit of those in which instruments give it [rev/s]."""

NM_PER_UNIT: Mapping[str, float] = MappingProxyType({"N m": 1.0, "kN m": 1000.0})
"""Torque for one unit of those in which telemetries give it [N m]."""

_QUANTITIES: tuple[Mapping[str, float], ...] = tuple(
    MappingProxyType(dict(units))
    for units in (
        {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "kV": 1e3},
        {"A": 1.0, "mA": 1e-3, "uA": 1e-6, "kA": 1e3},
        {"rad/s": 1.0, "deg/s": math.pi / 180.0, "rpm": 2.0 * math.pi / SECONDS_PER_MINUTE, "rev/s": 2.0 * math.pi},
        {"rad": 1.0, "mrad": 1e-3, "deg": math.pi / 180.0, "rev": 2.0 * math.pi},
        {**NM_PER_UNIT, "MN m": 1e6, "mN m": 1e-3, "N cm": 1e-2},
        {"N": 1.0, "kN": 1e3, "mN": 1e-3},
        {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
        {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "kn": M_S_PER_KNOT, "km/h": 1e3 / SECONDS_PER_HOUR},
        {"-": 1.0, "%": 1e-2},
    )
)
"""Size of each unit in the first of its quantity."""
_ANYWHERE = ("rad", "m", "degC", "K")

_Number = TypeVar("_Number", float, NDArray[np.float64])


def rev_s_from_rpm(speed_rpm: _Number) -> _Number:
    """Convert a rotational speed from rpm to rev/s."""
    return speed_rpm / SECONDS_PER_MINUTE


def rpm_from_rev_s(speed_rev_s: _Number) -> _Number:
    """Convert a rotational speed from rev/s to rpm."""
    return speed_rev_s * SECONDS_PER_MINUTE


def decibel(magnitude: _Number) -> _Number:
    """Convert an amplitude ratio to decibel, ``20 log10``."""
    level: _Number = 20.0 * np.log10(magnitude)
    return level


def plain_unit(text: str) -> str:
    """Return a unit as vessel files write it; one that they do not know as it is."""
    text = text.strip().strip("\0").strip()
    return _BY_LETTER.get(text, _SPELLINGS.get(text.lower(), text))


def zero_is_anywhere(unit: str) -> bool:
    """Return whether a sensor of a unit has its zero where it was put, as an encoder or a thermometer has."""
    return any(unit_factor(unit, one) is not None for one in _ANYWHERE)


def unit_factor(given: str, wanted: str) -> float | None:
    """Return what a number in one unit is multiplied by to be in another; None where they are of other quantities."""
    one, other = plain_unit(given), plain_unit(wanted)
    if one == other:
        return 1.0
    return next((units[one] / units[other] for units in _QUANTITIES if one in units and other in units), None)
