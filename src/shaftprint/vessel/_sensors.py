"""What was measured, on which channel, and what is known of each sensor."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from shaftprint.arrays import FloatArray
from shaftprint.local_ids import SPEED
from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveInteger, PositiveNumber, Settings, names_twice
from shaftprint.units import ANGLES_REV, M_S_PER_KNOT, REV_S_PER_UNIT
from shaftprint.vessel._latency import LatencySeconds
from shaftprint.vessel._local_ids import ChannelName, wrong_local_ids
from shaftprint.vessel._machine_torque import MachineTorqueSensor
from shaftprint.vessel._machinery import Machine
from shaftprint.vessel._pitch_sensors import PitchSensor, PitchSetPointSensor
from shaftprint.vessel._plain_unit import PLAIN_UNIT, in_kept_unit
from shaftprint.vessel._set_point import SetPointSensor
from shaftprint.vessel._shaft_torque import ShaftTorqueSensor
from shaftprint.vessel._usual import LOG_LATENCY_SHARE, LOG_SCALE_STD
from shaftprint.vessel._wheel import Wheel

SpeedUnit: TypeAlias = Annotated[
    Literal["V", "mA", "rpm", "rev/s", "rad/s", "deg/s", "Hz", "m/s", "deg", "rad", "rev", "counts"],
    PLAIN_UNIT,
]


class SpeedSensor(Settings):
    """A pick-up that gives pulses as strips on a shaft, or the teeth of a wheel, pass by; an instrument; an encoder.

    The pulses themselves are in V, without ``rpm_per_unit``. A speed is in a unit of speed; in Hz, the frequency of the
    pulses of ``wheel`` or ``pulses_per_revolution``; in m/s, at ``diameter_m``; or in V or mA with a line, ``n =
    rpm_per_unit * reading + rpm_at_zero``. An encoder's angle is in deg, rad or rev, or in counts of which
    ``counts_per_revolution`` make a turn; it may begin again after ``rolls_over_at``.
    """

    name: Name
    """Name of the speed that it gives, such as ``n_e``."""
    channel: Name
    """Name of the channel in the recording."""
    shaft: Literal["engine", "propeller"]
    """Which shaft carries the strips."""
    wheel: Annotated[str, Field(strict=True)] | None = None
    """Toothed wheel with gaps, ``"60-2"`` or ``"36-2-1"``, or with further teeth, ``"12+1"``; evenly spaced where not
    given."""
    pulses_per_revolution: PositiveInteger = 1
    """Number of strips or teeth around the shaft by which the angle is counted; follows from ``wheel`` where given.
    Needed for pulses and their frequency."""
    unit: SpeedUnit
    """Unit of the channel."""
    diameter_m: PositiveNumber | None = None
    """Diameter at which a speed in m/s is that of the surface, as of a roller on the shaft [m]."""
    rpm_per_unit: Number | None = None
    """Speed of the shaft for one volt or milliampere of an instrument [rpm per unit]."""
    rpm_at_zero: Number | None = None
    """Speed of the shaft at no volt or milliampere, found by extending the line [rpm]; 0 where not given."""
    counts_per_revolution: PositiveNumber | None = None
    """Counts of an encoder in one turn of the shaft."""
    rolls_over_at: PositiveNumber | None = None
    """What an encoder turns until its angle begins again, in the unit of the channel, such as 65536 counts; where not
    given, one turn if the angle stays within it, else it goes on."""
    latency_s: LatencySeconds = 0.0
    """Time by which a speed is late, that of an instrument or its filter [s]; none for pulses."""
    latency_std_s: LatencySeconds | None = None
    """Standard deviation of that time where the speed comes in messages [s]; where not stated, that of values which are
    up to a message old."""
    edge: Literal["rising", "falling"] = "rising"
    """Which edge of a pulse marks the angle of the strip."""
    pulse_width_deg: PositiveNumber | None = None
    """Angle of the shaft during which a pulse is high [deg]."""
    strip_angles_deg: tuple[PositiveNumber, ...] | None = None
    """Angles between the strips as found earlier [deg], for comparison only, shape (strips,)."""
    jitter_us: NotNegativeNumber | None = None
    """Standard deviation of the time of an edge [us]."""

    @model_validator(mode="before")
    @classmethod
    def _teeth_of_the_wheel(cls, content: Any) -> Any:
        """Count the teeth of a wheel."""
        content = in_kept_unit(content, per_unit="rpm_per_unit")
        if not isinstance(content, Mapping) or not isinstance(content.get("wheel"), str):
            return content
        counted = Wheel.parse(content["wheel"]).counted
        pulses = content.get("pulses_per_revolution", counted)
        if pulses != counted:
            raise ValueError(
                f'expected pulses_per_revolution left out beside wheel = "{content["wheel"]}", found {pulses}.'
            )
        return {**content, "pulses_per_revolution": counted}

    @property
    def gives_pulses(self) -> bool:
        """Whether the channel holds the pulses themselves, not a speed."""
        return self.unit == "V" and self.rpm_per_unit is None

    @property
    def gives_angle(self) -> bool:
        """Whether the channel holds the angle of an encoder."""
        return self.unit in ANGLES_REV or self.unit == "counts"

    @property
    def counts_turns(self) -> bool:
        """Whether turns of the shaft are counted, by pulses or an angle, so that the mean speed has no error."""
        return self.gives_pulses or self.gives_angle

    @property
    def rev_per_unit(self) -> float:
        """Turns of the shaft for one unit of an encoder's angle [rev per unit]."""
        return 1.0 / (self.counts_per_revolution or 1.0) if self.unit == "counts" else ANGLES_REV[self.unit]

    def speed_rev_s(self, reading: ArrayLike) -> FloatArray:
        """Return the speed of the shaft [rev/s] for readings of an instrument in the channel's unit, of any shape."""
        value = np.asarray(reading, dtype=np.float64)
        if self.unit in ("V", "mA"):
            rpm = REV_S_PER_UNIT["rpm"]
            return rpm * ((self.rpm_per_unit or 0.0) * value + (self.rpm_at_zero or 0.0))
        if self.unit == "Hz":
            # as many edges as there are teeth, those between the places too
            return value / (self.toothed.counted + self.toothed.extra)
        if self.unit == "m/s":
            return value / (math.pi * (self.diameter_m or 1.0))
        return value * REV_S_PER_UNIT[self.unit]

    @model_validator(mode="after")
    def _unit_has_what_it_needs(self) -> Self:
        is_scaled = self.unit in ("V", "mA")
        wanted = {
            "pulses_per_revolution or wheel": (
                self.gives_pulses or self.unit == "Hz",
                bool({"pulses_per_revolution", "wheel"} & self.model_fields_set),
            ),
            "diameter_m": (self.unit == "m/s", self.diameter_m is not None),
            "rpm_per_unit": (self.unit == "mA", bool(self.rpm_per_unit)),
            "counts_per_revolution": (self.unit == "counts", self.counts_per_revolution is not None),
        }
        errors = [
            f"expected {field} for a channel in {self.unit}, found none."
            for field, (is_needed, is_given) in wanted.items()
            if is_needed and not is_given
        ]
        errors += [
            f'expected {field} left out for a channel in "{self.unit}", found {value:g}.'
            for field, value, fits in (
                ("diameter_m", self.diameter_m, self.unit == "m/s"),
                ("rpm_per_unit", self.rpm_per_unit, is_scaled),
                ("rpm_at_zero", self.rpm_at_zero, is_scaled and self.rpm_per_unit is not None),
                ("counts_per_revolution", self.counts_per_revolution, self.unit == "counts"),
                ("rolls_over_at", self.rolls_over_at, self.gives_angle),
                ("latency_s", self.latency_s or None, not self.gives_pulses),
                ("latency_std_s", self.latency_std_s, not self.gives_pulses),
            )
            if value is not None and not fits
        ]
        if is_scaled and self.rpm_per_unit == 0.0 and not errors:
            errors.append("expected rpm_per_unit other than 0, found 0.")
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def toothed(self) -> Wheel:
        """The wheel; one without gaps where the pulses are evenly spaced."""
        return Wheel(places=self.pulses_per_revolution) if self.wheel is None else Wheel.parse(self.wheel)

    @model_validator(mode="after")
    def _strips_fit_on_the_shaft(self) -> Self:
        errors = []
        strips = self.pulses_per_revolution
        closest = self.toothed.closest
        if self.pulse_width_deg is not None and self.pulse_width_deg * closest >= 360.0:
            errors.append(
                f"expected pulse_width_deg below {360.0 / closest:g} for {closest} strips, "
                f"found {self.pulse_width_deg:g}."
            )
        angles = self.strip_angles_deg
        # 0.1 deg: printed tables are rounded (table 3.4 of the thesis adds up to 360.02 deg)
        if angles is not None and (len(angles) != strips or abs(sum(angles) - 360.0) > 0.1):
            errors.append(
                f"expected strip_angles_deg to hold {strips} angles that add up to 360, "
                f"found {len(angles)} that add up to {sum(angles):g}."
            )
        if errors:
            raise ValueError(" ".join(errors))
        return self


class RackSensor(Settings):
    """What the engine's control unit says of the torque that it demands: the picture of the fuel rack.

    SAE J1939-71: percent torque of EEC1, 1 % a bit from -125 % on, 100 % for a rack of 1; percent load of EEC2, 100 %
    for the torque that the engine can give at its speed; or the fuel rate of LFE, which goes with rack and speed. A
    message every 10 to 100 ms.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: Annotated[Literal["%", "L/h"], PLAIN_UNIT]
    """Unit of the channel."""
    shows: Literal["torque", "load"] = "torque"
    """Of what a percentage is: of rated torque, or of the full-load curve at the speed of the engine."""
    rated_l_h: PositiveNumber | None = None
    """Fuel rate at rated power and speed [L/h], for a channel in L/h."""
    cycle_s: PositiveNumber
    """Time from one message to the next [s]."""
    resolution_percent: PositiveNumber = 1.0
    """Step of the value [%]."""
    resolution_l_h: PositiveNumber = 0.05
    """Step of a fuel rate [L/h]."""
    latency_s: LatencySeconds
    """Time by which a value is late behind the output of the governor [s]."""
    latency_std_s: LatencySeconds | None = None
    """Standard deviation of the latency [s]."""

    @model_validator(mode="after")
    def _rate_has_a_scale(self) -> Self:
        is_rate = self.unit == "L/h"
        errors = []
        if is_rate and self.rated_l_h is None:
            errors.append("expected rated_l_h for a channel in L/h, found none.")
        if not is_rate and self.rated_l_h is not None:
            errors.append(f"expected rated_l_h left out for a channel in %, found {self.rated_l_h:g}.")
        if is_rate and self.shows == "load":
            errors.append('expected shows left out for a channel in L/h, found "load".')
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def words(self) -> str:
        """What the channel holds, in words."""
        return "fuel rate" if self.unit == "L/h" else f"percent {self.shows}"

    @property
    def rack_per_unit(self) -> float:
        """Rack for one unit of the channel at rated speed [1 per unit]."""
        return 0.01 if self.rated_l_h is None else 1.0 / self.rated_l_h

    @property
    def resolution(self) -> float:
        """Step of the value, in the unit of the channel."""
        return self.resolution_percent if self.unit == "%" else self.resolution_l_h

    @property
    def goes_with_speed(self) -> bool:
        """Whether the rack hangs on the speed of the engine beside the value."""
        return self.unit == "L/h" or self.shows == "load"

    def share(self, speed_rpm: FloatArray, engine: Machine) -> FloatArray:
        """Return the rack for one value at speeds of the engine over that at rated speed and torque.

        Of a load it goes with the full-load curve; of a fuel rate, ``X n``, with one over the speed.

        Parameters
        ----------
        speed_rpm
            Speed of the engine [rpm], of any shape.
        engine
            The engine.
        """
        if self.unit == "L/h":
            return engine.rated_speed_rpm / speed_rpm
        if self.shows == "torque":
            return np.ones_like(speed_rpm)
        return np.asarray(np.interp(speed_rpm, *engine.full_load) / engine.rated_torque_nm)


class DemandSensor(Settings):
    """The speed that the engine's control unit says it has been asked for, logged beside the set point.

    SAE J1939-71: the desired operating speed of EEC3, 0.125 rpm a bit; or the pedal beside a voltage.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: Annotated[Literal["rpm", "%", "V"], PLAIN_UNIT]
    """Unit of the channel; its scale does not matter."""
    cycle_s: PositiveNumber
    """Time from one message to the next [s]."""
    latency_s: LatencySeconds
    """Time by which a value is late behind the demand [s]."""
    latency_std_s: LatencySeconds | None = None
    """Standard deviation of the latency [s]."""


class ShipSpeedSensor(Settings):
    """A log or a satellite receiver that gives the speed of the ship.

    What answers the propellers is the speed through the water; a steady current does not matter to its changes.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: Literal["m/s", "kn"]
    """Unit of the channel."""
    cycle_s: PositiveNumber
    """Time from one value to the next [s]."""
    resolution: PositiveNumber
    """Step of the value, in the unit of the channel."""
    latency_s: NotNegativeNumber
    """Time by which a value is late [s]."""
    latency_std_s: NotNegativeNumber | None = None
    """Standard deviation of the latency [s]; see ``latency_std`` where it is not stated."""
    scale_std_fraction: NotNegativeNumber | None = None
    """Relative standard deviation of the mean speed through the water, with that of a current where a satellite
    receiver gives it; see ``scale_std`` where it is not stated."""

    @property
    def latency_std(self) -> float:
        """Standard deviation of the latency [s], as stated or as usual."""
        return LOG_LATENCY_SHARE * self.cycle_s if self.latency_std_s is None else self.latency_std_s

    @property
    def scale_std(self) -> float:
        """Relative standard deviation of the mean speed, as stated or as usual."""
        return LOG_SCALE_STD if self.scale_std_fraction is None else self.scale_std_fraction

    @property
    def m_s_per_unit(self) -> float:
        """Speed for one unit of the channel [m/s]."""
        return M_S_PER_KNOT if self.unit == "kn" else 1.0


class Logger(Settings):
    """The instrument that recorded the channels."""

    sample_rate_hz: PositiveNumber
    """Samples a second of every channel [Hz]."""
    clock_tolerance_ppm: NotNegativeNumber | None = None
    """Largest error of its crystal [parts per million]."""


class Sensors(Settings):
    """All sensors of the instrumented shaft line."""

    speed: tuple[SpeedSensor, ...] = Field(min_length=1)
    """Speed pick-ups; the first is the one that is identified."""
    shaft_torque: ShaftTorqueSensor
    """The torque gauge."""
    set_point: SetPointSensor
    """The speed set point."""
    rack: RackSensor | None = None
    """Percent torque from the engine's control unit, where it was logged."""
    demand: DemandSensor | None = None
    """The demand inside the engine's control unit, where it was logged beside the set point."""
    ship_speed: ShipSpeedSensor | None = None
    """Speed of the ship, where it was logged."""

    pitch_set_point: PitchSetPointSensor | None = None
    """The set point of the pitch of a controllable-pitch propeller, where it was logged."""
    pitch: PitchSensor | None = None
    """The pitch of a controllable-pitch propeller, where it was logged."""
    machine_torque: MachineTorqueSensor | None = None
    """The torque of an electric machine on the gearbox, where it was logged."""
    local_ids: tuple[ChannelName, ...] = ()
    """What channels are called by ISO 19848, where a data server on board has them."""

    @property
    def channels(self) -> tuple[tuple[str, str], ...]:
        """Channel and unit of every sensor, the speeds first."""
        further = (self.rack, self.demand, self.ship_speed, self.pitch_set_point, self.pitch, self.machine_torque)
        every = (*self.speed, self.shaft_torque, self.set_point, *(one for one in further if one is not None))
        return tuple((one.channel, one.unit) for one in every)

    @model_validator(mode="after")
    def _names_and_channels_differ(self) -> Self:
        names = [sensor.name for sensor in self.speed]
        channels = [channel for channel, _ in self.channels]
        errors = []
        for what, values in (("name", names), ("channel", channels)):
            twice = names_twice(values)
            if twice:
                errors.append(f"expected every sensor to have its own {what}, found {', '.join(twice)} twice.")
        meant: dict[str, str | None] = dict.fromkeys(channels)
        meant |= {one.channel: SPEED for one in self.speed if not (one.gives_pulses or one.gives_angle)}
        meant |= {self.shaft_torque.channel: "torque", self.set_point.channel: "set point"}
        errors += wrong_local_ids(self.local_ids, meant)
        if errors:
            raise ValueError(" ".join(errors))
        return self
