"""From the response to the set point to the open-loop responses, with their covariance."""

from collections.abc import Mapping

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._conversion import converted, without_lines
from shaftprint.spectra._frequency_response import FrequencyResponse

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
        Response from ``n_set`` to ``n`` and ``M_s``; further outputs are passed over.
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
    outputs = _expected(response, "n", "M_s")
    if response.outputs != ("n", "M_s"):
        response = response.of_outputs("n", "M_s")
    error = np.exp(-1j * response.omega_rad_s * set_point_latency_s) - outputs["n"]
    expect_not_zero(response, "e", error)
    expect_not_zero(response, "M_s", outputs["M_s"])
    governor = outputs["M_s"] / error
    core = outputs["n"] / outputs["M_s"]
    return (
        _without_lost_lines(
            _converted(response, ("e", "M_s"), governor, {"n": governor / error, "M_s": 1.0 / error}), response, error
        ),
        _converted(response, ("M_s", "n"), core, {"n": 1.0 / outputs["M_s"], "M_s": -core / outputs["M_s"]}),
    )


def governor_and_engine(
    response: FrequencyResponse, *, set_point_latency_s: float = 0.0
) -> tuple[FrequencyResponse, FrequencyResponse]:
    """Convert responses to the set point into governor ``e -> X`` and engine with line ``X -> M_s``.

    The fuel rack between the two tells them apart. With ``e`` as in `open_loop`,

    ``X / e = G_X / (D - G_n)``,  ``M_s / X = G_M / G_X``.

    ``response``: response from ``n_set`` to ``n``, ``M_s`` and ``X``. ``set_point_latency_s``: time from the set point
    to the governor's demand [s], outside the loop. Returns responses ``e -> X`` and ``X -> M_s``. Lines whose ``e`` is
    less than three standard deviations from 0 are marked as not used in the first of them, lines at which ``X`` is less
    than three from 0 or was not measured in both. Raises ResponseError if the response is not from ``n_set`` to ``n``,
    ``M_s`` and ``X``, or ``e`` or ``X`` is exactly 0 at a line.
    """
    outputs = _expected(response, "n", "M_s", "X")
    error = np.exp(-1j * response.omega_rad_s * set_point_latency_s) - outputs["n"]
    expect_not_zero(response, "e", error)
    expect_not_zero(response, "X", outputs["X"])
    governor = outputs["X"] / error
    engine = outputs["M_s"] / outputs["X"]
    heard = _without_lost_lines(response, response, outputs["X"], signal="X")
    return (
        _without_lost_lines(
            _converted(heard, ("e", "X"), governor, {"n": governor / error, "X": 1.0 / error}), response, error
        ),
        _converted(heard, ("X", "M_s"), engine, {"M_s": 1.0 / outputs["X"], "X": -engine / outputs["X"]}),
    )


def _expected(response: FrequencyResponse, *names: str) -> dict[str, ComplexArray]:
    """Return the response to each of the outputs, shape (lines,)."""
    if response.inputs != ("n_set",) or not set(names) <= set(response.outputs):
        *first, last = names
        raise ResponseError(
            f"Open loop: expected a response from n_set to {', '.join(first)} and {last}, found "
            f"{', '.join(response.inputs)} to {', '.join(response.outputs)}."
        )
    return {name: response.response[response.outputs.index(name), 0] for name in names}


def expect_not_zero(response: FrequencyResponse, name: str, values: ComplexArray) -> None:
    """Refuse a channel that is 0 at a line: nothing can be divided by it.

    Raises ResponseError if there is such a line.
    """
    if np.any(values == 0.0):
        line = response.lines[int(np.argmax(values == 0.0))]
        raise ResponseError(f"{line}: expected {name} to differ from 0, found 0: leave the line out.")


def _converted(
    response: FrequencyResponse, names: tuple[str, str], values: ComplexArray, derivatives: Mapping[str, ComplexArray]
) -> FrequencyResponse:
    """Return a response of one input and one output, given its derivatives to outputs of the response."""
    jacobian = np.zeros((len(response.lines), 1, len(response.outputs)), dtype=np.complex128)
    for name, values_of_lines in derivatives.items():
        jacobian[:, 0, response.outputs.index(name)] = values_of_lines
    return converted(response, values[np.newaxis, np.newaxis], jacobian, inputs=names[:1], outputs=names[1:])


def _without_lost_lines(
    opened: FrequencyResponse, response: FrequencyResponse, values: ComplexArray, *, signal: str = "e"
) -> FrequencyResponse:
    """Mark the lines whose error signal or rack is lost in noise as not used."""
    index, name = (0, "error signal") if signal == "e" else (response.outputs.index(signal), "fuel rack")
    half = len(response.outputs)
    std = np.sqrt(response.covariance[:, index, index] + response.covariance[:, half + index, half + index])
    lost: BoolArray = np.abs(values) < _LEAST_ERROR_STD * std
    remark = f"{name} is lost in noise (|{signal}/n_set| = {{:.2g}})"
    return without_lines(opened, {row: remark.format(abs(values[row])) for row in np.flatnonzero(lost).tolist()})
