"""The response that a test would measure: its lines with the covariance that their length and the noise give them."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._order_cost import order_cost
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._leg_spectra import SPEED
from shaftprint.spectra.lines._windows import plan_windows

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign

_TORQUE = "M_s"
# By how much an order enlarges the deviation of a torque before that is worth a remark.
_WORTH_A_REMARK = 1.5
# A line of a recording is off its plan by the clocks of generator and logger, a ten-thousandth at most.
_SAME_FREQUENCY = 1e-3


def planned_response(campaign: "Campaign", noise: NoiseLevels, *, excitation: str = SPEED) -> FrequencyResponse:
    """Return the lines that the sines of a campaign would give, each over its whole periods; the values are zero.

    Lines above the highest frequency of the noise levels are not used: a recording of the same ship had no usable line
    there. A line beside an order of the shaft has a torque that is less well known, and a remark.

    Parameters
    ----------
    campaign
        The plan, with the sines of one input alone (``Campaign.of_input``).
    noise
        Noise of the outputs under that input.
    excitation
        Symbol of that input.

    Raises
    ------
    ResponseError
        If the campaign has no sine, two of one frequency, or one of less than two periods.
    """
    windows = plan_windows(campaign)
    amplitudes = {sine.name: sine.amplitude_v for sine in campaign.sines}
    response = planned_lines(
        [window.frequency_hz for window in windows],
        noise=noise,
        amplitude=[noise.set_point_per_v * amplitudes[window.line] for window in windows],
        duration_s=[window.duration_s for window in windows],
        lines=[window.line for window in windows],
        excitation=excitation,
    )
    cost = np.array([order_cost(window.frequency_hz, window.duration_s, noise) for window in windows])
    return _with_order_cost(response, cost) if cost.any() else response


def _with_order_cost(response: FrequencyResponse, cost: FloatArray) -> FrequencyResponse:
    """Return lines whose torque has so much more of its variance, with a remark where that is worth one."""
    covariance, count = response.covariance.copy(), len(response.outputs)
    torque = response.outputs.index(_TORQUE)
    for place in (torque, count + torque):
        covariance[:, place, place] *= 1.0 + cost
    beside = {
        line: f"beside an order of the shaft: its torque is {np.sqrt(1.0 + share):.2g} times less well known"
        for line, share in zip(response.lines, cost.tolist(), strict=True)
        if np.sqrt(1.0 + share) >= _WORTH_A_REMARK
    }
    return replace(response, covariance=covariance, remarks={**response.remarks, **beside})


def planned_lines(
    frequency_hz: ArrayLike,
    *,
    noise: NoiseLevels,
    amplitude: ArrayLike,
    duration_s: ArrayLike,
    lines: Sequence[str] = (),
    excitation: str = SPEED,
    degrees_of_freedom: ArrayLike | None = None,
) -> FrequencyResponse:
    """Return test lines with the covariance that they would have; the values are zero.

    Parameters
    ----------
    frequency_hz
        Frequency of each line [Hz], ascending, shape (lines,).
    noise
        Noise of the outputs.
    amplitude
        Amplitude of the set point over the working-point speed, of each line or of all, such as 0.127.
    duration_s
        Length of each line or of all [s]; lines of one multisine or square wave last equally long.
    lines
        Names of the lines; numbered when empty.
    excitation
        Symbol of what is moved.
    degrees_of_freedom
        Real degrees of freedom from which the covariance of each line will be estimated; that costs accuracy. It is
        taken as known where they are not given.

    Raises
    ------
    IdentificationError
        If an amplitude or a length is not positive.
    """
    frequency = np.atleast_1d(np.asarray(frequency_hz, dtype=np.float64))
    height, length = (np.broadcast_to(np.asarray(values, float), frequency.shape) for values in (amplitude, duration_s))
    if not np.all(height > 0.0) or not np.all(length > 0.0):
        raise IdentificationError("planned lines: expected positive amplitudes and lengths.")
    spread = noise.at(frequency) * (2.0 / (length * height**2))[:, None, None]
    highest = noise.frequency_hz[-1]
    used = frequency <= (1.0 + _SAME_FREQUENCY) * highest
    names = tuple(lines) or tuple(f"line {number}" for number in range(1, frequency.size + 1))
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=np.zeros((len(noise.outputs), 1, frequency.size), dtype=np.complex128),
        covariance=_real(spread),
        inputs=(excitation,),
        outputs=noise.outputs,
        lines=names,
        used=used,
        remarks={
            name: f"above {highest:g} Hz, beyond which nothing is known of the noise"
            for name, is_used in zip(names, used, strict=True)
            if not is_used
        },
        degrees_of_freedom=np.full(frequency.size, np.inf)
        if degrees_of_freedom is None
        else np.asarray(degrees_of_freedom, dtype=np.float64),
    )
    return replace(response, covariance=response.weight_factors[:, None, None] * response.covariance)


def expected_response(
    response: FrequencyResponse, structure: Structure, values: Mapping[str, float] | None = None
) -> FrequencyResponse:
    """Return a planned response with the values that a structure gives: a test without noise, to be fitted.

    Parameters
    ----------
    response
        The lines, with the structure's inputs and outputs.
    structure
        What answers.
    values
        Parameter values by name; the structure's own where not given.

    Raises
    ------
    StructureError
        If a name is not a parameter of the structure.
    IdentificationError
        If inputs or outputs differ.
    """
    if structure.inputs != response.inputs or tuple(structure.outputs) != response.outputs:
        raise IdentificationError(
            f"structure {structure.name} goes from {', '.join(structure.inputs)} to {', '.join(structure.outputs)}, "
            f"the planned response from {', '.join(response.inputs)} to {', '.join(response.outputs)}."
        )
    exact = structure.response(structure.vector(values or {}), 1j * response.omega_rad_s)
    return replace(response, response=exact.reshape(response.response.shape))


def _real(covariance: np.ndarray) -> FloatArray:
    """Return the covariance of [Re, Im] of circular complex noise, shape (lines, 2 outputs, 2 outputs)."""
    upper = np.concatenate([covariance.real, -covariance.imag], axis=2)
    lower = np.concatenate([covariance.imag, covariance.real], axis=2)
    table: FloatArray = 0.5 * np.concatenate([upper, lower], axis=1)
    return table
