"""The noun of the room: the installation of one shaft line."""

import math
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal, Self

from numpy.typing import ArrayLike
from pydantic import Field, field_validator, model_validator

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.errors import SettingsError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.settings import Name, PositiveNumber, Settings, load_settings, names_twice
from shaftprint.vessel._company import Company
from shaftprint.vessel._envelope import StatedEnvelope
from shaftprint.vessel._hull import Hull
from shaftprint.vessel._inertia import InertiaRow
from shaftprint.vessel._limits import OperatingLimits
from shaftprint.vessel._links import ShaftLink, wrong_links
from shaftprint.vessel._machinery import Curve, Engine, Gearbox, Motor, Propeller
from shaftprint.vessel._motor_words import in_file_words
from shaftprint.vessel._orders import Order, orders_of
from shaftprint.vessel._pitch import ControllablePitch, wrong_pitch
from shaftprint.vessel._sensors import Logger, Sensors
from shaftprint.vessel._shaft_machine import ShaftMachine, wrong_shaft_machine
from shaftprint.vessel._ship import Ship
from shaftprint.vessel._usual import INERTIA_STD, WASH_SHARE_STD
from shaftprint.vessel._working_point import WorkingPoint

# Fresh water that is warm to the saltest sea, with a margin [kg/m3].
_DENSITIES = (900.0, 1100.0)


class Vessel(Shown, Settings):
    """One shaft line of a ship, with its sensors."""

    name: Name
    """Name of the ship and the shaft line."""
    water_density_kg_m3: PositiveNumber
    """Density of the water [kg/m3]."""
    engine: Engine | None = None
    """The engine, where one drives the line."""
    motor: Motor | None = None
    """The electric motor, where one drives the line."""
    shaft_machine: ShaftMachine | None = None
    """An electric machine beside the engine on the gearbox, where there is one."""
    gearbox: Gearbox
    """The reduction gear."""
    propeller: Propeller
    """The propeller."""
    pitch: ControllablePitch | None = None
    """Its controllable pitch; None where the pitch is fixed."""
    working_point: WorkingPoint
    """Expected steady state between the test signals."""
    inertia: tuple[InertiaRow, ...] = Field(min_length=2)
    """Rotating masses from the damper to the water around the propeller."""
    links: tuple[ShaftLink, ...] = ()
    """What joins them, for torsional vibration; none where only the sums are wanted."""
    sensors: Sensors
    """What was measured."""
    limits: OperatingLimits = OperatingLimits()
    """What must not be passed during a test."""
    envelope: StatedEnvelope | None = None
    """What the owner allows a program that plays a test; None where no program may."""
    hull: Hull | None = None
    """The ship around the shaft lines, for tests underway."""
    logger: Logger | None = None
    """The instrument that recorded."""
    ship: Ship | None = None
    """The ship and its line by number and name, for fingerprints of many years; None where not stated."""
    company: Company | None = None
    """Who makes the test, for the first page of the report."""

    def summary(self) -> Summary:
        """Return engine, gearbox, propeller, working point, inertias and sensors."""
        machine, gearbox, propeller, point = self.machine, self.gearbox, self.propeller, self.working_point
        channels = [speed.channel for speed in self.sensors.speed]
        channels += [self.sensors.shaft_torque.channel, self.sensors.set_point.channel]
        facts = {
            machine.word: f"{machine.rated_power_kw:g} kW at {machine.rated_speed_rpm:g} rpm"
            + (f", {machine.cylinders} cylinders" if isinstance(machine, Engine) else ""),
            "gearbox": f"ratio {gearbox.ratio:g}, efficiency {gearbox.efficiency:g}",
            **self._machine_fact(),
            "propeller": f"{propeller.blades} blades, {propeller.diameter_m:g} m, P/D {propeller.pitch_ratio:g}",
            "working point": f"{point.engine_speed_rpm:g} rpm, {point.shaft_torque_nm:g} N m"
            f"{', astern' * point.is_astern}",
            "inertia": f"{self.inertia_upstream_kg_m2:.3g} kg m2 before, {self.inertia_downstream_kg_m2:.3g} kg m2 "
            "behind the torque gauge, at the propeller shaft",
            "channels": shortened(channels),
        }
        return Summary(title=f"Vessel {self.name}", facts=facts)

    def _machine_fact(self) -> dict[str, str]:
        """Return the electric machine on the gearbox in words, where there is one."""
        machine = self.shaft_machine
        if machine is None:
            return {}
        does = "takes out" if machine.share < 0.0 else "gives"
        return {
            "electric machine": f"{machine.rated_power_kw:g} kW at {machine.rated_speed_rpm:g} rpm, {does} "
            f"{100.0 * abs(machine.share):.3g} % of the torque"
        }

    @model_validator(mode="before")
    @classmethod
    def _shafts_by_one_name(cls, content: Any) -> Any:
        return in_file_words(content)

    @field_validator("water_density_kg_m3")
    @classmethod
    def _is_of_water(cls, density: float) -> float:
        lowest, highest = _DENSITIES
        if not lowest <= density <= highest:
            meant = 1000.0 * density
            hint = f"; {density:g} t/m3 are {meant:g} kg/m3" if lowest <= meant <= highest else ""
            raise ValueError(
                f"expected the density of water, {lowest:g} to {highest:g} kg/m3, found {density:g}{hint}."
            )
        return density

    @model_validator(mode="after")
    def _one_machine_drives(self) -> Self:
        if (self.engine is None) == (self.motor is None):
            found = "neither" if self.engine is None else "both"
            raise ValueError(f"expected either a table [engine] or a table [motor], found {found}.")
        if self.motor is not None and self.limits.motoring_speed_rpm:
            raise ValueError(
                "expected no limits.motoring_speed_rpm beside [motor], found some; that is the drag of an engine "
                "without fuel, what a motor brakes with is motor.regenerating_torque_nm."
            )
        if self.motor is not None and self.sensors.rack is not None:
            raise ValueError(
                "expected no sensors.rack beside [motor], found one; it is the fuel of an engine, leave it out."
            )
        return self

    @model_validator(mode="after")
    def _masses_make_a_line(self) -> Self:
        names = [row.name for row in self.inertia]
        twice = names_twice(names)
        errors = []
        if twice:
            errors.append(f"expected every inertia row to have its own name, found {', '.join(twice)} twice.")
        for side, value in (
            ("upstream", self.inertia_upstream_kg_m2),
            ("downstream", self.inertia_downstream_kg_m2),
        ):
            if value <= 0.0:
                errors.append(f"expected some inertia {side} of the torque gauge, found none.")
        errors += wrong_links(self.links, self.inertia)
        if self.working_point.is_astern:
            errors += self._wrong_astern()
        errors += wrong_pitch(
            self.pitch,
            self.sensors,
            self.working_point,
            pitch_ratio=self.propeller.pitch_ratio,
            has_motor=self.motor is not None,
        )
        errors += wrong_shaft_machine(
            self.shaft_machine,
            self.engine,
            self.gearbox,
            self.working_point,
            is_shown=self.sensors.machine_torque is not None,
        )
        if self.working_point.ship_speed_m_s is not None and self.hull is None:
            errors.append("expected [hull] beside ship_speed_m_s of the working point, a test underway, found none.")
        if errors:
            raise ValueError(" ".join(errors))
        return self

    def _wrong_astern(self) -> list[str]:
        errors = []
        if self.propeller.astern_torque_coefficient is None:
            errors.append(
                'expected propeller.astern_torque_coefficient beside direction = "astern" of the working point, found '
                "none; astern a propeller takes another torque than ahead."
            )
        if self.is_underway:
            errors.append(
                'expected a test at the quay beside direction = "astern" of the working point, found a ship_speed_m_s; '
                "the ship's own motion is described ahead only."
            )
        return errors

    @property
    def torque_coefficient(self) -> float:
        """Effective ``K_Q`` at zero advance in the direction of the test."""
        astern = self.propeller.astern_torque_coefficient
        return astern if self.working_point.is_astern and astern is not None else self.propeller.torque_coefficient

    @property
    def torque_coefficient_std(self) -> float | None:
        """Standard deviation of that coefficient; None where it is not stated."""
        propeller, is_astern = self.propeller, self.working_point.is_astern
        has_own = is_astern and propeller.astern_torque_coefficient is not None
        return propeller.astern_torque_coefficient_std if has_own else propeller.torque_coefficient_std

    def coefficient_of(self, torque_nm: float, engine_speed_rev_s: float) -> float:
        """Return the torque coefficient ``K_Q = M eta_R / (rho n^2 D^5)`` of a torque at the propeller shaft.

        ``torque_nm``: the torque [N m]. ``engine_speed_rev_s``: speed of the engine [rev/s].
        """
        propeller = self.propeller
        shaft_rev_s = engine_speed_rev_s / self.gearbox.ratio
        force = self.water_density_kg_m3 * shaft_rev_s * shaft_rev_s * propeller.diameter_m**5
        return torque_nm * propeller.relative_rotative_efficiency / force

    def driving_torque_nm(self, reading: ArrayLike) -> FloatArray:
        """Return the shaft torque [N m] of readings of the gauge, positive as it drives the propeller the way it turns.

        Parameters
        ----------
        reading
            Readings in the unit of the channel, of any shape.
        """
        torque_nm = self.sensors.shaft_torque.torque_nm(reading)
        return -torque_nm if self.working_point.is_astern else torque_nm

    @property
    def is_underway(self) -> bool:
        """Whether it is tested underway, not at the quay."""
        return self.working_point.ship_speed_m_s is not None

    @property
    def wash(self) -> tuple[float, float]:
        """Share of its torque that the propeller loses in a twice as fast wash of the other, and its deviation."""
        return (0.0, WASH_SHARE_STD) if self.hull is None else (self.hull.wash_share, self.hull.wash_std)

    @property
    def shows_pitch(self) -> bool:
        """Whether a controllable pitch, its set point and what it reaches are logged."""
        return self.pitch is not None and self.sensors.pitch is not None

    @property
    def combinator(self) -> ControllablePitch | None:
        """The pitch that a lever asks for together with the speed; None where no lever does."""
        return self.pitch if self.pitch is not None and self.pitch.has_combinator else None

    @property
    def why_one_speed(self) -> str:
        """Why the numbers of its line belong to one speed; empty where tests at several speeds share them."""
        if self.is_underway:
            return "underway slopes of the propeller and the time of the ship belong to one speed"
        return "" if self.combinator is None else "with a combinator each speed has a propeller of another pitch"

    @property
    def machine(self) -> Engine | Motor:
        """What drives the line, engine or motor."""
        if self.motor is not None:
            return self.motor
        assert self.engine is not None  # noqa: S101  (the file is refused without either)
        return self.engine

    @property
    def drive(self) -> Literal["engine", "motor", "hybrid"]:
        """What drives the line: an engine, a motor, or an engine with an electric machine on its gearbox."""
        if self.motor is not None:
            return "motor"
        return "engine" if self.shaft_machine is None else "hybrid"

    @property
    def engine_share(self) -> float:
        """Torque that the engine gives at the working point over the whole: 1 where no electric machine helps."""
        return 1.0 if self.shaft_machine is None else 1.0 - self.shaft_machine.share

    @property
    def motoring(self) -> Curve | None:
        """Braking torque over speed as positive numbers: an engine's without fuel, a motor's highest; None: unknown."""
        if self.motor is not None:
            return self.motor.regenerating
        limits = self.limits
        return (limits.motoring_speed_rpm, limits.motoring_torque_nm) if limits.motoring_speed_rpm else None

    @property
    def orders(self) -> tuple[Order, ...]:
        """Orders of engine, shaft and propeller in the shaft torque, lowest first."""
        return orders_of(self.machine, self.gearbox, self.propeller)

    @property
    def inertia_upstream_kg_m2(self) -> float:
        """Inertia between engine and torque gauge, referred to the propeller shaft [kg m2]."""
        return self._inertia_kg_m2("upstream")

    @property
    def inertia_downstream_kg_m2(self) -> float:
        """Inertia between torque gauge and water, referred to the propeller shaft [kg m2]."""
        return self._inertia_kg_m2("downstream")

    @property
    def inertia_upstream_std_kg_m2(self) -> float:
        """Standard deviation of the upstream inertia [kg m2], rows taken as independent."""
        return self._inertia_std_kg_m2("upstream")

    @property
    def inertia_downstream_std_kg_m2(self) -> float:
        """Standard deviation of the downstream inertia [kg m2], rows taken as independent."""
        return self._inertia_std_kg_m2("downstream")

    @property
    def taken_as_usual(self) -> tuple[str, ...]:
        """Standard deviations that the file does not state, each with the value that is taken, in words."""
        gauge, field = self.sensors.shaft_torque, "sensors.shaft_torque"
        usual = []
        if gauge.scale_std_fraction is None:
            usual.append(f"{field}.scale_std_fraction = {gauge.scale_std:g}")
        if gauge.zero_std_nm is None:
            usual.append(f"{field}.zero_std_nm = {gauge.zero_std:g}")
        if gauge.latency_std_s is None:
            usual.append(f"{field}.latency_std_s = {gauge.latency_std:g}")
        silent = [row.name for row in self.inertia if row.std_kg_m2 is None]
        if silent:
            usual.append(f"std_kg_m2 of {', '.join(silent)} = {INERTIA_STD:g} of the inertia")
        if self.sensors.pitch is not None and self.sensors.pitch.scale_std_fraction is None:
            usual.append(f"sensors.pitch.scale_std_fraction = {self.sensors.pitch.scale_std:g}")
        if self.is_underway and self.sensors.ship_speed is not None:
            log = self.sensors.ship_speed
            if log.scale_std_fraction is None:
                usual.append(f"sensors.ship_speed.scale_std_fraction = {log.scale_std:g}")
            if log.latency_std_s is None:
                usual.append(f"sensors.ship_speed.latency_std_s = {log.latency_std:g}")
        return tuple(usual)

    def _inertia_kg_m2(self, gauge: Literal["upstream", "downstream"]) -> float:
        ratio = self.gearbox.ratio
        machine = self.shaft_machine if gauge == "upstream" else None
        geared = 0.0 if machine is None else machine.referred_kg_m2
        return math.fsum((geared, *(row.referred_kg_m2(ratio) for row in self.inertia if row.gauge == gauge)))

    def _inertia_std_kg_m2(self, gauge: Literal["upstream", "downstream"]) -> float:
        ratio = self.gearbox.ratio
        machine = self.shaft_machine if gauge == "upstream" else None
        geared = 0.0 if machine is None else machine.referred_std_kg_m2
        return math.hypot(geared, *(row.referred_std_kg_m2(ratio) for row in self.inertia if row.gauge == gauge))


@refusing_none(SettingsError)
def load_vessel(path_or_name: str | Path) -> Vessel:
    """Read a vessel file, or a shipped one by its name such as ``stan-tug-1205``.

    Parameters
    ----------
    path_or_name
        Path of a TOML file, or the name of a shipped vessel.

    Raises
    ------
    SettingsError
        If the file cannot be used; the message lists every field that is wrong.
    """
    vessel = load_settings(path_or_name, Vessel, shipped=files(__package__) / "shipped")
    if vessel.company is not None:
        vessel.company.lies_in(Path(path_or_name).resolve().parent)
    return vessel
