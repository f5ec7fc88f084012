"""Amplitude of a line in stretches of whole periods: whether a window is the same from its begin to its end."""

import numpy as np

from shaftprint.arrays import ComplexArray
from shaftprint.spectra.lines._line_fit import LineFit

_STRETCHES = 6


def stretch_periods(periods: int) -> int:
    """Return the number of periods in one stretch of a window of so many periods."""
    return max(1, periods // _STRETCHES)


def stretch_amplitudes(fit: LineFit) -> ComplexArray:
    """Return the amplitude that the residual adds in each stretch of whole periods.

    ``fit``: the fitted window of ``P`` periods. Returns complex amplitudes, shape (channels, stretches): one stretch a
    period below 12 periods, then 6 to 8 stretches of equally many periods; the periods left over at the end are not
    used.
    """
    window, time_s = fit.samples.window, fit.samples.time_s
    length = stretch_periods(window.periods)
    border_s = np.arange(window.periods // length + 1) * length / window.frequency_hz
    border = np.searchsorted(time_s, border_s - 1e-9)
    values = fit.residual * np.exp(-2j * np.pi * window.frequency_hz * time_s)
    amplitudes: ComplexArray = np.add.reduceat(values[:, : border[-1]], border[:-1], axis=1)
    amplitudes *= 2.0 / np.diff(border)
    return amplitudes
