"""The delay that is left between model and data: where their cross-correlation is largest, with its deviation.

``y(t) = a + b f(t - d)`` is fitted by least squares with offset ``a`` and gain ``b`` free, which is the same as the
largest correlation coefficient; ``d`` is positive where the data come later. It is not bound to the samples: the model
is a cubic between two samples, its slopes of fourth order in the step, and ``d`` is found by Gauss-Newton steps from
the best whole sample. With noise of covariance ``R`` the estimate has the covariance
``(X^T X)^-1 X^T R X (X^T X)^-1``, ``X`` being the columns 1, ``f`` and its slope.
"""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.transforms import smallest_quick_length
from shaftprint.validation.measures._noise_pieces import quadratic_form

LONGEST_S = 1.0
_STEPS = 30
# A hundredth of a microsecond: no delay is known to a microsecond.
_SMALL_S = 1e-8


@dataclass(frozen=True, kw_only=True, slots=True)
class RemainingDelay:
    """Delay of the data behind the model in one output; not a number where the two do not go together."""

    output: str
    """Name of the output."""
    delay_s: float
    """Delay [s], positive where the data come later than the model."""
    noise_std_s: float
    """Its standard deviation by the noise of the data [s]."""
    model_std_s: float
    """Its standard deviation by the uncertainty of the model [s]."""

    @property
    def std_s(self) -> float:
        """Standard deviation by both [s]."""
        return float(np.hypot(self.noise_std_s, self.model_std_s))


def remaining_delay(
    output: str,
    measured: FloatArray,
    model: FloatArray,
    slopes: FloatArray,
    covariance: FloatArray,
    autocovariance: FloatArray,
    *,
    rate_hz: float,
    margin: int,
) -> RemainingDelay:
    """Return the delay of the data behind the model.

    ``output``: name of the output. ``measured``: data, shape (samples,). ``model``, ``slopes``: model and its
    derivatives, with ``margin`` samples more at either end, shapes (samples + 2 margin,) and (free, samples + 2
    margin). ``covariance``: covariance of the free parameters, shape (free, free). ``autocovariance``: autocovariance
    of the noise from lag 0 on, shape (lags,). ``rate_hz``: sample rate [Hz]. ``margin``: samples by which the model
    goes beyond the data at either end: the longest delay that is looked for.
    """
    unknown = RemainingDelay(output=output, delay_s=np.nan, noise_std_s=np.nan, model_std_s=np.nan)
    if margin < 1:
        return unknown
    pieces = _pieces(model, rate_hz)
    delay = _best_sample(measured, model, margin) / rate_hz
    longest = (margin - 1) / rate_hz
    for _ in range(_STEPS):
        columns = _columns(pieces, margin - delay * rate_hz, measured.size, rate_hz)
        offset_gain_slope = np.linalg.lstsq(columns, measured, rcond=None)[0]
        gain = float(offset_gain_slope[1])
        if not gain > 0.0:
            return unknown
        change = -float(offset_gain_slope[2]) / gain
        delay += change
        if not abs(delay) < longest:
            return unknown
        if abs(change) < _SMALL_S:
            break
    columns = _columns(pieces, margin - delay * rate_hz, measured.size, rate_hz)
    inverse = np.linalg.pinv(columns.T @ columns)
    row = inverse[2] @ columns.T
    by_parameter = slopes[:, margin : margin + measured.size] @ row
    return RemainingDelay(
        output=output,
        delay_s=delay,
        noise_std_s=float(np.sqrt(max(quadratic_form(row, autocovariance), 0.0))) / gain,
        model_std_s=float(np.sqrt(max(by_parameter @ covariance @ by_parameter, 0.0))),
    )


def _pieces(values: FloatArray, rate_hz: float) -> FloatArray:
    """Return the coefficients of the cubics between samples, the cubic ones first, shape (4, samples - 1)."""
    slope = np.gradient(values, 1.0 / rate_hz)
    slope[2:-2] = rate_hz * (8.0 * (values[3:-1] - values[1:-3]) - (values[4:] - values[:-4])) / 12.0
    mean = np.diff(values) * rate_hz
    before, behind = slope[:-1], slope[1:]
    cubic, square = (before + behind - 2.0 * mean) * rate_hz**2, (3.0 * mean - 2.0 * before - behind) * rate_hz
    return np.stack([cubic, square, before, values[:-1]])


def _columns(pieces: FloatArray, position: float, samples: int, rate_hz: float) -> FloatArray:
    """Return 1, the cubics and their slope from a position on, which need not be a whole sample.

    ``pieces``: coefficients between the samples, the cubic ones first, shape (4, pieces). ``position``: where the
    first value is taken [samples]. ``samples``: how many values are taken. ``rate_hz``: sample rate [Hz].
    """
    # at a whole sample the end of the piece before it, so that the last sample has a piece
    first = max(int(np.ceil(position)) - 1, 0)
    # all values lie equally far behind the sample before them
    behind_s = (position - first) / rate_hz
    cubic, square, slope, level = pieces[:, first : first + samples]
    value = ((cubic * behind_s + square) * behind_s + slope) * behind_s + level
    return np.column_stack([np.ones(samples), value, (3.0 * cubic * behind_s + 2.0 * square) * behind_s + slope])


def _best_sample(measured: FloatArray, model: FloatArray, margin: int) -> int:
    """Return the whole number of samples by which the data come later, at the largest correlation coefficient."""
    samples = measured.size
    size = smallest_quick_length(model.size + samples)
    centred = measured - measured.mean()
    spectrum = np.fft.rfft(centred, size).conj() * np.fft.rfft(model, size)
    products = np.fft.irfft(spectrum, size)[: 2 * margin + 1]
    sums = np.concatenate([[0.0], np.cumsum(model)])
    squares = np.concatenate([[0.0], np.cumsum(model**2)])
    mean = (sums[samples:] - sums[:-samples]) / samples
    variance = (squares[samples:] - squares[:-samples]) / samples - mean**2
    coefficient = products / np.sqrt(np.maximum(variance, np.finfo(np.float64).tiny))
    return margin - int(np.argmax(coefficient))
