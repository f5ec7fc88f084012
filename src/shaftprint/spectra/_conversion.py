"""From one response to another that follows from it line by line, with its covariance."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._response_covariance import real_jacobian


def converted(
    response: FrequencyResponse,
    values: ComplexArray,
    jacobian: ComplexArray,
    *,
    inputs: tuple[str, ...],
    outputs: tuple[str, ...],
) -> FrequencyResponse:
    """Return a response computed from another.

    ``response``: the response that was measured. ``values``: the response that follows from it, shape (outputs, inputs,
    lines). ``jacobian``: its complex derivatives to the elements of the first, shape (lines, outputs inputs, elements
    of the first). ``inputs``, ``outputs``: names of its inputs and outputs. Returns the response with the covariance
    carried through to first order; everything else is as before.
    """
    derivative = real_jacobian(jacobian)
    lines = len(response.lines)
    common = {
        name: np.einsum("lij,jl->il", jacobian, part.reshape(-1, lines)).reshape(values.shape)
        for name, part in response.common.items()
    }
    covariance: FloatArray = derivative @ response.covariance @ np.swapaxes(derivative, 1, 2)
    return replace(
        response,
        inputs=inputs,
        outputs=outputs,
        response=values,
        covariance=0.5 * (covariance + np.swapaxes(covariance, 1, 2)),
        common=common,
    )


def without_lines(response: FrequencyResponse, lost: Mapping[int, str]) -> FrequencyResponse:
    """Mark lines as not used.

    ``lost``: why a line is not used, by its place. Returns the response; a remark that a line has already is kept
    before the new one.
    """
    used, remarks = response.used.copy(), dict(response.remarks)
    for index, remark in lost.items():
        line = response.lines[index]
        used[index] = False
        remarks[line] = "; ".join(filter(None, (remarks.get(line, ""), remark)))
    return replace(response, used=used, remarks=remarks)
