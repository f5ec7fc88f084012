"""From the responses to the reference of a loop to the response of the plant in it, with its covariance."""

from dataclasses import replace

import numpy as np

from shaftprint.errors import ResponseError
from shaftprint.spectra._conversion import converted, without_lines
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._open_loop import expect_not_zero
from shaftprint.spectra._response_covariance import weight_change

# Of a reciprocal the first orders of the noise are not enough: in simulated loops the mean square of the errors over
# the covariance was 1.22 where lines down to three standard deviations were taken, 1.06 with five, 1.02 with seven.
_LEAST_INPUT_STD = 7.0


def plant_from_closed_loop(
    response: FrequencyResponse, *, input: str = "u", output: str | tuple[str, ...] = "y"
) -> FrequencyResponse:
    """Convert the response from a reference to input and outputs of a plant into the response of the plant.

    With ``G_u = u / r`` and ``G_y = y / r`` it is ``G_y / G_u``, whatever the controller does and whatever noise runs
    around the loop, as long as the reference does not depend on that noise (the joint input-output method: Pintelon and
    Schoukens, "System Identification: A Frequency Domain Approach", sections on measurements in a feedback loop). The
    covariance is carried through, the correlation between input and output included.

    Parameters
    ----------
    response
        Response from one reference to the plant's input and outputs.
    input
        Name of the plant's input, an output of the response.
    output
        Name of the plant's output, or names of several.

    Returns
    -------
    Response from the plant's input to its outputs. Lines at which the input is less than seven standard deviations from
    0 are marked as not used.

    Raises
    ------
    ResponseError
        If the response has several inputs or lacks one of the channels, or the plant's input is exactly 0 at a line.
    """
    outputs = (output,) if isinstance(output, str) else tuple(output)
    if len(response.inputs) != 1:
        raise ResponseError(
            f"closed loop: expected a response to one reference, found {', '.join(response.inputs)}: estimate one of "
            "each."
        )
    joint = response.of_outputs(input, *outputs)
    u, y = joint.response[0, 0], joint.response[1:, 0]
    expect_not_zero(joint, input, u)
    plant = y / u
    identity = np.broadcast_to(np.eye(len(outputs)), (u.size, len(outputs), len(outputs)))
    jacobian = np.concatenate([-plant.T[:, :, np.newaxis], identity], axis=2) / u[:, np.newaxis, np.newaxis]
    plant_response = converted(joint, plant[:, np.newaxis], jacobian, inputs=(input,), outputs=outputs)
    half = 1 + len(outputs)
    share = (joint.covariance[:, 0, 0] + joint.covariance[:, half, half]) / np.abs(u) ** 2
    # second order: noise that makes u large makes the stated covariance small
    change = (1.0 + 2.0 * share) * weight_change(joint.degrees_of_freedom, half, len(outputs))
    remark = f"{input} is only {{:.1f}} times its noise, too little to divide by"
    lost = np.flatnonzero(share * _LEAST_INPUT_STD**2 > 1.0).tolist()
    return without_lines(
        replace(plant_response, covariance=change[:, np.newaxis, np.newaxis] * plant_response.covariance),
        {index: remark.format(share[index] ** -0.5) for index in lost},
    )
