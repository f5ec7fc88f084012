"""Whether the values of messages were taken at their stamps, by one line."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.sender_cycle import times_of_course
from shaftprint.spectra.lines._line_fit import LineFit


def times_of_values(fit: LineFit) -> FloatArray | None:
    """Return when the values of messages were taken, where that is not at their stamps.

    ``fit``: the line, fitted at the times of the stamps, of one channel. Returns times since the start of the window
    [s], shape (messages,); None where the stamps are those of the values, the sender keeps no cycle, or the line is too
    slow or too weak to tell.
    """
    time_s = fit.samples.time_s
    omega_rad_s = 2.0 * np.pi * fit.samples.window.frequency_hz
    slope = (1j * omega_rad_s * fit.amplitude[0, 0] * np.exp(1j * omega_rad_s * time_s)).real
    return times_of_course(time_s, fit.residual[0], slope, rate_hz=fit.samples.rate_hz)
