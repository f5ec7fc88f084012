"""Under which conditions a fingerprint holds: the ship, the test, its time, place and water, the working point."""

from collections.abc import Mapping
from datetime import datetime
from typing import TYPE_CHECKING, Any, Literal

from pydantic import FiniteFloat

from shaftprint.fingerprint._number import Number
from shaftprint.records import Record
from shaftprint.vessel._ship import ImoNumber, ShortName

if TYPE_CHECKING:
    from shaftprint.campaign._trial_conditions import TrialConditions
    from shaftprint.vessel._vessel import Vessel

WATER = ("draught_m", "trim_m", "water_temperature_c", "water_density_kg_m3", "depth_m", "wind_m_s")
"""What is stated of ship and water at a test; no recording shows it."""


class ShipIdentity(Record):
    """Which ship and which of its shaft lines was tested."""

    name: ShortName
    """Name of the ship."""
    imo_number: ImoNumber | None = None
    """The number that it keeps for life; small and inland ships have none."""
    class_name: ShortName | None = None
    """What its sister ships have in common."""
    line: ShortName
    """The shaft line, such as ``port``."""


class Tested(Record):
    """What was tested, when and where."""

    place: str | None = None
    """Where it was made; None where the campaign file does not say."""
    tested_at: datetime | None = None
    """When the recording began, by the logger's clock or as stated; None where neither says. Without an offset it is
    what a clock showed in a zone that nobody stated."""
    ship: ShipIdentity | None = None
    """Which ship and shaft line; None where the vessel file does not say. A drive is called by its name here."""

    def of_ship_and_water(self) -> dict[str, float | None]:
        """Return what is stated of ship and water; empty for what is no ship."""
        return {}


class Conditions(Tested):
    """Under which conditions the fingerprint holds."""

    vessel: str
    """Name of the vessel and shaft line."""
    campaign: str
    """Name of the test."""
    draught_m: FiniteFloat | None = None
    """Mean draught [m]; this and the following are None where nobody stated them."""
    trim_m: FiniteFloat | None = None
    """Draught aft minus draught forward [m]."""
    water_temperature_c: FiniteFloat | None = None
    """Temperature of the water [degrees Celsius]."""
    water_density_kg_m3: FiniteFloat | None = None
    """Density of the water at the test [kg/m3]; where it is stated, ``K_Q`` is made with it."""
    depth_m: FiniteFloat | None = None
    """Depth of the water [m]."""
    wind_m_s: FiniteFloat | None = None
    """Speed of the true wind [m/s]."""
    engine_speed: Number
    """Working-point engine speed."""
    shaft_torque: Number
    """Working-point shaft torque at the gauge."""
    set_point_v: float
    """Mean set-point voltage of the working point [V]."""
    speed_channel: str
    """Speed sensor that was identified."""
    mode: Literal["shaftprint", "thesis"]
    """How the signals were prepared."""
    lines_used: tuple[str, ...]
    """Test lines that were fitted."""
    lines_left_out: dict[str, str]
    """Test lines that were not, with the reason."""

    def of_ship_and_water(self) -> dict[str, float | None]:
        """Return what is stated of ship and water, None where nobody stated it."""
        return {name: getattr(self, name) for name in WATER}


def conditions_stated(
    vessel: "Vessel", campaign: str, place: str | None, trial: "TrialConditions | None", tested_at: datetime | None
) -> Mapping[str, Any]:
    """Return the conditions that no recording shows, as fields of ``Conditions``.

    ``vessel``, ``campaign``, ``place``: what was tested, by what, and where the campaign file says. ``trial``: where
    and in what water, where somebody says so. ``tested_at``: when the recording began, where that is known.
    """
    ship = None if vessel.ship is None else ShipIdentity(**vessel.ship.model_dump())
    water = {} if trial is None else {name: getattr(trial, name) for name in WATER}
    place = place if trial is None or trial.place is None else trial.place
    test = {"vessel": vessel.name, "campaign": campaign, "place": place, "tested_at": tested_at}
    return test | {"ship": ship} | water
