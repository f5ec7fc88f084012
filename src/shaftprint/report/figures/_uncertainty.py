"""Uncertainty of a measured response as the reader of a Bode diagram sees it: decibel and degree.

The covariance of [Re, Im] of a line is turned into the direction of the response and across it.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import deviations
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.spectra._frequency_response import FrequencyResponse

COVERAGE = 0.95


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MeasuredPoints:
    """One channel of a measured response with 95 % intervals."""

    magnitude_db: FloatArray
    """Magnitude [dB], shape (lines,)."""
    phase_deg: FloatArray
    """Phase in (-180, 180] [deg], shape (lines,)."""
    below_db: FloatArray
    """Length of the error bar downwards [dB], shape (lines,); infinite where the interval reaches 0."""
    above_db: FloatArray
    """Length of the error bar upwards [dB], shape (lines,)."""
    phase_half_deg: FloatArray
    """Half length of the phase's error bar [deg], shape (lines,); 180 where nothing is known of it."""
    radial_std: FloatArray
    """Standard deviation along the response over its size [-], shape (lines,)."""


def measured_points(response: "FrequencyResponse", channel: int) -> MeasuredPoints:
    """Return magnitude and phase of one response with 95 % intervals (Student's t for the measured covariance).

    The interval of the magnitude is ``|H| -/+ t s`` along the response, that of the phase ``asin(t s / |H|)`` with the
    standard deviation ``s`` across it: both stay right where noise is as large as the response.
    """
    values: ComplexArray = response.response.reshape(len(response.outputs) * len(response.inputs), -1)[channel]
    size = np.abs(values)
    factor = _quantile(response.degrees_of_freedom)
    radial_std, turning_std = (std / size for std in stds_along_and_across(response, channel, values))
    radial, turning = factor * radial_std, factor * turning_std
    with np.errstate(divide="ignore"):
        below = -decibel(np.maximum(1.0 - radial, 0.0))
    return MeasuredPoints(
        magnitude_db=decibel(size),
        phase_deg=np.degrees(np.angle(values)),
        below_db=below,
        above_db=decibel(1.0 + radial),
        phase_half_deg=np.where(turning < 1.0, np.degrees(np.arcsin(np.minimum(turning, 1.0))), 180.0),
        radial_std=radial_std,
    )


def stds_along_and_across(
    response: "FrequencyResponse", channel: int, direction: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """Return the standard deviations of one response along and across a direction, each of shape (lines,).

    ``direction``: complex numbers of any size that point there, shape (lines,).
    """
    count = len(response.outputs) * len(response.inputs)
    pair = [channel, count + channel]
    covariance = response.covariance[:, pair][:, :, pair]
    along = np.stack([direction.real, direction.imag], axis=-1) / np.abs(direction)[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    first, second = (np.sqrt(np.einsum("li,lij,lj->l", way, covariance, way)) for way in (along, across))
    return first, second


def _quantile(degrees_of_freedom: FloatArray) -> FloatArray:
    different, places = np.unique(np.maximum(degrees_of_freedom, 1.0), return_inverse=True)
    return np.array([deviations(COVERAGE, float(freedom)) for freedom in different])[places]
