"""The working point of a leg and the line of the set point through several, from whole periods alone.

Over whole periods the mean speed is that of the mean set point, since the governor integrates its error, and nothing
has to stand still: ``n_0`` is the mean speed and ``M_0`` the torque at ``n_0`` of a propeller whose torque goes with
the square of the speed (``normalisation.mean_load``). The load of the leg is 1 by definition. Several levels give the
line from volts to speed; a single leg gives it by its slow lines, at which the speed follows the set point.

The standard deviation of the mean speed is that of the coefficients beside it: below the first line there is nothing
but noise. That of the mean load is found through its wander, which grows towards zero: of one that takes 10 to 100 s
the coefficients beside zero told a third in legs of five minutes. The wander is one process in all legs of a test: two
legs of 128 s tell of one with 60 to 100 s what the first alone does not, its deviation 2.4 times too small.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.normalisation import mean_load, propeller_torque
from shaftprint.signals._signals import SetPointCalibration
from shaftprint.signals._working_points import LegState, WorkingPoint
from shaftprint.signals.levels._dc_scale import LowLines, zero_frequency_ratio
from shaftprint.signals.levels._leg_periods import LegPeriods, between_lines
from shaftprint.signals.levels._steady import SteadyStretch
from shaftprint.signals.levels._wander import fit_through_wander
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._leg import Leg

# Means nearer to each other than this are one level [V].
_SAME_LEVEL_V = 0.05
# At lines whose speed departs further from the set point the low-order form does not hold; up to here it errs by 2e-3
# (see _dc_scale.py), which the structures find as the scale of the set point.
_LARGEST_DEPARTURE, _MOST_LINES, _FEWEST_LINES = 0.4, 9, 3
_LEAST_STD = 2e-3
# Means of the load are this long [s], and shorter where there would be fewer.
_BLOCK_S, _FEWEST_BLOCKS = 10.0, 12
# Deviation of a slope that rests on lines at which the speed departs further: of three lines in 300 drawn loops, at
# periods of 25 to 45 s.
_ROUGH_STD = 0.02
# The same of the slowest line alone, at which the speed may lag already.
_LAGGING_STD = 0.05


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegSamples:
    """Set point, speed and torque in the whole periods of one leg."""

    leg: "Leg"
    """The leg."""
    periods: LegPeriods
    """Its periods."""
    set_point_v: FloatArray
    """Set point [V], shape (samples,)."""
    speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (samples,)."""
    torque_nm: FloatArray
    """Shaft torque [N m], shape (samples,)."""


def leg_states(legs: Sequence[LegSamples]) -> tuple[LegState, ...]:
    """Return the working point of each leg of a test.

    ``legs``: whole periods of each. Raises SignalError if the shaft stands still or turns back.
    """
    if not legs:
        return ()
    means = [_mean_of(samples) for samples in legs]
    return tuple(_state_of(mean, float(std)) for mean, std in zip(means, _std_of_loads(means), strict=True))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Mean:
    """Means of a leg, and what goes with the square of its speed."""

    samples: LegSamples
    speed_rev_s: float
    square: FloatArray
    torque_nm: float

    @property
    def load(self) -> FloatArray:
        """Torque over that of the mean load, shape (samples,)."""
        return self.samples.torque_nm / (self.torque_nm * self.square)


def _mean_of(samples: LegSamples) -> _Mean:
    _expect_ahead(samples)
    periods = samples.periods
    speed = float(samples.speed_rev_s.mean())
    square = (samples.speed_rev_s / speed) ** 2
    of_propeller, _ = propeller_torque(
        samples.speed_rev_s / speed,
        samples.torque_nm,
        harmonics=samples.leg.lines,
        periods=periods.periods,
        period_s=periods.period_s,
    )
    torque = mean_load(of_propeller, square, duration_s=periods.duration_s)
    return _Mean(samples=samples, speed_rev_s=speed, square=square, torque_nm=torque)


def _state_of(mean: _Mean, load_std: float) -> LegState:
    samples, periods = mean.samples, mean.samples.periods
    speed_std = _std_of_mean(samples.speed_rev_s, periods.periods)
    relative_std = float(np.hypot(load_std, 2.0 * speed_std / mean.speed_rev_s))
    point = WorkingPoint(
        engine_speed_rev_s=mean.speed_rev_s,
        shaft_torque_nm=mean.torque_nm,
        engine_speed_std_rev_s=speed_std,
        shaft_torque_std_nm=abs(mean.torque_nm) * relative_std,
        set_point_v=float(samples.set_point_v.mean()),
        load_std=load_std,
        zero_share=mean_load(np.ones_like(mean.square), mean.square, duration_s=periods.duration_s),
    )
    return LegState(
        name=samples.leg.name,
        start_s=periods.start_s,
        period_s=periods.period_s,
        periods=periods.periods,
        working_point=point,
    )


def _expect_ahead(samples: LegSamples) -> None:
    if samples.speed_rev_s.min() > 0.0:
        return
    periods = samples.periods
    where = int(np.argmin(samples.speed_rev_s)) / samples.speed_rev_s.size
    raise SignalError(
        f"{samples.leg.name}: expected a shaft that turns ahead throughout, found "
        f"{rpm_from_rev_s(float(samples.speed_rev_s.min())):.0f} rpm at "
        f"{periods.start_s + where * periods.duration_s:.1f} s: no test goes "
        "through standstill; check the speed channel, or leave this leg out of the campaign file."
    )


def stretch_of(state: LegState) -> SteadyStretch:
    """Return a leg as a stretch of time whose means are those of its working point, for channels that need one."""
    point = state.working_point
    return SteadyStretch(
        start_s=state.start_s,
        stop_s=state.stop_s,
        set_point_v=point.set_point_v,
        speed_rev_s=point.engine_speed_rev_s,
        speed_std_rev_s=point.engine_speed_std_rev_s,
        torque_nm=point.shaft_torque_nm,
        torque_std_nm=point.shaft_torque_std_nm,
    )


def calibration_of_legs(legs: Sequence[LegSamples], states: Sequence[LegState], *, channel: str) -> SetPointCalibration:
    """Return the line from volts to speed: through the levels of the legs, or of one level by its slow lines.

    ``legs``, ``states``: samples and working point of each leg. ``channel``: name of the set-point channel, for
    messages. Raises SignalError if the speed does not follow the set point.
    """
    volts = np.array([state.working_point.set_point_v for state in states])
    speed = np.array([state.working_point.engine_speed_rev_s for state in states])
    std = np.array([state.working_point.engine_speed_std_rev_s for state in states])
    order = np.argsort(volts)
    if np.ptp(volts) > _SAME_LEVEL_V:
        weight = 1.0 / np.maximum(std, 1e-9 * speed)
        columns = weight[:, np.newaxis] * np.column_stack([volts, np.ones(volts.size)])
        (slope, intercept), *_ = np.linalg.lstsq(columns, weight * speed, rcond=None)
        covariance = np.linalg.inv(columns.T @ columns)
    else:
        slope, slope_std = _slope_of_slow_lines(legs[0], channel)
        intercept = float(np.mean(speed - slope * volts))
        # the mean is known apart from the slope
        about = float(volts.mean())
        covariance = slope_std**2 * np.array([[1.0, -about], [-about, about**2]])
        covariance[1, 1] += float(np.mean(std**2))
    if not slope:
        raise SignalError(f"channel {channel}: expected the speed to follow the set point, found the same at all legs.")
    return SetPointCalibration(
        slope_rev_s_per_v=float(slope),
        intercept_rev_s=float(intercept),
        covariance=frozen_float(covariance),
        level_v=frozen_float(volts[order]),
        level_rev_s=frozen_float(speed[order]),
        level_std_rev_s=frozen_float(std[order]),
    )


def _std_of_mean(values: FloatArray, periods: int) -> float:
    return float(np.sqrt(np.mean(np.abs(between_lines(values, periods)) ** 2)))


def _std_of_loads(legs: Sequence[_Mean]) -> FloatArray:
    """Return how far the mean load of each leg may be from that of the ship, from what its periods do not repeat.

    Shape of the result (legs,). One wander goes through all legs, and each has a mean of its own.
    """
    means, start_s, stop_s = [], [], []
    for leg in legs:
        load, periods = leg.load, leg.samples.periods
        count = max(round(periods.duration_s / _BLOCK_S), _FEWEST_BLOCKS)
        borders = np.round(np.arange(count + 1) * load.size / count).astype(np.int64)
        means.append(np.add.reduceat(_wander(load, periods.periods), borders[:-1]) / np.diff(borders))
        border_s = periods.start_s + borders * (periods.duration_s / load.size)
        start_s.append(border_s[:-1])
        stop_s.append(border_s[1:])
    of_legs = np.repeat(np.eye(len(legs)), [part.size for part in means], axis=0)
    return fit_through_wander(np.concatenate(means), of_legs, np.concatenate(start_s), np.concatenate(stop_s)).std


def _wander(load: FloatArray, periods: int) -> FloatArray:
    """Return what the periods of a load do not repeat; the coefficients at lines are as large as those beside them."""
    spectrum = np.fft.rfft(load)
    spectrum[periods::periods] = 0.0
    return np.asarray(np.fft.irfft(spectrum, load.size) * np.sqrt(periods / (periods - 1.0)))


def _slope_of_slow_lines(samples: LegSamples, channel: str) -> tuple[float, float]:
    """Return slope and deviation [rev/s per V] at zero frequency, from the lines at which the speed follows."""
    periods, harmonics = samples.periods, list(samples.leg.lines)[:_MOST_LINES]
    volts, speed = (
        _amplitudes(values, periods.periods, harmonics) for values in (samples.set_point_v, samples.speed_rev_s)
    )
    power = np.sum(np.abs(volts) ** 2, axis=1)
    if not np.all(power > 0.0):
        raise SignalError(
            f"channel {channel}: expected a set point that moves in {samples.leg.name}, found one that stands still."
        )
    ratio = np.sum(volts.conj() * speed, axis=1) / power
    rough = float(ratio[0].real)
    if rough == 0.0:
        raise SignalError(
            f"channel {channel}: expected the speed to follow the set point in {samples.leg.name}, found no motion."
        )
    residual = np.sum(np.abs(speed - ratio[:, np.newaxis] * volts) ** 2, axis=1)
    std = np.sqrt(residual / (2.0 * (periods.periods - 1)) / power) / abs(rough)
    follows = np.abs(ratio / rough - 1.0) <= _LARGEST_DEPARTURE
    following = int(np.argmin(follows)) if not follows.all() else follows.size
    if follows.size < _FEWEST_LINES:
        return rough, _LAGGING_STD * abs(rough)
    count = max(following, _FEWEST_LINES)
    lines = LowLines(
        omega_rad_s=2.0 * np.pi * np.array(harmonics[:count]) / periods.period_s,
        ratio=ratio[:count] / rough,
        std=np.maximum(std[:count], 1e-7),
    )
    value, value_std = zero_frequency_ratio(lines)
    least = _LEAST_STD if following >= _FEWEST_LINES else _ROUGH_STD
    return rough * value, abs(rough) * float(np.hypot(value_std, least))


def _amplitudes(
    values: FloatArray, periods: int, harmonics: Sequence[int]
) -> "np.ndarray[tuple[int, int], np.dtype[np.complex128]]":
    """Return the complex amplitude of lines in each period, shape (lines, periods)."""
    borders = np.round(np.arange(periods + 1) * values.size / periods).astype(int)
    turns = 2j * np.pi * periods * np.arange(values.size) / values.size
    centred = values - values.mean()
    return np.array(
        [
            np.add.reduceat(centred * np.exp(-harmonic * turns), borders[:-1]) * (2.0 * periods / values.size)
            for harmonic in harmonics
        ]
    )
