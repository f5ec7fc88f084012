"""A response of one test in which further inputs of what answered were measured too."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import ComplexArray
from shaftprint.spectra._conversion import converted
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._response_covariance import weight_change


def with_measured_inputs(
    response: FrequencyResponse, *, outputs: Sequence[str], measured: Sequence[str], gains: ComplexArray
) -> FrequencyResponse:
    """Return the response of some outputs with the noise that their model has from inputs that were measured.

    Of ``y = H_1 u + H_2 x`` with a measured ``x`` the residual ``y / u - H_1 - H_2 (x / u)`` has the noise of ``y``
    and, through ``H_2``, that of ``x``: with the covariance ``C`` of ``[x, y] / u`` it is ``J C J^H``,
    ``J = [-H_2, 1]``.

    ``response``: response from ``u`` to ``x`` and ``y``. ``outputs``, ``measured``: names of ``y`` and ``x``, both
    outputs of the response. ``gains``: ``H_2``, shape (outputs, measured, lines). Returns the response from ``u`` to
    ``y`` with the covariance of the residual.
    """
    both = response.of_outputs(*measured, *outputs)
    lines = len(both.lines)
    jacobian = np.zeros((lines, len(outputs), len(measured) + len(outputs)), dtype=np.complex128)
    jacobian[:, :, : len(measured)] = -np.moveaxis(gains, -1, 0)
    jacobian[:, :, len(measured) :] = np.eye(len(outputs))
    residual = converted(both, both.response[len(measured) :], jacobian, inputs=both.inputs, outputs=tuple(outputs))
    change = weight_change(both.degrees_of_freedom, len(measured) + len(outputs), len(outputs))
    return replace(
        residual,
        covariance=change[:, np.newaxis, np.newaxis] * residual.covariance,
        common={name: np.sqrt(change) * part for name, part in residual.common.items()},
    )
