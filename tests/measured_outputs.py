"""Which outputs of a response were measured at which lines."""

import numpy as np

from shaftprint.spectra._line_responses import NOT_MEASURED_STD


def measured(response):
    """True where an output was measured, shape (outputs, lines).

    A line may show speed and torque and be too fast for the percent torque on the CAN bus. The value that the response
    holds there says nothing.
    """
    variance = np.diagonal(response.covariance, axis1=1, axis2=2)[:, : len(response.outputs)]
    return variance.T < 0.5 * NOT_MEASURED_STD**2
