"""The noun of the room: what a prepared recording consists of."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.distributions import chi_square_quantile
from shaftprint.errors import SignalError
from shaftprint.notebook._labelled import Labelled, LabelledData, Variable
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.reasons import Reason
from shaftprint.signals._channel_signals import ChannelSignal, ExcitationSignal, MessageSignal, SpeedSignal
from shaftprint.signals._gaps import Coverage, Gap
from shaftprint.signals._leg_channels import channels_about
from shaftprint.signals._orders import TrackedOrder
from shaftprint.signals._working_points import LegState, WorkingPoint
from shaftprint.units import rpm_from_rev_s

# More strips than this are teeth, of which the worst is named.
_MOST_LISTED = 12
# Errors of angles that are together smaller than chance makes them in this share of shafts with even strips are none.
_BY_CHANCE = 0.99

_UNITS = {
    "n_set": ("rev/s", "set point of the engine speed"),
    "M_s": ("N m", "shaft torque at the gauge"),
    "X": ("-", "fuel rack, share of the full rack"),
    "theta_set": ("-", "pitch set point, P/D"),
    "M_m": ("N m", "torque of the electric machine at the propeller shaft"),
    "v_s": ("m/s", "speed of the ship"),
}


@dataclass(frozen=True, kw_only=True, slots=True)
class Repair:
    """One place where a raw channel was not taken at its word."""

    channel: str
    """Name of the channel in the recording."""
    kind: str
    """``"outlier"``, ``"missing pulse"``, ``"doubled pulse"``, ``"dropout"`` or ``"saturated"``."""
    time_s: float
    """When it starts, in seconds of the recording."""
    count: int
    """How many samples or pulses it concerns."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SetPointCalibration:
    """The line from set-point voltage to engine speed, ``n_set = slope U + intercept`` (thesis eq. 3.2)."""

    slope_rev_s_per_v: float
    """Slope [rev/s per V]."""
    intercept_rev_s: float
    """Intercept [rev/s]."""
    covariance: FloatArray
    """Covariance of (slope, intercept), shape (2, 2)."""
    level_v: FloatArray
    """Mean voltage of each steady level [V], shape (levels,), ascending."""
    level_rev_s: FloatArray
    """Mean engine speed of each steady level [rev/s], shape (levels,)."""
    level_std_rev_s: FloatArray
    """Standard deviation of each mean speed [rev/s], shape (levels,)."""
    bend: float = 0.0
    """Share by which the line is steeper at twice the speed of the working point, where slope and intercept belong."""
    bend_std: float = math.inf
    """Standard deviation of that share; infinite where nothing is said of it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StripAngles:
    """The angles between the reflection strips of a multi-pulse shaft (thesis eqs 3.3-3.5, table 3.4)."""

    channel: str
    """Name of the pulse channel."""
    angle_rev: FloatArray
    """Angle from each strip to the next [rev], shape (strips,); they sum to 1."""
    std_rev: FloatArray
    """Standard deviation of each angle [rev], shape (strips,)."""
    nominal_rev: FloatArray | None = None
    """The same of a wheel without errors [rev], shape (strips,); even strips where not given."""

    @property
    def error_rev(self) -> FloatArray:
        """By how much each angle differs from that of even strips, or of a wheel without errors [rev]."""
        nominal = 1.0 / self.angle_rev.size if self.nominal_rev is None else self.nominal_rev
        return np.asarray(self.angle_rev - nominal)

    @property
    def worst(self) -> int:
        """Which angle has the largest error."""
        return int(np.argmax(np.abs(self.error_rev)))

    @property
    def are_even(self) -> bool:
        """Whether the errors of all angles together are no more than chance makes of those of even strips."""
        error, std = self.error_rev, self.std_rev
        away = np.divide(error, std, out=np.full(error.shape, np.inf), where=std > 0.0)
        return float(np.sum(away**2)) < chi_square_quantile(_BY_CHANCE, self.angle_rev.size - 1)

    @property
    def are_many(self) -> bool:
        """Whether they are too many to be listed one by one."""
        return self.angle_rev.size > _MOST_LISTED


@dataclass(frozen=True, kw_only=True, slots=True)
class StepDelay:
    """Time between the set point and the speed crossing the middle of one step (thesis table 3.3)."""

    staircase: str
    """Name of the staircase."""
    set_point_time_s: float
    """When the set point crosses the middle of the step [s]."""
    speed_time_s: float | None
    """When the engine speed crosses the middle of the step [s]; None where its noise crosses it too."""
    rising: bool
    """Whether the step raises the speed."""

    @property
    def delay_s(self) -> float | None:
        """Level-crossing delay [s]: transport delay, rise time of the loop and sensor delay together."""
        return None if self.speed_time_s is None else self.speed_time_s - self.set_point_time_s


@dataclass(frozen=True, kw_only=True, slots=True)
class SetPointDelay:
    """How late the demand inside the control unit is behind the set point, by the sines of a test."""

    channel: str
    """Name of the channel with the demand."""
    delay_s: float
    """The delay, without the known latency of the channel [s]."""
    std_s: float
    """Its standard deviation, without that of the latency [s]."""
    lines: int
    """Number of sines that say so."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Signals(Shown, Labelled):
    """A recording in physical units on one uniform time grid, with every repair and calibration listed.

    In a gap the signals are straight lines: nothing may be measured there (``coverage`` says where).
    """

    rate_hz: float
    """Sample rate of the grid [Hz]."""
    start_s: float
    """Time of the first sample, in seconds of the recording."""
    channels: Mapping[str, ChannelSignal]
    """Every channel by its symbol or, of speeds, by the sensor's name: what is excited, speeds in the order of the
    vessel file, the other channels."""
    working_point: WorkingPoint
    """Steady state for normalisation."""
    calibration: SetPointCalibration
    """Set-point line before the DC scale."""
    dc_scale: float
    """Factor on ``n_set - n_0`` that makes ``n / n_set`` go to 1 at low frequency."""
    dc_scale_std: float
    """Standard deviation of the DC scale."""
    strips: tuple[StripAngles, ...]
    """Strip angles of the multi-pulse channels."""
    step_delays: tuple[StepDelay, ...]
    """Delay of each step of the staircases."""
    repairs: tuple[Repair, ...]
    """What was repaired, in order of time."""
    legs: tuple[LegState, ...] = ()
    """Working point of each leg that the recording holds, in order of time."""
    read_hz: float | None = None
    """Samples a second at which the first speed was read [Hz]; None where that is not known."""
    set_point_delay: SetPointDelay | None = None
    """How late the demand is behind the set point, where it was logged beside it."""
    orders: tuple[TrackedOrder, ...] = ()
    """What comes back in the torque with the turns of engine, shaft and propeller."""
    gaps: tuple[Gap, ...] = ()
    """Where set point, torque, a speed or the ship's log say nothing, in order of time."""
    mode: Literal["shaftprint", "thesis"]
    """Whether each step was done shaftprint's way or the thesis' way."""
    findings: tuple[str, ...] = ()
    """What the reader should know before trusting the signals, one sentence each."""
    reasons: tuple[Reason, ...] = ()
    """What speaks against numbers that are made of these signals; each is a finding too."""
    recording_sha256: str
    """SHA-256 of the raw file."""
    recording_name: str
    """File name of the raw recording."""

    def summary(self) -> Summary:
        """Return length, channels, working point and how much was repaired."""
        point = self.working_point
        facts = {
            "length": f"{self.samples / self.rate_hz:,.1f} s at {self.rate_hz:g} Hz from {self.start_s:g} s",
            "channels": shortened(self.channels),
            "working point": f"{rpm_from_rev_s(point.engine_speed_rev_s):.1f} rpm, {point.shaft_torque_nm:.0f} N m",
            "repairs": f"{len(self.repairs)}, gaps {len(self.gaps)}",
            "prepared": f"{self.mode} mode",
            "findings": str(len(self.findings)),
        }
        return Summary(title=f"Signals of {self.recording_name}", facts=facts)

    def labelled(self) -> LabelledData:
        """Return the channels over time; messages, which have a clock of their own, over theirs."""
        grid_s = self.start_s + np.arange(self.samples) / self.rate_hz
        variables, coordinates = {}, {"time_s": Variable(dims=("time_s",), values=grid_s, unit="s", meaning="time")}
        for name, one in self.channels.items():
            clock = "time_s"
            if isinstance(one, MessageSignal):
                clock = f"time_of_{name}_s"
                coordinates[clock] = Variable(dims=(clock,), values=one.time_s, unit="s", meaning=f"time of {name}")
            unit, meaning = _UNITS.get(name, ("rev/s", "speed") if isinstance(one, SpeedSignal) else ("", name))
            variables[name] = Variable(
                dims=(clock,), values=one.values, unit=unit, meaning=f"{meaning}, channel {one.channel}"
            )
        attributes = {"recording": self.recording_name, "sha256": self.recording_sha256, "mode": self.mode}
        return LabelledData(rows=("time_s",), variables=variables, coordinates=coordinates, attributes=attributes)

    @property
    def excitations(self) -> Mapping[str, ExcitationSignal]:
        """Every channel that a test may move, by its symbol; the set point of the speed is the first."""
        return {name: one for name, one in self.channels.items() if isinstance(one, ExcitationSignal)}

    @property
    def messages(self) -> Mapping[str, MessageSignal]:
        """Every channel on a clock of its own, by its symbol."""
        return {name: one for name, one in self.channels.items() if isinstance(one, MessageSignal)}

    @property
    def speeds(self) -> Mapping[str, SpeedSignal]:
        """Every speed channel by sensor name, in the order of the vessel file; the first is the one identified."""
        return {name: one for name, one in self.channels.items() if isinstance(one, SpeedSignal)}

    @property
    def engine_speed(self) -> SpeedSignal:
        """The speed channel that is identified: the first of the vessel file."""
        return next(iter(self.speeds.values()))

    @property
    def set_point_rev_s(self) -> FloatArray:
        """Engine-speed set point ``n_set`` [rev/s], shape (samples,)."""
        return self.channels["n_set"].values

    @property
    def shaft_torque_nm(self) -> FloatArray:
        """Shaft torque ``M_s`` at the gauge [N m], shape (samples,)."""
        return self.channels["M_s"].values

    def with_channel(self, name: str, **changes: Any) -> "Signals":
        """Return the signals with some fields of one channel changed."""
        return replace(self, channels={**self.channels, name: replace(self.channels[name], **changes)})

    @property
    def levels_rpm(self) -> tuple[float, ...]:
        """Mean engine speed of every steady level and leg [rpm]."""
        of_legs = (leg.working_point.engine_speed_rev_s for leg in self.legs)
        return tuple(rpm_from_rev_s(speed) for speed in (*self.calibration.level_rev_s.tolist(), *of_legs))

    @property
    def coverage(self) -> Coverage:
        """What the signals cover: ask it before a window of the recording is used."""
        return Coverage.of_grid(start_s=self.start_s, samples=self.samples, rate_hz=self.rate_hz, gaps=self.gaps)

    def about(self, leg: str) -> "Signals":
        """Return the signals with the working point of one leg as what everything is divided by.

        Channels on clocks of their own that do not cover the leg are left out. The scale of the set point
        carries no deviation: what its line is off, it is off at all lines of all legs alike, which is a parameter of
        the structures.

        Parameters
        ----------
        leg
            Name of a leg that the recording holds.

        Raises
        ------
        SignalError
            If it holds no such leg.
        """
        states = {state.name: state for state in self.legs}
        if leg not in states:
            raise SignalError(f"leg {leg}: expected one of {', '.join(states) or 'none'}, found no such leg.")
        return replace(
            self,
            working_point=states[leg].working_point,
            channels=channels_about(states[leg], self.channels, rate_hz=self.rate_hz, start_s=self.start_s),
        )

    @property
    def samples(self) -> int:
        """Number of samples of the grid."""
        return self.set_point_rev_s.size
