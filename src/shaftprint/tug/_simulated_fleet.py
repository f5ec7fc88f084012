"""Simulated sister ships, which differ within the tolerances of building, and tests of them on any day."""

from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.tug._changes import (
    in_water,
    on_another_day,
    sea_water_kg_m3,
    with_delay,
    with_gains,
    with_inertia,
    with_injection,
    with_load,
)
from shaftprint.tug._sail import sail
from shaftprint.tug._simulated_ship import SimulatedShip, Wear, ship_at, vessel_at
from shaftprint.tug._truth import Truth
from shaftprint.tug._tug import Tug
from shaftprint.vessel._vessel import Vessel

WATER_C = (5.0, 25.0)
DRAUGHT_STD_M = 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class Tolerances:
    """Standard deviations by which sister ships differ as they are built, shares unless a unit is named."""

    injection: float = 0.01
    """Torque for the same rack."""
    proportional_gain: float = 0.003
    """Of the governor: the same figure in each control unit, and as much as its sensors differ."""
    integral_gain: float = 0.003
    """Of the governor."""
    governor_delay_s: float = 1e-3
    """Delay of governor and fuel [s]."""
    set_point_latency_s: float = 1e-3
    """Time from the set point to the demand [s]."""
    natural_frequency: float = 0.01
    """Of the fuel actuator."""
    damping_ratio: float = 0.03
    """Of the fuel actuator."""
    propeller: float = 0.015
    """Torque of the propeller at the same speed, as pitch within class I of ISO 484 gives it."""
    inertia: float = 0.005
    """Behind the torque gauge."""
    inertia_upstream: float = 0.005
    """Ahead of it: engine, flywheel and gearbox, of which the vessel file states the drawing."""
    gauge_scale: float = 0.01
    """What the torque gauge shows; the vessel file of the Stan Tug states 2 %."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SimulatedFleet:
    """Sister ships whose truth is known at every time."""

    class_name: str
    """What they have in common."""
    vessel: Vessel
    """The installation that all of them were built as."""
    ships: tuple[SimulatedShip, ...]
    """The ships."""


def simulated_fleet(
    vessel: Vessel,
    names: tuple[str, ...],
    *,
    launched: datetime,
    rng: np.random.Generator,
    tolerances: Tolerances | None = None,
    wear: Wear | None = None,
    like: Tug | None = None,
) -> SimulatedFleet:
    """Return sister ships that differ within the tolerances of building.

    ``vessel``: the installation that all of them were built as. ``names``: a name of each ship. ``launched``: when they
    were new, with time zone. ``rng``: draws how they differ. ``tolerances``: by how much; the usual ones when not
    given. ``wear``: how all of them wear; not at all when not given. ``like``: the ship that they are all meant to be;
    the reference truth when not given.
    """
    tolerances = tolerances or Tolerances()
    like = like or Tug.stan_tug_1205()
    ships = tuple(
        SimulatedShip(
            name=name,
            built=as_built(like, vessel, tolerances, rng),
            launched=launched,
            gauge_scale=1.0 + float(rng.normal(0.0, tolerances.gauge_scale)),
            wear=wear or Wear(),
        )
        for name in names
    )
    return SimulatedFleet(class_name=vessel.name, vessel=vessel, ships=ships)


def as_built(tug: Tug, vessel: Vessel, tolerances: Tolerances, rng: np.random.Generator) -> Tug:
    """Return one ship of a class within the tolerances of building.

    ``tug``, ``vessel``: the ship that is meant, and its installation. ``tolerances``: by how much ships differ.
    ``rng``: draws this one.
    """
    tug = with_injection(tug, _factor(tolerances.injection, rng))
    tug = with_gains(
        tug,
        proportional=_factor(tolerances.proportional_gain, rng),
        integral=_factor(tolerances.integral_gain, rng),
    )
    tug = with_delay(tug, float(rng.normal(0.0, tolerances.governor_delay_s)))
    tug = replace(
        tug,
        set_point_latency_s=tug.set_point_latency_s + float(rng.normal(0.0, tolerances.set_point_latency_s)),
        natural_frequency_rad_s=tug.natural_frequency_rad_s * _factor(tolerances.natural_frequency, rng),
        damping_ratio=tug.damping_ratio * _factor(tolerances.damping_ratio, rng),
    )
    tug = with_load(tug, _factor(tolerances.propeller, rng), vessel)
    tug = with_inertia(tug, _factor(tolerances.inertia, rng), vessel)
    upstream = vessel.inertia_upstream_kg_m2 if tug.inertia_upstream_kg_m2 is None else tug.inertia_upstream_kg_m2
    return replace(tug, inertia_upstream_kg_m2=upstream * _factor(tolerances.inertia_upstream, rng))


def _factor(tolerance: float, rng: np.random.Generator) -> float:
    return float(np.exp(rng.normal(0.0, tolerance)))


@dataclass(frozen=True, kw_only=True, slots=True)
class SailedTest:
    """A test of a ship that was recorded, with what its crew knew on that day."""

    recording: Path
    """The raw recording."""
    tested_at: datetime
    """When it was made."""
    vessel: Vessel
    """The installation as its file of that day states it: the zero of the gauge was taken anew, the water measured."""
    water_temperature_c: float
    """Temperature of the water [degrees Celsius]."""
    truth: Truth
    """What was put into the recording."""


def sail_test(
    fleet: SimulatedFleet,
    name: str,
    moment: datetime,
    campaign: Campaign,
    recording: str | Path,
    *,
    rng: np.random.Generator,
) -> SailedTest:
    """Sail a test of one ship of a fleet at one time, and write its raw recording.

    The day is drawn: water and draught, wandering inflow, load, zero of the gauge. The density of the water is
    measured, the draught is not.

    ``name``: which of its ships. ``moment``: when, with time zone. ``campaign``: what is asked of it. ``recording``:
    file to write, in the native container; its truth goes beside it. ``rng``: draws the day and the noise. Raises
    SettingsError if there is no such ship, or it was not yet there; RecordingError if the file exists, or cannot be
    written.
    """
    ship = next((one for one in fleet.ships if one.name == name), None)
    if ship is None:
        names = ", ".join(one.name for one in fleet.ships)
        raise SettingsError(f"{fleet.class_name}: expected one of its ships, {names}, found {name!r}.")
    temperature = float(rng.uniform(*WATER_C))
    density = sea_water_kg_m3(temperature)
    tug = on_another_day(ship_at(ship, moment, fleet.vessel), fleet.vessel, rng)
    tug = in_water(tug, fleet.vessel, density_kg_m3=density, deeper_m=float(rng.normal(0.0, DRAUGHT_STD_M)))
    true = vessel_at(ship, moment, fleet.vessel)
    truth = sail(true, campaign, recording, tug=tug, seed=int(rng.integers(2**31)))
    stated = zero_taken(fleet.vessel, tug, rng).model_copy(update={"water_density_kg_m3": density})
    return SailedTest(
        recording=Path(recording), tested_at=moment, vessel=stated, water_temperature_c=temperature, truth=truth
    )


def zero_taken(vessel: Vessel, tug: Tug, rng: np.random.Generator) -> Vessel:
    """Return the installation with the zero of the gauge taken that day, as well as its file says it can be taken.

    ``vessel``: the installation as its file states it. ``tug``: the ship on that day. ``rng``: draws the error of the
    zero.
    """
    gauge = vessel.sensors.shaft_torque
    # what the channel shows without torque, in the sign of the vessel file: it is subtracted
    zero_nm = gauge.zero_nm + tug.torque_zero_offset_nm + float(rng.normal(0.0, gauge.zero_std_nm or 0.0))
    content = vessel.model_dump()
    content["sensors"]["shaft_torque"]["zero_nm"] = zero_nm
    return Vessel.model_validate(content)
