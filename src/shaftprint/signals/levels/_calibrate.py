"""The line from set-point voltage to engine speed, through the steady levels (thesis eq. 3.2).

The demand wanders inside the engine's control unit, and the load moves the speed, both as slowly as a level is long:
the line is fitted through a wander of which nothing is known beforehand (``_wander.py``). At the working voltage not
only the levels count: over whole periods of a sine the mean speed is that of the mean voltage, since the governor
integrates its error. The value of the line at the working voltage is the speed of the working point. A lever bends by
some tenths of a per cent a volt: through levels that do not lie evenly about the working voltage a straight line has
another slope than the lever has there. The bend is fitted where there are three levels, with what is known of it
beforehand, and is in the deviation of the slope where there are two. What disturbs the speed goes with the load, hence
with the square of the speed, or is alike at all levels, as a demand that wanders: the levels at the ends, which say how
the line bends, weigh otherwise. Both are fitted, and the line that is known less well is taken.
"""

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._signals import SetPointCalibration
from shaftprint.signals.levels._dc_scale import FEWEST_LINES, low_lines, period_amplitudes, zero_frequency_ratio
from shaftprint.signals.levels._wander import Line, fit_through_wander

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals.levels._steady import SteadyStretch

# Stretches whose voltages are this near to each other, as a share of the range, are one level.
_SAME_LEVEL = 0.02
_SAME_LEVEL_V = 0.05
_LEAST_RELATIVE_STD = 1e-5
_FEWEST_LEVELS, _LEVELS_OF_BEND = 2, 3
# Stretches and sines are cut into windows of this length [s], longer where there would be too many of them and shorter
# where there would be too few.
_WINDOWS_S = (10.0, 5.0, 2.5)
_MOST_WINDOWS, _FEWEST_WINDOWS = 150, 12


def calibrate(stretches: "tuple[SteadyStretch, ...]", *, channel: str) -> SetPointCalibration:
    """Return the line through the steady levels the thesis' way: by least squares, each level counting the same.

    Parameters
    ----------
    stretches
        Where set point and speed stand still.
    channel
        Name of the set-point channel, for messages.

    Raises
    ------
    SignalError
        If there are fewer than two levels.
    """
    volts, speed, deviation = _two_levels(stretches, channel)
    design = np.column_stack([volts, np.ones(volts.size)])
    (slope, intercept), *_ = np.linalg.lstsq(design, speed, rcond=None)
    misfit = float(np.sum((slope * volts + intercept - speed) ** 2))
    variance = misfit / (volts.size - 2) if volts.size > 2 else float(np.mean(deviation**2))
    covariance = variance * np.linalg.inv(design.T @ design)
    return SetPointCalibration(
        slope_rev_s_per_v=float(slope),
        intercept_rev_s=float(intercept),
        covariance=frozen_float(covariance),
        level_v=frozen_float(volts),
        level_rev_s=frozen_float(speed),
        level_std_rev_s=frozen_float(deviation),
    )


def calibrate_through_wander(
    stretches: "tuple[SteadyStretch, ...]",
    campaign: "Campaign",
    *,
    about_v: float,
    set_point_v: FloatArray,
    speed_rev_s: FloatArray,
    rate_hz: float,
    start_s: float,
    channel: str,
    bend_std: float,
    step_v: float = 0.0,
    coverage: Coverage = EVERYTHING,
) -> tuple[SetPointCalibration, float, float]:
    """Return the line through steady levels and sines, its speed at the working voltage and that one's deviation.

    Where the set point stands at one level only, its slope is that with which the speed follows the slow sines.

    ``stretches``: where set point and speed stand still. ``campaign``: says where the sines are. ``about_v``: the
    working voltage [V]. ``set_point_v``, ``speed_rev_s``: set point and speed on the grid, shape (samples,).
    ``rate_hz``, ``start_s``: the grid. ``channel``: name of the set-point channel, for messages. ``bend_std``: standard
    deviation of the share by which the line may be steeper at twice the speed. ``step_v``: step of the set point's
    values [V]: a level is somewhere within one. ``coverage``: says where the gaps are. Raises SignalError if there are
    fewer than two levels, and fewer than three slow sines.
    """
    level_v, level_rev_s, level_std = _levels(stretches)
    by_sines = None
    if level_v.size < _FEWEST_LEVELS:
        grid = {"rate_hz": rate_hz, "start_s": start_s}
        by_sines = _slope_of_sines(set_point_v - about_v, speed_rev_s, campaign, **grid, coverage=coverage)
    if by_sines is None:
        level_v, level_rev_s, level_std = _two_levels(stretches, channel)
    total = sum(stretch.duration_s for stretch in stretches) + sum(sine.window_s for sine in campaign.sines)
    for length_s in (max(_WINDOWS_S[0], total / _MOST_WINDOWS), *_WINDOWS_S[1:]):
        windows = [
            (round((begin - start_s) * rate_hz), round((end - start_s) * rate_hz))
            for begin, end in _windows(stretches, campaign, length_s)
            if not coverage.missing(begin, end)
        ]
        windows = [(first, stop) for first, stop in windows if first >= 0 and stop <= speed_rev_s.size]
        if len(windows) >= _FEWEST_WINDOWS:
            break
    volts, speed = (
        np.array([values[first:stop].mean() for first, stop in windows]) for values in (set_point_v, speed_rev_s)
    )
    begins, ends = np.array(windows).T / rate_hz
    bend = 0.0
    if by_sines is not None:
        at_voltage = fit_through_wander(speed - by_sines[0] * (volts - about_v), np.ones((volts.size, 1)), begins, ends)
        value = np.array([at_voltage.value[0], by_sines[0]])
        covariance = np.diag([at_voltage.std[0], by_sines[1]]) ** 2
    else:
        value, covariance = _bent_line(speed, volts - about_v, begins, ends, levels=level_v.size, bend_std=bend_std)
        bend, bend_std = float(value[2]), float(np.sqrt(covariance[2, 2]))
        value, covariance = value[:2], covariance[:2, :2]
    # from (speed at the working voltage, slope) to (slope, intercept)
    turn = np.array([[0.0, 1.0], [1.0, -about_v]])
    slope, intercept = turn @ value
    apart = np.sum((level_v - level_v.mean()) ** 2)
    spread = np.array([0.0, step_v * slope]) ** 2 / (12.0 * apart) if by_sines is None else np.zeros(2)
    calibration = SetPointCalibration(
        slope_rev_s_per_v=float(slope),
        intercept_rev_s=float(intercept),
        covariance=frozen_float(turn @ (covariance + np.diag(spread)) @ turn.T),
        level_v=frozen_float(level_v),
        level_rev_s=frozen_float(level_rev_s),
        level_std_rev_s=frozen_float(level_std),
        bend=bend,
        bend_std=bend_std,
    )
    return calibration, float(value[0]), float(np.sqrt(covariance[0, 0]))


def _bent_line(
    speed: FloatArray, about_v: FloatArray, begins: FloatArray, ends: FloatArray, *, levels: int, bend_std: float
) -> tuple[FloatArray, FloatArray]:
    """Return speed and slope of the line at the working voltage and its bend, shape (3,), and their covariance.

    ``speed``, ``about_v``: mean speed [rev/s] of each window, and its voltage from the working voltage [V], shape
    (windows,). ``begins``, ``ends``: when the windows begin and end [s]. ``levels``: number of steady levels.
    ``bend_std``: standard deviation of the bend about none, before the test.
    """
    line = np.column_stack([np.ones(speed.size), about_v])
    (middle, slope), *_ = np.linalg.lstsq(line, speed, rcond=None)
    # a slope s (1 + b (n / n_0 - 1)) with n - n_0 = s U
    bent = 0.5 * slope**2 / middle * about_v**2
    if levels >= _LEVELS_OF_BEND and speed.size >= _FEWEST_WINDOWS:
        columns = np.column_stack([line, bent])
        by_load = ((middle + slope * about_v) / middle) ** 2
        fits = [
            _with_bend_known(fit_through_wander(speed / noise, columns / noise[:, None], begins, ends), bend_std)
            for noise in (np.ones_like(speed), by_load)
        ]
        return max(fits, key=lambda fit: float(fit[1][1, 1]))
    straight = fit_through_wander(speed, line, begins, ends)
    turned, *_ = np.linalg.lstsq(line, bent, rcond=None)
    moves = np.append(-turned, 1.0)
    covariance = np.pad(straight.covariance, (0, 1)) + bend_std**2 * np.outer(moves, moves)
    return np.append(straight.value, 0.0), covariance


def _with_bend_known(free: Line, bend_std: float) -> tuple[FloatArray, FloatArray]:
    """Return a line whose bend is fitted, and its covariance, with what is known of the bend beforehand."""
    share = free.covariance[:, 2] / (free.covariance[2, 2] + bend_std**2)
    return free.value - share * free.value[2], free.covariance - np.outer(share, free.covariance[2])


def _slope_of_sines(
    about_v: FloatArray,
    speed_rev_s: FloatArray,
    campaign: "Campaign",
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage,
) -> tuple[float, float] | None:
    """Return the slope of the line [rev/s per V] that makes slow sines of the speed follow, and its deviation.

    Nothing is returned where there are too few slow sines.
    """
    grid = {"rate_hz": rate_hz, "start_s": start_s}
    whole = [
        sine
        for sine in sorted(campaign.sines, key=lambda sine: sine.frequency_hz)
        if sine.settled_s >= start_s and not coverage.missing(sine.settled_s, sine.window_stop_s)
    ]
    if not whole:
        return None
    volts, speed = (period_amplitudes(values, whole[0], **grid) for values in (about_v, speed_rev_s))
    roughly = float(np.vdot(volts, speed).real / np.sum(np.abs(volts) ** 2))
    lines = low_lines(roughly * about_v, speed_rev_s, campaign, **grid, coverage=coverage)
    if roughly == 0.0 or lines.omega_rad_s.size < FEWEST_LINES:
        return None
    ratio, std = zero_frequency_ratio(lines)
    return roughly * ratio, abs(roughly) * std


def _windows(
    stretches: "tuple[SteadyStretch, ...]", campaign: "Campaign", length_s: float
) -> list[tuple[float, float]]:
    """Return begin and end of every window [s], in order: parts of stretches, and whole periods of sines."""
    windows = []
    for stretch in stretches:
        borders = np.linspace(stretch.start_s, stretch.stop_s, max(int(stretch.duration_s / length_s), 1) + 1)
        windows += list(pairwise(borders.tolist()))
    for sine in campaign.sines:
        together = min(max(int(length_s * sine.frequency_hz), 1), sine.periods)
        borders = sine.settled_s + np.arange(0, sine.periods + 1, together) / sine.frequency_hz
        windows += list(pairwise(borders.tolist()))
    return sorted(windows)


def _two_levels(stretches: "tuple[SteadyStretch, ...]", channel: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return voltage, speed and standard deviation of the speed of each level; two at least."""
    volts, speed, deviation = _levels(stretches)
    if volts.size < _FEWEST_LEVELS:
        level_list = ", ".join(f"{level:.3f} V" for level in volts) or "none"
        raise SignalError(
            f"channel {channel}: expected at least two steady levels of the set point to find its "
            f"line, found {level_list}; record a staircase with two or more levels of at least 30 s, or three slow "
            "sines with two periods or more."
        )
    return volts, speed, deviation


def _levels(stretches: "tuple[SteadyStretch, ...]") -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return voltage, speed and standard deviation of the speed of each level, ascending."""
    if not stretches:
        return np.empty(0), np.empty(0), np.empty(0)
    ordered = sorted(stretches, key=lambda stretch: stretch.set_point_v)
    volts = np.array([stretch.set_point_v for stretch in ordered])
    speed = np.array([stretch.speed_rev_s for stretch in ordered])
    deviation = np.array([stretch.speed_std_rev_s for stretch in ordered])
    duration = np.array([stretch.duration_s for stretch in ordered])
    apart = max(_SAME_LEVEL * float(np.ptp(volts)), _SAME_LEVEL_V)
    borders = np.flatnonzero(np.diff(volts) > apart) + 1
    levels = []
    for group in np.split(np.arange(volts.size), borders):
        weight = duration[group] / duration[group].sum()
        mean = float(weight @ speed[group])
        spread = float(np.sqrt(np.sum((weight * deviation[group]) ** 2)))
        if group.size > 1:
            between = float(weight @ (speed[group] - mean) ** 2) / (group.size - 1)
            spread = max(spread, float(np.sqrt(between)))
        levels.append((float(weight @ volts[group]), mean, max(spread, _LEAST_RELATIVE_STD * mean)))
    level_v, level_rev_s, level_std = np.array(levels).T
    return level_v, level_rev_s, level_std
