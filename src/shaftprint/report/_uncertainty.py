"""Uncertainty of a complex response as the reader of a Bode diagram sees it: decibel and degree.

For a model ``H(theta)`` the exact derivatives give ``d ln H = (dH / d theta) / H``: the real part is the relative
change of the magnitude, the imaginary part the change of the phase [rad]. With the covariance ``C`` of the free
parameters (delta method)

    var(ln |H|) = Re(d ln H) C Re(d ln H)^T,     var(arg H) = Im(d ln H) C Im(d ln H)^T.

For measured lines the covariance of [Re, Im] is turned into the direction of the response and across it.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import stdtrit

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.normal import NORMAL_95
from shaftprint.units import decibel

if TYPE_CHECKING:
    from shaftprint.models import Structure
    from shaftprint.spectra import FrequencyResponse

DECIBEL_PER_NEPER = 20.0 / np.log(10.0)
COVERAGE = 0.95


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Band:
    """Half widths of a 95 % band around a model's response."""

    magnitude_db: FloatArray
    """Half width of the magnitude [dB], shape (outputs, frequencies); nan where it is not known."""
    phase_deg: FloatArray
    """Half width of the phase [deg], shape (outputs, frequencies); nan where it is not known."""


def model_band(structure: "Structure", values: FloatArray, covariance: FloatArray, omega_rad_s: FloatArray) -> Band:
    """Return the 95 % band of a model from the covariance of its free parameters.

    Parameters
    ----------
    structure
        The structure.
    values
        All parameters, shape (parameters,).
    covariance
        Covariance of the free parameters, shape (free, free).
    omega_rad_s
        Frequencies [rad/s], shape (frequencies,).

    Returns
    -------
        Half widths; nan at frequencies where a parameter with infinite variance has an influence.
    """
    response, slopes = structure.gradient(values, 1j * omega_rad_s)
    relative = slopes / response
    known = np.isfinite(np.diag(covariance))
    inner = covariance[np.ix_(known, known)]
    lost = np.any(relative[~known] != 0.0, axis=0)
    half = []
    for part in (relative.real, relative.imag):
        variance = np.einsum("iow,ij,jow->ow", part[known], inner, part[known])
        half.append(NORMAL_95 * np.sqrt(np.where(lost, np.nan, np.maximum(variance, 0.0))))
    return Band(magnitude_db=DECIBEL_PER_NEPER * half[0], phase_deg=np.degrees(half[1]))


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


def measured_points(response: "FrequencyResponse", channel: int) -> MeasuredPoints:
    """Return magnitude and phase of one response with 95 % intervals (Student's t for the measured covariance).

    The interval of the magnitude is ``|H| -/+ t s`` along the response, that of the phase ``asin(t s / |H|)`` with the
    standard deviation ``s`` across it: both stay right where noise is as large as the response.
    """
    count = len(response.outputs) * len(response.inputs)
    values: ComplexArray = response.response.reshape(count, -1)[channel]
    pair = [channel, count + channel]
    covariance = response.covariance[:, pair][:, :, pair]
    size = np.abs(values)
    along = np.stack([values.real, values.imag], axis=-1) / size[:, None]
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    factor = _quantile(response.degrees_of_freedom)
    radial = factor * np.sqrt(np.einsum("li,lij,lj->l", along, covariance, along)) / size
    turning = factor * np.sqrt(np.einsum("li,lij,lj->l", across, covariance, across)) / size
    with np.errstate(divide="ignore"):
        below = -decibel(np.maximum(1.0 - radial, 0.0))
    return MeasuredPoints(
        magnitude_db=decibel(size),
        phase_deg=np.degrees(np.angle(values)),
        below_db=below,
        above_db=decibel(1.0 + radial),
        phase_half_deg=np.where(turning < 1.0, np.degrees(np.arcsin(np.minimum(turning, 1.0))), 180.0),
    )


def _quantile(degrees_of_freedom: FloatArray) -> FloatArray:
    finite = np.isfinite(degrees_of_freedom)
    safe = np.where(finite, np.maximum(degrees_of_freedom, 1.0), 1.0)
    return np.where(finite, stdtrit(safe, 0.5 + COVERAGE / 2.0), NORMAL_95)
