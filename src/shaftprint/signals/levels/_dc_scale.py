"""The scale of the set point that makes the speed follow it exactly at low frequency.

The governor integrates the error, therefore ``n / n_set`` goes to 1 as the frequency goes to 0. The error
is a small difference of large numbers there: half a per cent of scale turns it by twenty degrees at the
lowest sine of the thesis. The ratio at the low lines is carried to zero frequency by
``(a_0 + a_1 s) / (1 + b_1 s + b_2 s^2)``, the form of a PI-governed shaft; a straight ``a + b omega^2``
would be 0.1 % off at the thesis' lines because the loop has a pole near 0.6 rad/s.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import ComplexArray, FloatArray, in_blocks
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Sine
from shaftprint.digits import stated
from shaftprint.signals._gaps import EVERYTHING, Coverage
from shaftprint.signals._signals import SetPointCalibration

# Lines whose ratio is further from 1 are beyond the reach of the low-order form: up to here the delays
# of the reference ship turn into an error of 2e-4, up to 0.3 into 1e-3.
_LARGEST_DEPARTURE = 0.2
_MOST_LINES = 9
FEWEST_LINES = 3
"""So many slow sines know the scale of the set point."""

# The scatter of a line with few periods is drawn towards that of all lines, as with so many more.
_PRIOR_DEGREES = 4.0
_LEAST_VARIANCE = 1e-14
_ROUNDS = 30

# Orders of the sine that the propeller law makes: the fundamental and what its square and cube give.
_ORDERS = (1, 2, 3)
_BLOCKS_A_PERIOD = 100.0


@dataclass(frozen=True, kw_only=True, slots=True)
class DcScale:
    """The factor on the deviation of the set point."""

    value: float
    """The factor."""
    std: float
    """Its standard deviation."""
    findings: tuple[str, ...]
    """What the reader should know about it."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LowLines:
    """Ratio of speed to set point at the lines of lowest frequency."""

    omega_rad_s: FloatArray
    """Frequency [rad/s], ascending, shape (lines,)."""
    ratio: ComplexArray
    """Speed over set point [-], shape (lines,)."""
    std: FloatArray
    """Standard deviation of real and of imaginary part [-], shape (lines,)."""


def dc_scale(
    set_point_rev_s: FloatArray,
    speed_rev_s: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    slope_std: float,
    coverage: Coverage = EVERYTHING,
) -> DcScale:
    """Return the factor on the set point, from the low lines and the steady levels together.

    Both are estimates of the same scale: the line through the steady levels says 1 with the relative
    standard deviation of its slope, the low lines say ``n / n_set`` at zero frequency. They are weighted
    by their variances; where they contradict each other the lines decide, and a finding says so.

    Parameters
    ----------
    set_point_rev_s, speed_rev_s
        Set point after the line and speed [rev/s] on the grid, shape (samples,).
    campaign
        Says where the sines are.
    rate_hz, start_s
        The grid.
    slope_std
        Standard deviation of the slope of the line over its slope.
    coverage
        Says where the gaps are.
    """
    lines = low_lines(set_point_rev_s, speed_rev_s, campaign, rate_hz=rate_hz, start_s=start_s, coverage=coverage)
    if lines.omega_rad_s.size < FEWEST_LINES:
        return DcScale(
            value=1.0,
            std=slope_std,
            findings=(
                f"the scale of the set point rests on the steady levels alone: expected at least "
                f"{FEWEST_LINES} slow sines with two periods or more to check it, found "
                f"{lines.omega_rad_s.size}",
            ),
        )
    value, std = zero_frequency_ratio(lines)
    if abs(value - 1.0) > 4.0 * np.hypot(std, slope_std):
        return DcScale(
            value=value,
            std=std,
            findings=(
                f"the slow sines ask for a set-point scale of {stated(value, std, '-')} where the "
                f"steady levels say {stated(1.0, slope_std, '-')}; the sines were followed",
            ),
        )
    weights = np.array([1.0 / std**2, 1.0 / slope_std**2])
    return DcScale(
        value=float(weights @ [value, 1.0] / weights.sum()),
        std=float(1.0 / np.sqrt(weights.sum())),
        findings=(),
    )


def scale_of_sines(calibration: SetPointCalibration) -> DcScale:
    """Return the factor where the line is from the slow sines already: 1, with the deviation of its slope."""
    std = float(calibration.covariance[0, 0]) ** 0.5 / abs(calibration.slope_rev_s_per_v)
    finding = "the line of the set point rests on the slow sines: the set point stood at one level only"
    return DcScale(value=1.0, std=std, findings=(finding,))


def low_lines(
    set_point_rev_s: FloatArray,
    speed_rev_s: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> LowLines:
    """Return the ratio of speed to set point at the slow sines, from the lowest on while it is near 1."""
    omega, ratio, variance, length_s, periods = [], [], [], [], []
    for sine in sorted(campaign.sines, key=lambda sine: sine.frequency_hz)[:_MOST_LINES]:
        if sine.periods < 2 or sine.settled_s < start_s or coverage.missing(sine.settled_s, sine.window_stop_s):
            continue
        pair = [period_amplitudes(values, sine, rate_hz, start_s) for values in (set_point_rev_s, speed_rev_s)]
        set_point_power = float(np.sum(np.abs(pair[0]) ** 2))
        response = complex(np.vdot(pair[0], pair[1])) / set_point_power
        if abs(response - 1.0) > _LARGEST_DEPARTURE:
            break
        residual_power = float(np.sum(np.abs(pair[1] - response * pair[0]) ** 2))
        omega.append(2.0 * np.pi * sine.frequency_hz)
        ratio.append(response)
        # of one component; each period gives two
        variance.append(residual_power / (2.0 * (sine.periods - 1)) / set_point_power)
        length_s.append(sine.window_s)
        periods.append(sine.periods)
    return LowLines(
        omega_rad_s=np.array(omega),
        ratio=np.array(ratio, dtype=np.complex128),
        std=np.sqrt(_shrunk(np.array(variance), np.array(length_s), np.array(periods))),
    )


def zero_frequency_ratio(lines: LowLines) -> tuple[float, float]:
    """Return the ratio at zero frequency and its standard deviation, by weighted least squares.

    The equations are made linear by the denominator of the round before (Sanathanan and Koerner,
    "Transfer function synthesis as a ratio of two complex polynomials", 1963).
    """
    s = 1j * lines.omega_rad_s
    ones = np.ones_like(s)
    denominator = ones
    coefficients = np.zeros(4)
    for _ in range(_ROUNDS):
        columns = np.stack([ones, s, -s * lines.ratio, -(s**2) * lines.ratio], axis=1)
        weight = 1.0 / (lines.std * np.abs(denominator))
        matrix, right = _real(columns * weight[:, np.newaxis]), _real(lines.ratio * weight)
        coefficients[:] = np.linalg.lstsq(matrix, right, rcond=None)[0]
        denominator = 1.0 + coefficients[2] * s + coefficients[3] * s**2
    numerator = coefficients[0] + coefficients[1] * s
    tangents = [ones, s, -s * numerator / denominator, -(s**2) * numerator / denominator]
    jacobian = _real(np.stack(tangents, axis=1) / (denominator * lines.std)[:, np.newaxis])
    residual = _real((lines.ratio - numerator / denominator) / lines.std)
    covariance = np.linalg.pinv(jacobian.T @ jacobian)
    freedom = residual.size - coefficients.size
    enlarged = max(1.0, float(residual @ residual) / freedom)
    return float(coefficients[0]), float(np.sqrt(covariance[0, 0] * enlarged))


def period_amplitudes(values: FloatArray, sine: Sine, rate_hz: float, start_s: float) -> ComplexArray:
    """Return the complex amplitude in each whole period.

    Offset, drift and harmonics are those of the whole window, fitted together. A drift
    for each period would not do: within one period drift and harmonics look alike, and either the second
    harmonic of the propeller law changes the ratio by 5e-4, or the scatter doubles.
    """
    # means of blocks: what they take from the sine they take from set point and speed alike
    length = max(int(rate_hz / (_BLOCKS_A_PERIOD * sine.frequency_hz)), 1)
    first, stop = (math.ceil((instant - start_s) * rate_hz - 1e-9) for instant in (sine.settled_s, sine.window_stop_s))
    part = in_blocks(values[first:stop], length).mean(axis=1)
    time = start_s + (first + length * np.arange(part.size)) / rate_hz - sine.settled_s
    phase = 2.0 * np.pi * sine.frequency_hz * time
    waves = [wave(order * phase) for order in _ORDERS for wave in (np.cos, np.sin)]
    design = np.column_stack([*waves, np.ones(time.size), time])
    fitted = np.linalg.solve(design.T @ design, design.T @ part)
    detrended = part - design[:, 2:] @ fitted[2:]
    borders = np.searchsorted(time, np.arange(sine.periods + 1) / sine.frequency_hz - 1e-9)
    amplitudes = np.empty(sine.periods, dtype=np.complex128)
    for k in range(sine.periods):
        inside = slice(borders[k], borders[k + 1])
        pair = design[inside, :2]
        cosine, sinus = np.linalg.solve(pair.T @ pair, pair.T @ detrended[inside])
        amplitudes[k] = cosine - 1j * sinus
    return amplitudes


def _shrunk(variance: FloatArray, length_s: FloatArray, periods: FloatArray) -> FloatArray:
    """Return the variances drawn towards a noise that is the same for all lines but for their length."""
    if variance.size == 0:
        return variance
    freedom = 2.0 * (periods - 1.0)
    common = float(np.median(variance * length_s)) / length_s
    shrunk = freedom * variance + _PRIOR_DEGREES * common
    # less two: a variance from few degrees of freedom is as often too small as too large
    return np.maximum(shrunk / (freedom + _PRIOR_DEGREES - 2.0), _LEAST_VARIANCE)


def _real(values: NDArray[Any]) -> FloatArray:
    """Return real and imaginary parts one below the other."""
    return np.concatenate([values.real, values.imag])
