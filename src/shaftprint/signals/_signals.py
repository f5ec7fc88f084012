"""The noun of the room: what a prepared recording consists of."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from shaftprint.arrays import FloatArray
from shaftprint.reasons import Reason
from shaftprint.signals._gaps import Coverage, Gap


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


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SpeedSignal:
    """One speed channel, referred to the engine side, on the common grid, with what its sensor does to it."""

    name: str
    """Name of the sensor in the vessel file, such as ``n_e``."""
    channel: str
    """Name of the channel in the recording."""
    speed_rev_s: FloatArray
    """Engine-side speed [rev/s], shape (samples,)."""
    pulse_rate_hz: float
    """Mean number of pulses a second: the rate at which the speed is really sampled [Hz]."""
    averaging_s: float
    """Length of the window over which the value is a mean [s]; 0 where the averaging has been removed."""
    hold_s: float
    """Time for which a value is held until the next [s]; 0 where values are interpolated."""
    delay_s: float
    """Total delay of the value behind the true speed [s]; 0 where values are stamped at mid-period."""

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that this sensor shows without aliasing [Hz]."""
        return self.pulse_rate_hz / 2.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RackSignal:
    """Fuel rack that the governor gives, from the percent torque on the CAN bus, on the channel's own clock.

    It is not on the common grid: between two messages nothing is known.
    """

    channel: str
    """Name of the channel in the recording."""
    fraction: FloatArray
    """Fuel rack ``X`` [fraction]: 1 gives rated torque at rated speed; shape (values,)."""
    rate_hz: float
    """Values a second [Hz]."""
    start_s: float
    """Time of the first value, in seconds of the recording; the known latency has been taken off."""
    resolution: float
    """Step of the channel [fraction]."""
    cycle_s: float
    """Time from one message to the next [s]: how often the rack is really sampled."""
    averaging_s: float
    """Length of the window over which a value is a mean, about its own time [s]; 0 for single samples."""
    hold_s: float
    """Time for which a message is held until the next [s]; 0 where every value is a message."""
    working_point: float
    """Mean rack ``X_0`` of the steady state for normalisation [fraction]."""
    working_point_std: float
    """Standard deviation of ``X_0`` [fraction]; it holds the steps of the channel."""
    gaps: tuple[Gap, ...] = ()
    """Where no torque was available for long, in order of time; straight lines there."""

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that the messages show without aliasing [Hz]."""
        return 0.5 / self.cycle_s

    @property
    def coverage(self) -> Coverage:
        """Where torque was available."""
        return Coverage(gaps=self.gaps)

    @property
    def stop_s(self) -> float:
        """Time after the last value, each counted with its period, in seconds of the recording."""
        return self.start_s + self.fraction.size / self.rate_hz


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ShipSpeedSignal:
    """Speed of the ship from its log, on the common grid."""

    channel: str
    """Name of the channel in the recording."""
    speed_m_s: FloatArray
    """Speed [m/s], shape (samples,); the known latency has been taken off."""
    cycle_s: float
    """Time from one value of the log to the next [s]."""
    hold_s: float
    """Time for which a value is held until the next [s]; 0 where straight lines join them."""
    join_s: float
    """Length of the straight lines from one value to the next [s]; 0 where values are held."""
    working_point_m_s: float
    """Mean speed ``v_0`` of the steady state for normalisation [m/s]."""
    working_point_std_m_s: float
    """Standard deviation of ``v_0`` [m/s]: scatter between steady stretches, without the error of the log itself."""

    @property
    def nyquist_hz(self) -> float:
        """Highest frequency that the log shows without aliasing [Hz]."""
        return 0.5 / self.cycle_s


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Signals:
    """A recording in physical units on one uniform time grid, with every repair and calibration listed.

    In a gap the signals are straight lines: nothing may be measured there (``coverage`` says where).
    """

    rate_hz: float
    """Sample rate of the grid [Hz]."""
    start_s: float
    """Time of the first sample, in seconds of the recording."""
    set_point_rev_s: FloatArray
    """Engine-speed set point ``n_set`` [rev/s], shape (samples,)."""
    shaft_torque_nm: FloatArray
    """Shaft torque ``M_s`` at the gauge [N m], shape (samples,)."""
    speeds: Mapping[str, SpeedSignal]
    """Every speed channel by sensor name, in the order of the vessel file; the first is the one that is identified."""
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
    set_point_channel: str = ""
    """Name of the set-point channel in the recording."""
    rack: RackSignal | None = None
    """Fuel rack, where the vessel file names the percent torque of the engine's control unit."""
    ship_speed: ShipSpeedSignal | None = None
    """Speed of the ship, where the vessel file names a log and the ship had way on."""

    @property
    def engine_speed(self) -> SpeedSignal:
        """The speed channel that is identified: the first of the vessel file."""
        return next(iter(self.speeds.values()))

    @property
    def coverage(self) -> Coverage:
        """What the signals cover: ask it before a window of the recording is used."""
        stop_s = self.start_s + self.samples / self.rate_hz
        return Coverage(start_s=self.start_s, stop_s=stop_s, step_s=1.0 / self.rate_hz, gaps=self.gaps)

    @property
    def samples(self) -> int:
        """Number of samples of the grid."""
        return self.set_point_rev_s.size
