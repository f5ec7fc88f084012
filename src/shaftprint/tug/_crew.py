"""Whoever measures one line on a voyage: its sensors, and the channels of the log that they fill."""

from typing import Literal, Protocol, TypedDict

import numpy as np
from numpy.typing import NDArray

from shaftprint.campaign._campaign import Campaign
from shaftprint.errors import SettingsError
from shaftprint.recording._writer import RecordingWriter
from shaftprint.tug._pitch_actuation import PitchActuation
from shaftprint.tug._truth import StripTruth, Truth, rack_latency_s, tell_truth
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import Demand
from shaftprint.tug.plant._physics import build_plant, equilibrium, steady_load_nm
from shaftprint.tug.plant._pitch import actuation_of
from shaftprint.tug.plant._plant import RACK, SPEED, WAY
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageSensor, MessageTimes
from shaftprint.tug.sensors._control_unit import ControlUnit
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._demand_messages import DemandMessages
from shaftprint.tug.sensors._encoder import Encoder
from shaftprint.tug.sensors._faults import Fault
from shaftprint.tug.sensors._gauge import TorqueGauge, TorqueMessages
from shaftprint.tug.sensors._helm import Helm, HelmMessages, PitchLever
from shaftprint.tug.sensors._log import SpeedLog
from shaftprint.tug.sensors._machine_torque import MachineTorque
from shaftprint.tug.sensors._pitch_feedback import PitchFeedback
from shaftprint.tug.sensors._pulses import PickUp
from shaftprint.tug.sensors._speed_meter import SpeedMessages, SpeedMeter
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel
from shaftprint.vessel._wheel import SAMPLES_A_TOOTH

RATE_HZ = 2000.0
"""Sample rate where the vessel file names no logger [Hz]."""


class _Sensor(Protocol):
    """One channel of the logger."""

    logged: LoggedChannel

    def next(self, stretch: Stretch) -> NDArray[np.int16]: ...

    def faults(self) -> list[Fault]: ...


class _SensorClock(TypedDict):
    """When the samples of a channel are taken."""

    rate_hz: float
    start_s: float
    times: Literal["by rate", "uneven"]


class Crew:
    """The sensors of one line on one voyage, and the log that they fill."""

    def __init__(self, tug: Tug, vessel: Vessel, campaign: Campaign, *, seed: int, line: int | None = None) -> None:
        self._tug, self._vessel, self._campaign, self._seed = tug, vessel, campaign, seed
        self._rate_hz = RATE_HZ if vessel.logger is None else vessel.logger.sample_rate_hz
        self._samples = round(campaign.duration_s * self._rate_hz)
        if self._samples < 1:
            raise SettingsError(
                f"campaign {campaign.name}: expected at least one sample at {self._rate_hz:g} Hz, "
                f"found a duration of {campaign.duration_s:g} s."
            )
        self._expect_fast_logger()
        # from bus on they come last: without them the others draw the same numbers
        process, torque, set_point, *speeds, bus, log, pitch, demand, feedback, machine, of_torque = (
            np.random.default_rng(child)
            for child in np.random.SeedSequence(seed if line is None else (seed, line)).spawn(
                10 + len(vessel.sensors.speed)
            )
        )
        duration_s = campaign.duration_s
        plant = build_plant(tug, vessel)
        first = equilibrium(plant, Demand(tug, vessel, campaign, start_s=0.0, step_s=1.0 / self._rate_hz).first)
        load = plant.propeller_nm_s2
        self.process = process
        cycle_s, averaging_s = tug.torque_cycle_s, 0.0
        if cycle_s is not None and tug.torque_is_mean:
            # a mean makes late by half of its length, which the latency of the telemetry has room for
            averaging_s = min(cycle_s - 1.0 / self._rate_hz, 2.0 * vessel.sensors.shaft_torque.latency_s)
        gauge = TorqueGauge(
            tug.noise,
            vessel,
            load_nm_s2=load,
            zero_offset_nm=tug.torque_zero_offset_nm,
            first_torque_nm=steady_load_nm(plant, float(first[SPEED])),
            duration_s=duration_s,
            rate_hz=self._rate_hz,
            rng=torque,
            averaging_s=averaging_s,
        )
        self._gauge: TorqueGauge | TorqueMessages = gauge
        if cycle_s is not None:
            times = MessageTimes(Bus.of(tug), cycle_s=cycle_s, rng=of_torque)
            self._gauge = TorqueMessages(gauge, times, averaging_s=averaging_s, rate_hz=self._rate_hz)
        self._helm = self._stand_by_helm(set_point)
        self._speeds = [
            self._stand_by_shaft(sensor, rng) for sensor, rng in zip(vessel.sensors.speed, speeds, strict=True)
        ]
        self._control_unit = self._watch_bus(float(first[RACK]), bus)
        self._log = self._read_log(float(first[WAY]), log)
        self._lever = self._stand_by_lever(pitch)
        self._feedback = self._watch_pitch(feedback)
        self._machine = MachineTorque.of(tug, vessel, rate_hz=self._rate_hz, rng=machine)
        asked = vessel.sensors.demand
        self._demand = (
            None if asked is None else DemandMessages(asked, rate_hz=self._rate_hz, rng=demand, bus=Bus.of(tug))
        )
        of_gearbox = (self._lever, self._feedback, self._machine)
        every = (self._helm, *self._speeds, self._gauge, *of_gearbox, self._control_unit, self._demand, self._log)
        self._sensors: tuple[_Sensor, ...] = tuple(sensor for sensor in every if sensor is not None)
        self._limited = {excitation.name: 0 for excitation in campaign.excitations}

    def _expect_fast_logger(self) -> None:
        vessel = self._vessel
        highest_rpm = vessel.limits.highest_speed_rpm or vessel.machine.rated_speed_rpm
        for sensor in vessel.sensors.speed:
            if not sensor.gives_pulses:
                continue
            turns_hz = highest_rpm / 60.0 / vessel.gearbox.engine_over(sensor.shaft)
            if self._rate_hz < SAMPLES_A_TOOTH * sensor.toothed.closest * turns_hz:
                raise SettingsError(
                    f"vessel {vessel.name}: expected a logger of {sensor.toothed.least_rate_hz(turns_hz):g} Hz or more "
                    f"for channel {sensor.channel}, as the wheel {sensor.toothed} makes up to {turns_hz:.3g} turns a "
                    f"second, found {self._rate_hz:g} Hz; raise logger.sample_rate_hz, or take a wheel with fewer "
                    "teeth or that of a slower shaft."
                )

    def _stand_by_shaft(
        self, sensor: SpeedSensor, rng: np.random.Generator
    ) -> PickUp | SpeedMeter | SpeedMessages | Encoder:
        tug, vessel = self._tug, self._vessel
        if sensor.gives_pulses:
            duration_s = self._campaign.duration_s
            return PickUp(sensor, tug, vessel, duration_s=duration_s, rate_hz=self._rate_hz, rng=rng)
        if sensor.unit == "rpm" and tug.speed_cycle_s is not None:
            return SpeedMessages(
                sensor, vessel, cycle_s=tug.speed_cycle_s, rate_hz=self._rate_hz, rng=rng, bus=Bus.of(tug)
            )
        kind = Encoder if sensor.gives_angle else SpeedMeter
        return kind(sensor, tug, vessel, rate_hz=self._rate_hz, rng=rng)

    def _stand_by_helm(self, rng: np.random.Generator) -> Helm | HelmMessages:
        tug, vessel, campaign = self._tug, self._vessel, self._campaign
        if tug.set_point_cycle_s is None:
            return Helm(tug, vessel, campaign, rate_hz=self._rate_hz, rng=rng)
        return HelmMessages(
            tug, vessel, campaign, cycle_s=tug.set_point_cycle_s, rate_hz=self._rate_hz, rng=rng, bus=Bus.of(tug)
        )

    def _stand_by_lever(self, rng: np.random.Generator) -> PitchLever | None:
        sensor = self._vessel.sensors.pitch_set_point
        if sensor is None:
            return None
        return PitchLever(sensor.channel, self._tug, self._campaign, rng=rng)

    def _watch_pitch(self, rng: np.random.Generator) -> PitchFeedback | None:
        sensor = self._vessel.sensors.pitch
        if sensor is None:
            return None
        sailing = self._tug.sailing
        return PitchFeedback(
            sensor,
            actuation_of(self._tug) or PitchActuation(),
            pitch_ratio=self._vessel.propeller.pitch_ratio if sailing is None else sailing.pitch_ratio,
            rate_hz=self._rate_hz,
            rng=rng,
        )

    def _watch_bus(self, first_rack: float, rng: np.random.Generator) -> ControlUnit | None:
        sensor = self._vessel.sensors.rack
        if sensor is None:
            return None
        latency_s = rack_latency_s(self._tug, sensor)
        return ControlUnit(
            sensor,
            self._vessel,
            latency_s=latency_s,
            first_rack=first_rack,
            rate_hz=self._rate_hz,
            rng=rng,
            bus=Bus.of(self._tug),
        )

    def _read_log(self, first_speed_m_s: float, rng: np.random.Generator) -> SpeedLog | None:
        sensor = self._vessel.sensors.ship_speed
        if sensor is None:
            return None
        sailing = self._tug.sailing
        noise, shown = (0.0, 1.0) if sailing is None else (sailing.log_rms_m_s, sailing.log_scale)
        return SpeedLog(
            sensor, noise_m_s=noise, shown=shown, first_speed_m_s=first_speed_m_s, rate_hz=self._rate_hz, rng=rng
        )

    def truth(self) -> Truth:
        """Return the truth once all is recorded."""
        faults = [fault for sensor in self._sensors for fault in sensor.faults()]
        strips = tuple(
            StripTruth(
                channel=pick_up.logged.name,
                angle_deg=tuple((360.0 * pick_up.angle_rev).tolist()),
                start_deg=360.0 * pick_up.phase_rev,
            )
            for pick_up in self._speeds
            if isinstance(pick_up, PickUp)
        )
        lengths = {e.name: (e.stop_s - e.start_s) * self._rate_hz for e in self._campaign.excitations}
        return tell_truth(
            self._tug,
            self._vessel,
            self._campaign,
            seed=self._seed,
            rate_hz=self._rate_hz,
            strips=strips,
            faults=tuple(faults),
            limited={name: count / lengths[name] for name, count in self._limited.items()},
        )

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels that it fills."""
        return tuple(sensor.logged.name for sensor in self._sensors)

    @property
    def rate_hz(self) -> float:
        """Samples a second [Hz]."""
        return self._rate_hz

    @property
    def samples(self) -> int:
        """Samples of the whole voyage."""
        return self._samples

    def declare(self, writer: RecordingWriter) -> None:
        """Say of every channel what it holds."""
        for sensor in self._sensors:
            logged = sensor.logged
            writer.declare(
                logged.name,
                unit=logged.unit,
                scale=logged.scale,
                offset=logged.offset,
                long_name=logged.long_name,
                **self._clock_of(sensor),
            )

    def _clock_of(self, sensor: _Sensor) -> _SensorClock:
        """Return on which clock a sensor is recorded: that of the logger, or that of its messages."""
        if not isinstance(sensor, MessageSensor):
            return {"rate_hz": self._rate_hz, "start_s": 0.0, "times": "by rate"}
        times = sensor.times
        kind: Literal["by rate", "uneven"] = "by rate" if times.is_regular else "uneven"
        return {"rate_hz": 1.0 / times.cycle_s, "start_s": times.start_s, "times": kind}

    def write(self, writer: RecordingWriter, stretch: Stretch) -> None:
        """Measure a stretch of the voyage and write it down."""
        for sensor in self._sensors:
            if isinstance(sensor, MessageSensor) and not sensor.times.is_regular:
                writer.append(sensor.logged.name, *sensor.messages(stretch))
            else:
                writer.append(sensor.logged.name, sensor.next(stretch))
        times = stretch.time_s[stretch.limited]
        for excitation in self._campaign.excitations:
            inside = (times >= excitation.start_s) & (times < excitation.stop_s)
            self._limited[excitation.name] += int(np.count_nonzero(inside))
