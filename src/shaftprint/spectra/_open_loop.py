"""From the response to the set point to the two open-loop responses, with their covariance."""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._response_covariance import real_jacobian

# Below this many standard deviations the error signal has no known phase, and its reciprocal no known mean.
_LEAST_ERROR_STD = 3.0


def open_loop(
    response: FrequencyResponse, *, set_point_latency_s: float = 0.0
) -> tuple[FrequencyResponse, FrequencyResponse]:
    """Convert responses to the set point into governor with engine ``e -> M_s`` and core ``M_s -> n``.

    With ``G_n = n / n_set``, ``G_M = M_s / n_set`` and ``D = exp(-j w t)``, the error is ``e = D n_set - n`` and

    ``M_s / e = G_M / (D - G_n)``,  ``n / M_s = G_n / G_M``.

    The covariance is carried through with the complex derivatives. At low frequency ``e`` is a small difference, so a
    small error of the set-point scale turns ``M_s / e`` far more than ``n / n_set``.

    Parameters
    ----------
    response
        Response from ``n_set`` to ``n`` and ``M_s``.
    set_point_latency_s
        Time ``t`` from the set point to the governor's demand [s], outside the loop.

    Returns
    -------
    Responses ``e -> M_s`` and ``M_s -> n``. Lines whose ``e`` is less than three standard deviations from 0 are
    marked as not used in the first of them.

    Raises
    ------
    ResponseError
        If the response is not from ``n_set`` to ``n`` and ``M_s``, or ``e`` or ``M_s`` is exactly 0 at a line.
    """
    if response.inputs != ("n_set",) or response.outputs != ("n", "M_s"):
        raise ResponseError(
            "Open loop: expected a response from n_set to n and M_s, found "
            f"{', '.join(response.inputs)} to {', '.join(response.outputs)}."
        )
    speed, torque = response.response[:, 0, :]
    error = np.exp(-1j * response.omega_rad_s * set_point_latency_s) - speed
    for name, values in (("e", error), ("M_s", torque)):
        if np.any(values == 0.0):
            line = response.lines[int(np.argmax(values == 0.0))]
            raise ResponseError(f"{line}: expected {name} to differ from 0, found 0: leave the line out.")
    governor = torque / error
    core = speed / torque
    governor_jacobian = np.stack([governor / error, 1.0 / error], axis=-1)
    core_jacobian = np.stack([1.0 / torque, -core / torque], axis=-1)
    error_std = np.sqrt(response.covariance[:, 0, 0] + response.covariance[:, 2, 2])
    lost = np.abs(error) < _LEAST_ERROR_STD * error_std
    return (
        _converted(response, governor, governor_jacobian, names=("e", "M_s"), lost=lost, error=error),
        _converted(response, core, core_jacobian, names=("M_s", "n")),
    )


def _converted(
    response: FrequencyResponse,
    values: ComplexArray,
    jacobian: ComplexArray,
    *,
    names: tuple[str, str],
    lost: BoolArray | None = None,
    error: ComplexArray | None = None,
) -> FrequencyResponse:
    derivative = real_jacobian(jacobian[:, np.newaxis, :])
    covariance: FloatArray = derivative @ response.covariance @ np.swapaxes(derivative, 1, 2)
    remarks = dict(response.remarks)
    used = response.used
    if lost is not None and error is not None:
        used = used & ~lost
        for place in np.flatnonzero(lost):
            name = response.lines[place]
            remark = f"error signal is lost in noise (|e/n_set| = {abs(error[place]):.2g})"
            remarks[name] = "; ".join(filter(None, (remarks.get(name, ""), remark)))
    return replace(
        response,
        inputs=names[:1],
        outputs=names[1:],
        response=values[np.newaxis, np.newaxis, :],
        covariance=0.5 * (covariance + np.swapaxes(covariance, 1, 2)),
        used=used,
        remarks=remarks,
    )
