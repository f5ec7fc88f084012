"""Channels in physical units over time: what a test moves, speeds, what answers, and what comes as messages."""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals._gaps import Coverage, Gap

HIGHEST_SHARE_OF_RATE = 0.45
"""Frequency over the rate of a sensor's values nearer to half of which a sine and its alias are hard to tell apart."""
# Terms of the spline's images fall with the fourth power: the next one is below 1e-7.
_IMAGES = 40


def spline_gain(frequency_hz: float, rate_hz: float) -> float:
    """Return what a cubic spline through values of a sine of amplitude 1 shows of it.

    A sine of ``x`` periods a value becomes ``sinc(x)^4 / sum_k sinc(x + k)^4`` (Unser, Aldroubi and Eden, "B-spline
    signal processing: Part I", IEEE Transactions on Signal Processing 41 (1993): frequency response of the cardinal
    cubic spline).

    ``frequency_hz``: frequency of the sine [Hz]. ``rate_hz``: values a second [Hz].
    """
    images = np.sinc(frequency_hz / rate_hz + np.arange(-_IMAGES, _IMAGES + 1)) ** 4
    return float(images[_IMAGES] / images.sum())


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
    moved_by: str = ""
    """Symbol of the one excitation that moves it, such as ``theta_set``; empty where every test may."""
    cycle_s: float = 0.0
    """Time from one value to the next, which is how often the quantity is really sampled [s]; 0 at every sample."""
    averaging_s: float = 0.0
    """Length of the window over which a value is a mean [s]; 0 for single values and where it has been removed."""
    hold_s: float = 0.0
    """Time for which a value is held until the next [s]; 0 where values are interpolated."""
    join_s: float = 0.0
    """Length of the straight lines from one value to the next [s]; 0 where values are held."""
    value_rate_hz: float = math.inf
    """Values a second that a spline joins [Hz]; infinite where the logger samples as fast as the signals."""

    @property
    def is_side(self) -> bool:
        """Whether it comes seldom, so that it may be missing at a line."""
        return self.role is ChannelRole.SIDE

    def answers(self, excitation: str) -> bool:
        """Return whether it may move when an excitation, by its symbol, is moved."""
        return self.moved_by in ("", excitation)

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that the sensor shows without aliasing [Hz]."""
        return 0.5 * min(self.value_rate_hz, 1.0 / self.cycle_s if self.cycle_s else math.inf)

    @property
    def highest_hz(self) -> float:
        """Highest frequency at which a sine and its alias are told apart [Hz]."""
        return HIGHEST_SHARE_OF_RATE / self.cycle_s if self.cycle_s else math.inf

    def gain(self, frequency_hz: float) -> complex:
        """Return what holding, joining and averaging about their own time make of a sine of amplitude 1.

        ``sinc^2`` of the periods in a straight line, that of a spline where it joins the values; ``sinc`` and half the
        hold late where values are held; ``sinc`` of the periods in a mean.
        """
        held = frequency_hz * self.hold_s
        joined = np.sinc(frequency_hz * self.join_s) ** 2 * np.sinc(held) * np.exp(-1j * np.pi * held)
        return complex(joined * np.sinc(frequency_hz * self.averaging_s) * self._splined(frequency_hz))

    def _splined(self, frequency_hz: float) -> float:
        """Return what a spline through the values shows of a sine of amplitude 1; 1 of an alias."""
        if math.isinf(self.value_rate_hz) or frequency_hz > self.nyquist_hz:
            return 1.0
        return spline_gain(frequency_hz, self.value_rate_hz)


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
    share: float | None = None
    """Of the torque of an electric machine, its mean at the working point over the shaft torque."""
    is_obeyed: bool = False
    """Whether the governor holds each value until the next."""

    def gain(self, frequency_hz: float) -> complex:
        """Return what the spline through the values shows of what the governor follows.

        That is the values themselves, or each held until the next: ``sinc`` and half of that time later.
        """
        held = frequency_hz / self.value_rate_hz if self.is_obeyed and frequency_hz <= self.nyquist_hz else 0.0
        return complex(self._splined(frequency_hz) / (np.sinc(held) * np.exp(-1j * np.pi * held)))

    @property
    def is_reached(self) -> bool:
        """Whether it shows what was reached and not what was asked for, as a converter does that follows with a lag."""
        return self.share is not None

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
    """Mean number of pulses a second, or of an instrument's values: the rate at which the speed is really sampled [Hz].
    """
    by_angle: bool = True
    """Whether that rate goes with the speed, as that of pulses does and that of an instrument does not."""
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

        A cubic spline through the shaft angles at the pulses, differentiated, has the gain of `spline_gain`: 0.996 at a
        fifth of the pulse rate, 0.963 at three tenths, one half at half the pulse rate. It is 1 for a signal that is
        averaged or held, since that belongs to the model of the sensor, and above half the pulse rate, where the signal
        shows an alias.
        """
        if self.averaging_s > 0.0 or self.hold_s > 0.0 or frequency_hz > self.nyquist_hz:
            return 1.0
        return spline_gain(frequency_hz, self.pulse_rate_hz)


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
    times: FloatArray | None = None
    """Time of each value [s], the known latency taken off, shape (samples,); None where rate and start say it."""

    @property
    def coverage(self) -> Coverage:
        """Where values were available."""
        return Coverage(gaps=self.gaps)

    @property
    def stop_s(self) -> float:
        """Time after the last value, each counted with its period, in seconds of the recording."""
        if self.times is not None:
            return float(self.times[-1]) + 1.0 / self.rate_hz
        return self.start_s + self.values.size / self.rate_hz

    @property
    def time_s(self) -> FloatArray:
        """Time of each value, in seconds of the recording, shape (samples,)."""
        if self.times is not None:
            return self.times
        return self.start_s + np.arange(self.values.size) / self.rate_hz
