"""The noun of the room: what stands on a ship's card."""

from dataclasses import dataclass
from typing import Literal

from shaftprint.card._series import usual_area_ratio


@dataclass(frozen=True, kw_only=True, slots=True)
class Pulses:
    """A channel with the pulses of a pick-up."""

    channel: str
    """Name of the channel in the recording."""
    wheel: str = "1"
    """Pulses in one turn, or a wheel with gaps or further teeth such as ``60-2``."""


ASSUMED_PULSES = Pulses(channel="PTM_e")
"""The pick-up on the engine that is assumed where no speed is stated at all."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Gauge:
    """The torque gauge on the propeller shaft."""

    channel: str = "M_s"
    """Name of the channel in the recording."""
    unit: Literal["V", "N m", "kN m"] = "N m"
    """Unit of the channel."""
    scale_nm_per_unit: float | None = None
    """Torque for one unit of the channel [N m]; None where the unit says it."""
    full_scale_nm: float | None = None
    """Largest torque that it passes on [N m]; None: half as much again as the rated torque of the shaft."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Lever:
    """What the logger records of the lever, and which speed it asks for."""

    unit: Literal["V", "mA", "%", "rpm", "counts"] = "V"
    """Unit of the channel."""
    pairs: tuple[tuple[float, float], ...] = ()
    """Readings in that unit, each with the engine speed that it asks for [rpm]; none where nobody knows."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Card:
    """What is known of one shaft line without asking the builder; what is None is derived or a documented default."""

    rated_power_kw: float
    """Brake power of one engine at rated speed [kW]."""
    rated_speed_rpm: float
    """Rated speed of the engine [rpm]."""
    cylinders: int
    """Number of cylinders."""
    diameter_m: float
    """Diameter of the propeller [m]."""
    blades: int
    """Number of blades."""
    pitch_ratio: float
    """Pitch over diameter."""
    gear_ratio: float | None = None
    """Engine speed over propeller speed; None where ``propeller_rated_rpm`` gives it."""
    propeller_rated_rpm: float | None = None
    """Speed of the propeller at rated engine speed [rpm], instead of the ratio or beside it."""
    name: str = "My ship"
    """Name of ship and shaft line."""
    strokes_per_cycle: int = 4
    """2 or 4."""
    area_ratio: float | None = None
    """Expanded blade area over disc area."""
    in_nozzle: bool = False
    """Whether the propeller turns in a nozzle."""
    is_underway: bool = False
    """Whether the test is made underway, not at bollard pull."""
    water_density_kg_m3: float = 1025.0
    """Density of the water [kg/m3]."""
    engine_speed_rpm: float | None = None
    """Engine speed of the test [rpm]."""
    shaft_torque_nm: float | None = None
    """Torque of the propeller shaft there, where it was measured [N m]."""
    idle_speed_rpm: float | None = None
    """Idle speed [rpm]."""
    inertia_upstream_kg_m2: float | None = None
    """Inertia towards the engine, referred to the propeller shaft [kg m2]."""
    inertia_downstream_kg_m2: float | None = None
    """Inertia towards the propeller with its water [kg m2]."""
    engine_pulses: tuple[Pulses, ...] = ()
    """Pick-ups on the engine shaft."""
    shaft_pulses: tuple[Pulses, ...] = ()
    """Pick-ups on the propeller shaft."""
    engine_speeds: tuple[str, ...] = ()
    """Channels with the speed of the engine in rpm, as an instrument or a bus gives it."""
    shaft_speeds: tuple[str, ...] = ()
    """The same of the propeller shaft; where no speed is stated at all, one pulse a turn of the engine is assumed."""
    gauge: Gauge = Gauge()
    """The torque gauge."""
    set_point_channel: str = "U_setpoint"
    """Channel of the set point."""
    lever: Lever = Lever()
    """What that channel shows."""
    sample_rate_hz: float = 2000.0
    """Samples a second of the logger [Hz]."""

    @property
    def series(self) -> str:
        """Name of the propeller series that it is compared with."""
        return "Ka4-70 in nozzle 19A" if self.in_nozzle else "Wageningen B"

    @property
    def usual_area_ratio(self) -> float:
        """Blade area ratio as stated, or as usual with or without nozzle."""
        return usual_area_ratio(self.area_ratio, self.series)
