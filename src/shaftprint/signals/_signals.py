"""The noun of the room: what a prepared recording consists of."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, Literal

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.reasons import Reason
from shaftprint.signals._gaps import Coverage, Gap

# Nearer to half the rate of a sensor's values a sine and its alias are hard to tell apart.
_HIGHEST_SHARE_OF_RATE = 0.45
# Terms of the spline's images fall with the fourth power: the next one is below 1e-7.
_IMAGES = 40


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


@dataclass(frozen=True, kw_only=True, slots=True)
class WorkingPoint:
    """The steady state around which the responses are normalised."""

    engine_speed_rev_s: float
    """Mean engine speed ``n_0`` [rev/s]."""
    shaft_torque_nm: float
    """Shaft torque ``M_s0`` [N m] that the gauge shows at ``n_0`` under the mean load of the recording."""
    engine_speed_std_rev_s: float
    """Standard deviation of ``n_0`` [rev/s]."""
    shaft_torque_std_nm: float
    """Standard deviation of ``M_s0`` [N m], without the gauge's scale error: ``load_std`` and twice that of ``n_0``."""
    set_point_v: float
    """Mean set-point voltage [V] of the stretches that were used."""
    load_std: float
    """Standard deviation of the mean load ``M_s0 / n_0^2`` over its value [-]: the load of a propeller wanders."""


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StripAngles:
    """The angles between the reflection strips of a multi-pulse shaft (thesis eqs 3.3-3.5, table 3.4)."""

    channel: str
    """Name of the pulse channel."""
    angle_rev: FloatArray
    """Angle from each strip to the next [rev], shape (strips,); they sum to 1."""
    std_rev: FloatArray
    """Standard deviation of each angle [rev], shape (strips,)."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StepDelay:
    """Time between the set point and the speed crossing the middle of one step (thesis table 3.3)."""

    staircase: str
    """Name of the staircase."""
    set_point_time_s: float
    """When the set point crosses the middle of the step [s]."""
    speed_time_s: float
    """When the engine speed crosses the middle of the step [s]."""
    rising: bool
    """Whether the step raises the speed."""

    @property
    def delay_s(self) -> float:
        """Level-crossing delay [s]: transport delay, rise time of the loop and sensor delay together."""
        return self.speed_time_s - self.set_point_time_s


class ChannelRole(Enum):
    """What a channel is to a test."""

    EXCITATION = "excitation"
    """What the test moves: the input of a response."""
    RESPONSE = "response"
    """What answers, on the clock of the logger."""
    SIDE = "side signal"
    """What answers too but comes seldom: it may be missing where the others are not."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ChannelSignal:
    """One channel in physical units, with its working point and what its sensor does to a sine.

    It is on the common grid, but for a `MessageSignal`.
    """

    name: str
    """Symbol of the quantity, such as ``M_s``; of a speed its name in the vessel file, such as ``n_e``."""
    channel: str
    """Name of the channel in the recording."""
    role: ChannelRole = ChannelRole.RESPONSE
    """What it is to a test."""
    values: FloatArray
    """Values in the unit of the quantity, known latency taken off, shape (samples,)."""
    reference: float
    """Value at the working point, over which deviations are taken."""
    reference_std: float = 0.0
    """Standard deviation of the value at the working point, without the scale of the sensor."""
    cycle_s: float = 0.0
    """Time from one value to the next, which is how often the quantity is really sampled [s]; 0 at every sample."""
    averaging_s: float = 0.0
    """Length of the window over which a value is a mean [s]; 0 for single values and where it has been removed."""
    hold_s: float = 0.0
    """Time for which a value is held until the next [s]; 0 where values are interpolated."""
    join_s: float = 0.0
    """Length of the straight lines from one value to the next [s]; 0 where values are held."""

    @property
    def is_side(self) -> bool:
        """Whether it comes seldom, so that it may be missing at a line."""
        return self.role is ChannelRole.SIDE

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that the sensor shows without aliasing [Hz]."""
        return 0.5 / self.cycle_s if self.cycle_s else math.inf

    @property
    def highest_hz(self) -> float:
        """Highest frequency at which a sine and its alias are told apart [Hz]."""
        return _HIGHEST_SHARE_OF_RATE / self.cycle_s if self.cycle_s else math.inf

    def gain(self, frequency_hz: float) -> complex:
        """Return what holding, joining and averaging about their own time make of a sine of amplitude 1.

        ``sinc^2`` of the periods in a straight line; ``sinc`` and half the hold late where values are held; ``sinc`` of
        the periods in a mean.
        """
        held = frequency_hz * self.hold_s
        joined = np.sinc(frequency_hz * self.join_s) ** 2 * np.sinc(held) * np.exp(-1j * np.pi * held)
        return complex(joined * np.sinc(frequency_hz * self.averaging_s))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ExcitationSignal(ChannelSignal):
    """What a test moves, such as the set point of the speed."""

    role: ChannelRole = ChannelRole.EXCITATION
    """What it is to a test."""
    input: str = "set_point"
    """Table of the vessel file's sensors, by which a campaign names it."""
    per_volt: float
    """Change of the quantity for one volt of the campaign, in its unit per V."""
    scale_std: float = 0.0
    """Standard deviation of the scale, as a fraction."""
    scale_error: str = "set-point calibration"
    """Name of the error of the scale among the common errors of a response."""
    from_engine: bool = True
    """Whether it acts through the engine, so that behind it torque and speed show load and inertia at the gauge."""
    shown_unit: str = ""
    """Unit in which amplitudes are told to the reader."""
    shown_reference: float = 1.0
    """The working point in that unit."""

    @property
    def words(self) -> str:
        """What it is, in words."""
        return self.input.replace("_", " ")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpeedSignal(ChannelSignal):
    """One speed channel [rev/s], referred to the engine side, with what its sensor does to it.

    A window over which a value is a mean, and a hold, belong to the model of the sensor: they are in no ``gain``.
    """

    pulse_rate_hz: float
    """Mean number of pulses a second: the rate at which the speed is really sampled [Hz]."""
    delay_s: float = 0.0
    """Total delay of the value behind the true speed [s]; 0 where values are stamped at mid-period."""

    @property
    def speed_rev_s(self) -> FloatArray:
        """Engine-side speed [rev/s], shape (samples,)."""
        return self.values

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that this sensor shows without aliasing [Hz]."""
        return self.pulse_rate_hz / 2.0

    def gain(self, frequency_hz: float) -> complex:
        """Return the factor by which the spline through the pulses shows a sine too small.

        A cubic spline through the shaft angles at the pulses, differentiated, shows a sine of ``x`` periods a pulse
        with

        ``sinc(x)^4 / sum_k sinc(x + k)^4``

        (Unser, Aldroubi and Eden, "B-spline signal processing: Part I", IEEE Transactions on Signal Processing 41
        (1993): frequency response of the cardinal cubic spline): 0.996 at a fifth of the pulse rate, 0.963 at three
        tenths, one half at half the pulse rate. It is 1 for a signal that is averaged or held, since that belongs to
        the model of the sensor, and above half the pulse rate, where the signal shows an alias.
        """
        if self.averaging_s > 0.0 or self.hold_s > 0.0 or frequency_hz > self.nyquist_hz:
            return 1.0
        images = np.sinc(frequency_hz / self.pulse_rate_hz + np.arange(-_IMAGES, _IMAGES + 1)) ** 4
        return float(images[_IMAGES] / images.sum())


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MessageSignal(ChannelSignal):
    """A channel on its own clock, such as the fuel rack on the CAN bus: between two messages nothing is known."""

    role: ChannelRole = ChannelRole.SIDE
    """What it is to a test."""
    rate_hz: float
    """Values a second [Hz]."""
    start_s: float
    """Time of the first value, in seconds of the recording; the known latency has been taken off."""
    resolution: float
    """Step of the channel, in the unit of the quantity."""
    gaps: tuple[Gap, ...] = ()
    """Where nothing was available for long, in order of time; straight lines there."""

    @property
    def coverage(self) -> Coverage:
        """Where values were available."""
        return Coverage(gaps=self.gaps)

    @property
    def stop_s(self) -> float:
        """Time after the last value, each counted with its period, in seconds of the recording."""
        return self.start_s + self.values.size / self.rate_hz


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signals:
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
    def coverage(self) -> Coverage:
        """What the signals cover: ask it before a window of the recording is used."""
        stop_s = self.start_s + self.samples / self.rate_hz
        return Coverage(start_s=self.start_s, stop_s=stop_s, step_s=1.0 / self.rate_hz, gaps=self.gaps)

    @property
    def samples(self) -> int:
        """Number of samples of the grid."""
        return self.set_point_rev_s.size
