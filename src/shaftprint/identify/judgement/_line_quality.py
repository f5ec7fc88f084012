"""Which lines of a response say something, and where a gap is between them."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.likelihood._experiment import Experiment
from shaftprint.identify.likelihood._tails import excess_freedom

if TYPE_CHECKING:
    from shaftprint.spectra._frequency_response import FrequencyResponse
    from shaftprint.spectra.lines._signal_to_noise import SignalToNoise


def good_channels(
    experiment: Experiment, signal_to_noise: "SignalToNoise | None", requirements: Requirements
) -> BoolArray:
    """Return which channels of which fitted lines are known well enough to say something, shape (channels, lines).

    ``signal_to_noise``: local signal-to-noise ratios of the recording; the lines are found by name.
    """
    good = _relative_std(experiment.noise_covariance, experiment.measured) <= requirements.largest_line_std
    if signal_to_noise is None:
        return good
    names = [name for name, fitted in zip(experiment.response.lines, experiment.fitted, strict=True) if fitted]
    return _above_noise(good, names, experiment.response.inputs, signal_to_noise, requirements)


def good_lines(
    response: "FrequencyResponse", signal_to_noise: "SignalToNoise", requirements: Requirements | None = None
) -> BoolArray:
    """Return which lines of a response a fit would call good, before anything is fitted, shape (lines,).

    ``response``: a response to one input. ``signal_to_noise``: local signal-to-noise ratios of its recording.
    ``requirements``: what a good line is.
    """
    asked = requirements or Requirements()
    size, freedom = response.covariance.shape[1], response.degrees_of_freedom
    exact = np.isinf(freedom)
    share = np.where(exact, 1.0, excess_freedom(freedom, size) / np.where(exact, 1.0, freedom))
    measured = response.response.reshape(-1, len(response.lines))
    good = _relative_std(share[:, None, None] * response.covariance, measured) <= asked.largest_line_std
    good = _above_noise(good, response.lines, response.inputs, signal_to_noise, asked)
    found: BoolArray = np.any(good, axis=0) & response.used
    return found


def _above_noise(
    good: BoolArray,
    names: Sequence[str],
    moved: Sequence[str],
    signal_to_noise: "SignalToNoise",
    requirements: Requirements,
) -> BoolArray:
    """Return the good channels of lines without those of lines that drown in noise, shape (channels, lines)."""
    limit = requirements.lowest_line_snr_db
    inputs = [i for i, channel in enumerate(signal_to_noise.channels) if channel in moved]
    for line, name in enumerate(names):
        if name not in signal_to_noise.lines:
            continue
        ratios = signal_to_noise.local_db[signal_to_noise.lines.index(name)]
        if np.any(ratios[inputs] < limit) or np.all(np.delete(ratios, inputs) < limit):
            good[:, line] = False
    return good


def _relative_std(covariance: FloatArray, measured: ComplexArray) -> FloatArray:
    """Return the standard deviation of each channel over its size, shape (channels, lines)."""
    variance = np.diagonal(covariance, axis1=1, axis2=2).T
    half = variance.shape[0] // 2
    with np.errstate(divide="ignore"):
        return np.asarray(np.sqrt(variance[:half] + variance[half:]) / np.abs(measured))


def crossings_rad_s(identification: Identification) -> tuple[float, ...]:
    """Return where the loop gain passes 1 in size or -1 in phase: what happens there decides on stability."""
    margins = identification.margins
    if margins is None:
        return ()
    crossings = (margins.phase_margin_rad_s, margins.gain_margin_rad_s)
    return tuple(omega for omega in crossings if np.isfinite(omega))


def gap_at_crossing(
    identification: Identification, omega: FloatArray, requirements: Requirements
) -> tuple[float, float] | None:
    """Return the frequencies [rad/s] between which no good line shows a crossing of the loop gain; None where none are.

    ``omega``: frequencies of the good lines of all responses [rad/s], in order, shape (lines,).
    """
    for crossing in crossings_rad_s(identification):
        above = int(np.searchsorted(omega, crossing))
        if 0 < above < omega.size and omega[above] > requirements.largest_spacing * omega[above - 1]:
            return float(omega[above - 1]), float(omega[above])
    return None
