"""The conditions of a test in words: ship, time, place and water, wherever they are shown."""

from typing import TYPE_CHECKING

from shaftprint.digits import plain

if TYPE_CHECKING:
    from datetime import datetime

    from shaftprint.fingerprint._conditions import Conditions, ShipIdentity

DECIMALS = {
    "draught_m": ("Draught", 2, "m"),
    "trim_m": ("Trim", 2, "m aft"),
    "water_temperature_c": ("Water temperature", 1, "°C"),
    "water_density_kg_m3": ("Water density", 1, "kg/m³"),
    "depth_m": ("Depth", 1, "m"),
    "wind_m_s": ("Wind", 1, "m/s"),
}
"""Title, decimals and unit of what may be stated of ship and water."""


def tested_text(moment: "datetime | None") -> str:
    """Return when a test was made, with its time where it has one and its offset where that is known; else nothing."""
    if moment is None:
        return ""
    midnight = (moment.hour, moment.minute, moment.second) == (0, 0, 0)
    if moment.tzinfo is None:
        return moment.strftime("%Y-%m-%d" if midnight else "%Y-%m-%d %H:%M")
    offset = moment.strftime("%z")
    return f"{moment:%Y-%m-%d %H:%M} {offset[:3]}:{offset[3:5]}"


def ship_text(ship: "ShipIdentity | None") -> str:
    """Return a ship with its line and IMO number; nothing where it is not stated."""
    if ship is None:
        return ""
    number = "" if ship.imo_number is None else f", IMO {ship.imo_number}"
    return f"{ship.name}, {ship.line}{number}"


def water_facts(conditions: "Conditions") -> list[tuple[str, str]]:
    """Return what is stated of ship and water at a test, each with its title and unit."""
    stated = ((title, getattr(conditions, name), digits, unit) for name, (title, digits, unit) in DECIMALS.items())
    return [(title, f"{plain(value, digits)} {unit}") for title, value, digits, unit in stated if value is not None]
