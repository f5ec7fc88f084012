"""A simulated ship over the years: as it was built, how it wears, what is done to it."""

from dataclasses import dataclass, replace
from datetime import datetime
from typing import Final

from shaftprint.errors import SettingsError
from shaftprint.tug._changes import with_delay, with_gains, with_injection, with_load
from shaftprint.tug._tug import Tug
from shaftprint.vessel._vessel import Vessel

SECONDS_PER_YEAR: Final = 365.25 * 86400.0
CLEANS: Final = ("docking", "propeller-polished")
"""Work after which the propeller is as it was built."""
NEW_INJECTORS: Final = "injectors-changed"


@dataclass(frozen=True, kw_only=True, slots=True)
class Wear:
    """How fast a ship changes by itself."""

    injection_per_year: float = 0.0
    """Share of the torque at the same rack that is lost in a year, until injectors are changed."""
    fouling_per_year: float = 0.0
    """Share by which the torque of the propeller grows in a year, until it is cleaned."""
    delay_s_per_year: float = 0.0
    """Time by which the fuel comes later in a year [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ShipWork:
    """What is done to a ship at one time."""

    kind: str
    """What it is called, such as ``docking``; the propeller is clean after ``docking`` and ``propeller-polished``, the
    injection new after ``injectors-changed``."""
    at: datetime
    """When, with time zone."""
    proportional: float = 1.0
    """Factor on the proportional gain of the governor from then on."""
    integral: float = 1.0
    """Factor on its integral gain."""
    gauge_scale: float = 1.0
    """Factor on what the torque gauge shows from then on."""
    is_noted: bool = True
    """Whether somebody writes it down."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SimulatedShip:
    """A ship whose truth is known at every time."""

    name: str
    """What it is called."""
    built: Tug
    """As it was when it was new."""
    launched: datetime
    """When that was, with time zone."""
    gauge_scale: float = 1.0
    """What its torque gauge shows over the truth."""
    wear: Wear = Wear()
    """How it wears."""
    works: tuple[ShipWork, ...] = ()
    """What is done to it."""


def ship_at(ship: SimulatedShip, moment: datetime, vessel: Vessel) -> Tug:
    """Return the truth of a ship at one time, on a usual day.

    Losses and growth are exponential: each year's is a share of what is left.

    ``moment``: when, with time zone. ``vessel``: the installation that it was built as. Raises SettingsError if the
    ship was not yet there.
    """
    _expect_there(ship, moment)
    done = [work for work in ship.works if work.at <= moment]
    tug = ship.built
    for work in done:
        tug = with_gains(tug, proportional=work.proportional, integral=work.integral)
    wear = ship.wear
    tug = with_injection(tug, (1.0 - wear.injection_per_year) ** _years_since(ship, moment, (NEW_INJECTORS,)))
    tug = with_delay(tug, wear.delay_s_per_year * _years_since(ship, moment, ()))
    return with_load(tug, (1.0 + wear.fouling_per_year) ** _years_since(ship, moment, CLEANS), vessel)


def vessel_at(ship: SimulatedShip, moment: datetime, vessel: Vessel) -> Vessel:
    """Return the installation as it is at one time: what its torque gauge shows follows the ship's own scale.

    ``moment``: when, with time zone. ``vessel``: the installation as its file states it.
    """
    _expect_there(ship, moment)
    scale = ship.gauge_scale
    for work in ship.works:
        scale *= work.gauge_scale if work.at <= moment else 1.0
    gauge = vessel.sensors.shaft_torque
    # a gauge that shows more gives more of its unit for a newton metre
    true = gauge.model_copy(update={"scale_nm_per_unit": gauge.scale_nm_per_unit / scale})
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": true})})


def with_works(ship: SimulatedShip, *works: ShipWork) -> SimulatedShip:
    """Return a ship to which more is done."""
    return replace(ship, works=tuple(sorted((*ship.works, *works), key=lambda work: work.at)))


def _years_since(ship: SimulatedShip, moment: datetime, kinds: tuple[str, ...]) -> float:
    """Return the years since work of some kinds was last done, else since the ship was new."""
    begun = max((work.at for work in ship.works if work.kind in kinds and work.at <= moment), default=ship.launched)
    return (moment - max(begun, ship.launched)).total_seconds() / SECONDS_PER_YEAR


def _expect_there(ship: SimulatedShip, moment: datetime) -> None:
    if moment < ship.launched:
        raise SettingsError(
            f"{ship.name}: expected a time after it was launched on {ship.launched:%Y-%m-%d}, found {moment:%Y-%m-%d}."
        )
