"""Covariance of the noise under a line, from what the window shows beside the line.

The error of a fitted amplitude is the noise's own Fourier amplitude at the line. Two views on it are combined.

*Neighbouring bins.* The residual's Fourier amplitudes at the bins on both sides. Ship noise falls steeply with
frequency (slow changes of the propeller load), so that under a line of a few periods the plain mean of the
neighbours can be four times too large. Each channel's local slope ``S ~ f^-a`` is therefore found first (Whittle
likelihood with weights that fall with the distance in bins and in octaves, and a weak prior on ``a``), the
neighbours are brought to the line with it, and then averaged as a matrix, so that correlation between channels stays.

*Scatter between periods.* Amplitudes of single periods, or of stretches of several periods where there are many,
scatter about the amplitude of the whole window. A rectangular stretch sees noise over a wider band; the ratio that
follows from the slope is divided out.

Before, the sidebands are taken out that a slowly changing propeller load makes of the line itself: they are strong
beside the line and not under it. On the simulated tug they would make the standard deviations of the torque near
1 rad/s up to twice too large.

Both see the same record, so degrees of freedom are not added: the larger number holds for their weighted mean.
Tests compare the stated covariance with the scatter over repeated simulated windows, for white and ``1/f^2``
noise, correlated outputs and four periods.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra._line_fit import LineFit, WindowSamples

# Twice the reach halves the variance of the estimate, but smears humps such as the surge against the mooring, which
# is four bins wide in a window of the thesis.
_REACH_BINS = 10
_REACH_RATIO = 3.5
_LEAST_REACH_BINS = 8
_SLOPE_PRIOR = 1.0
_SLOPE_PRIOR_STD = 2.0
_SLOPE_LIMITS = (-2.0, 5.0)
_FEWEST_STRETCHES = 6
_STRETCHES = 6


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineNoise:
    """Covariance of the complex amplitudes of all channels at one frequency."""

    covariance: ComplexArray
    """``E[a a^H]`` of the noise amplitudes, Hermitian, shape (channels, channels)."""
    complex_samples: float
    """Number of independent complex samples behind it: half the real degrees of freedom."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Neighbours:
    """Bins beside a line with their weights."""

    bins: FloatArray
    """Where they stand: number in the window, or frequency [Hz], shape (bins,)."""
    log_ratio: FloatArray
    """Logarithm of their frequency over that of the line, shape (bins,)."""
    weight: FloatArray
    """Their weights, 1 at the line, shape (bins,)."""


def residual_spectrum(fit: LineFit) -> ComplexArray:
    """Return the residual's Fourier amplitudes, ``2/N`` times the DFT, shape (channels, bins)."""
    spectrum: ComplexArray = np.fft.rfft(fit.residual, axis=1)
    spectrum *= 2.0 / fit.residual.shape[1]
    return spectrum


def stretch_periods(periods: int) -> int:
    """Return the number of periods in one stretch of a window of so many periods."""
    return max(1, periods // _STRETCHES)


def stretch_amplitudes(fit: LineFit) -> ComplexArray:
    """Return the amplitude that the residual adds in each stretch of whole periods.

    Parameters
    ----------
    fit
        The fitted window of ``P`` periods.

    Returns
    -------
    Complex amplitudes, shape (channels, stretches): one stretch a period below 12 periods, then 6 to 8 stretches
    of equally many periods; the periods left over at the end are not used.
    """
    wave = np.exp(-2j * np.pi * fit.samples.window.frequency_hz * fit.samples.time_s)
    amplitudes: ComplexArray = _stretch_means(fit.samples, fit.residual * wave)
    amplitudes *= 2.0
    return amplitudes


def without_modulation(
    spectrum: ComplexArray, stretches: ComplexArray, samples: WindowSamples
) -> tuple[ComplexArray, ComplexArray]:
    """Take out of the residual what a slowly changing propeller load makes of the line itself.

    A load ``1 + delta(t)`` scales the torque of the sine, so that every slow component of the load comes back on
    both sides of the line. It does not belong to the noise under the line: its mean is the load of the window.
    Bin ``k`` of the torque is seen at ``i + k`` and, conjugated, at ``i - k``, with one complex factor a channel, found
    by least squares.

    Parameters
    ----------
    spectrum
        Fourier amplitudes of the residual, shape (channels, bins).
    stretches
        Amplitudes of the residual in stretches of whole periods, shape (channels, stretches).
    samples
        Channels of the window; the last is the torque.

    Returns
    -------
    Spectrum and stretches without modulation; unchanged where slow bins and neighbours overlap.
    """
    periods, torque = samples.window.periods, samples.values[-1:]
    if periods <= 2 * _REACH_BINS or periods + _REACH_BINS >= spectrum.shape[1]:
        return spectrum, stretches
    slow = np.fft.rfft(torque[0])[1 : _REACH_BINS + 1] * (2.0 / torque.size)
    pattern = np.concatenate([slow[::-1].conj(), [0.0], slow])
    beside = slice(periods - _REACH_BINS, periods + _REACH_BINS + 1)
    power = max(np.vdot(pattern, pattern).real, np.finfo(np.float64).tiny)
    factor = (spectrum[:, beside] @ pattern.conj() / power)[:, np.newaxis]
    cleaned = spectrum.copy()
    cleaned[:, beside] -= factor * pattern
    # bin k of the load makes two sidebands of the same size, a real modulation of twice that size
    load = _stretch_means(samples, torque - torque.mean())
    return cleaned, stretches - 2.0 * factor * load


def line_noise(spectrum: ComplexArray, stretches: ComplexArray, *, periods: int, order: int = 1) -> LineNoise:
    """Estimate the covariance of the noise under a line or under one of its harmonics.

    Parameters
    ----------
    spectrum
        Fourier amplitudes of the residual, shape (channels, bins).
    stretches
        Amplitudes of the residual in stretches of whole periods, shape (channels, stretches); used for the
        fundamental only.
    periods
        Number of periods in the window.
    order
        1 for the line itself, 2 and 3 for its harmonics.

    Returns
    -------
    The covariance with the number of complex samples behind it.
    """
    neighbours = _neighbours(spectrum.shape[1], periods, order)
    chosen = spectrum[:, neighbours.bins.astype(np.int64)]
    slope = local_slope(np.abs(chosen) ** 2, neighbours)
    levelled = chosen * np.exp(0.5 * slope[:, np.newaxis] * neighbours.log_ratio)
    # what the drift in the fit takes from the neighbours, it adds to the uncertainty of the line
    kept = _kept_by_drift(neighbours.bins) * _kept_by_drift(np.array([float(order * periods)]))
    weight = neighbours.weight / neighbours.weight.sum() / kept
    covariance = (levelled * weight) @ levelled.conj().T
    samples = equivalent_samples(neighbours)
    count = stretches.shape[1]
    if order > 1 or count < _FEWEST_STRETCHES:
        return LineNoise(covariance=covariance, complex_samples=samples)
    length = stretch_periods(periods)
    scatter = stretches @ stretches.conj().T * (length / periods / (count - 1))
    width = np.sqrt(_stretch_gain(slope, periods, length))
    scatter /= width[:, np.newaxis] * width
    share = samples / (samples + count - 1)
    return LineNoise(
        covariance=share * covariance + (1.0 - share) * scatter,
        complex_samples=max(samples, count - 1.0),
    )


def _neighbours(bins: int, periods: int, order: int) -> Neighbours:
    line = periods * order
    reach_ratio = max(_REACH_RATIO, (line + _LEAST_REACH_BINS) / line)
    lowest = max(line - _REACH_BINS, int(np.ceil(line / reach_ratio)), 1)
    # the drift in the fit has taken most of the power of the first bin
    lowest = 2 if lowest == 1 and line > 3 else lowest
    highest = min(line + _REACH_BINS, int(line * reach_ratio), bins - 1)
    place = np.arange(lowest, highest + 1)
    place = place[place % periods != 0].astype(np.float64)
    log_ratio = np.log(place / line)
    octaves = 1.0 - (log_ratio / np.log(1.05 * reach_ratio)) ** 2
    distance = 1.0 - ((place - line) / (_REACH_BINS + 1.0)) ** 2
    return Neighbours(bins=place, log_ratio=log_ratio, weight=octaves * distance)


def _kept_by_drift(place: FloatArray) -> FloatArray:
    """Share of the power of bin ``m`` that is not explained by a straight line and a parabola.

    The straight line takes ``6 / (pi m)^2`` of the power of the bin's sine part, the parabola ``90 / (pi m)^4`` of its
    cosine part: squared Fourier coefficients of the first two Legendre polynomials.
    """
    kept: FloatArray = 1.0 - 3.0 / (np.pi * place) ** 2 - 45.0 / (np.pi * place) ** 4
    return kept


def local_slope(power: FloatArray, neighbours: Neighbours) -> FloatArray:
    """Find the exponent ``a`` of ``S ~ f^-a`` of each channel: Newton steps on a convex profile likelihood.

    Parameters
    ----------
    power
        Squared magnitudes at the bins, shape (channels, bins).
    neighbours
        The bins.

    Returns
    -------
    The exponents, shape (channels,); without contrast between the bins about 1.
    """
    weight, log_ratio = neighbours.weight, neighbours.log_ratio
    total = weight.sum()
    relative = power / np.maximum(power.mean(axis=1, keepdims=True), np.finfo(np.float64).tiny)
    slope = np.full(len(power), _SLOPE_PRIOR)
    for _ in range(12):
        share = weight * relative * np.exp(slope[:, np.newaxis] * log_ratio) + 1e-300
        share /= share.sum(axis=1, keepdims=True)
        centre = share @ log_ratio
        spread = share @ log_ratio**2 - centre**2
        gradient = total * centre - weight @ log_ratio + (slope - _SLOPE_PRIOR) / _SLOPE_PRIOR_STD**2
        step = gradient / (total * spread + 1.0 / _SLOPE_PRIOR_STD**2)
        slope = np.clip(slope - np.clip(step, -1.0, 1.0), *_SLOPE_LIMITS)
    return slope


def equivalent_samples(neighbours: Neighbours) -> float:
    """Return the equivalent number of bins: variance of the level, with the part that the unknown slope adds."""
    weight, log_ratio = neighbours.weight, neighbours.log_ratio
    total = weight.sum()
    centre = (weight @ log_ratio) / total
    deviation = log_ratio - centre
    information = weight @ deviation**2 + 1.0 / _SLOPE_PRIOR_STD**2
    slope_variance = (weight**2 @ deviation**2) / information**2
    return float(1.0 / ((weight @ weight) / total**2 + centre**2 * slope_variance))


def _stretch_means(samples: WindowSamples, values: NDArray[Any]) -> NDArray[Any]:
    """Mean of each row over each stretch."""
    length = stretch_periods(samples.window.periods)
    count = samples.window.periods // length
    border_s = np.arange(count + 1) * length / samples.window.frequency_hz
    border = np.searchsorted(samples.time_s, border_s - 1e-9)
    means: NDArray[Any] = np.add.reduceat(values[:, : border[-1]], border[:-1], axis=1) / np.diff(border)
    return means


def _stretch_gain(slope: FloatArray, periods: int, length: int) -> FloatArray:
    """Mean power that stretches see, over the power at the line, for each slope."""
    place = np.arange(1.0, periods + 6.0 * periods / length)
    place = place[place != periods]
    below = np.sinc((place - periods) * length / periods) ** 2
    above = np.sinc((place + periods) * length / periods) ** 2
    weight = below + above
    relative = _kept_by_drift(place) * (place / periods) ** -slope[:, np.newaxis]
    gain: FloatArray = (relative @ weight) / weight.sum()
    return gain
