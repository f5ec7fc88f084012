"""Covariance of a response of which only a standard deviation or a coherence is known."""

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._response_covariance import weight_factor


def circular_covariance(std: ArrayLike) -> FloatArray:
    """Return the covariance of [Re, Im] of a response with known standard deviations.

    The error of each element is taken as circular (real and imaginary part alike, each with half of the variance) and
    as independent of that of every other element.

    Parameters
    ----------
    std
        Standard deviation of the complex response, ``sqrt(E |error|^2)``, in the units of the response, shape
        (outputs, inputs, lines). Where that of the magnitude, or of the real part, is known, give ``sqrt(2)`` times
        that.

    Returns
    -------
    Covariance for ``FrequencyResponse``, shape (lines, 2 outputs inputs, 2 outputs inputs).

    Raises
    ------
    ResponseError
        If the shape is another, or a standard deviation is not positive and finite.
    """
    values = _of_response("std", std)
    if not np.all(np.isfinite(values) & (values > 0.0)):
        raise ResponseError("std: expected positive, finite standard deviations of the complex response.")
    variance = 0.5 * values.reshape(-1, values.shape[2]).T ** 2
    doubled = np.concatenate([variance, variance], axis=1)
    result: FloatArray = doubled[:, :, np.newaxis] * np.eye(doubled.shape[1])
    return result


def coherence_covariance(response: ArrayLike, coherence: ArrayLike, *, averages: float) -> FloatArray:
    """Return the covariance of [Re, Im] of a response of which the coherence with its one input is known.

    With the coherence ``g^2`` of ``n`` independent averages the noise under ``H`` has the variance
    ``|H|^2 (1 - g^2) / (g^2 n)`` (Bendat and Piersol, "Random Data: Analysis and Measurement Procedures", section on
    frequency response estimates, where half of it stands for the magnitude). Here ``n - 2`` stands for ``n``: the
    average itself takes one sample, and one more makes the covariance right as a weight. Errors of different outputs
    are taken as independent. The degrees of freedom of the response are ``2 (n - 1)``.

    Parameters
    ----------
    response
        Response to one input, estimated by cross spectrum over input spectrum, shape (outputs, 1, lines).
    coherence
        Ordinary coherence (squared, between 0 and 1), of the same shape.
    averages
        Number of independent averages; of Welch's method with overlap the equivalent number.

    Returns
    -------
    Covariance for ``FrequencyResponse``, shape (lines, 2 outputs, 2 outputs).

    Raises
    ------
    ResponseError
        If the shapes differ, there are several inputs, a coherence is not between 0 and 1, or there are fewer than 3
        averages.
    """
    values = np.abs(_of_response("response", response))
    square = _of_response("coherence", coherence)
    if values.shape != square.shape or values.shape[1] != 1:
        raise ResponseError(
            f"coherence: expected shape (outputs, 1, lines) as of the response {values.shape}, found {square.shape}; "
            "for several inputs give standard deviations to circular_covariance()."
        )
    if not np.all((square > 0.0) & (square < 1.0)):
        raise ResponseError("coherence: expected values between 0 and 1, borders excluded.")
    if not averages >= 3:
        raise ResponseError(f"averages = {averages}: expected at least 3 independent averages.")
    factor = weight_factor(averages - 1.0, 1) / (averages - 1.0)
    return circular_covariance(values * np.sqrt(factor * (1.0 - square) / square))


def _of_response(name: str, values: ArrayLike) -> FloatArray:
    array = np.asarray(values)
    if array.ndim != 3 or array.size == 0:
        raise ResponseError(f"{name}: expected shape (outputs, inputs, lines), found {array.shape}.")
    return array
