"""Interactive figures as plain descriptions: what plotly draws on the page, made without importing plotly.

=================== ========== ==============================================================================
quantity            unit       how it is drawn
=================== ========== ==============================================================================
frequency           rad/s      logarithmic; all panels of a figure are zoomed together
magnitude           dB         ``20 log10 |H|``
phase               deg        unwrapped
normalised signals  -          deviation over the working point; samples as many as the low-pass leaves worth
share               %          of a source in the variance of a number
=================== ========== ==============================================================================

Every ``*_plot`` function returns a ``Plot``; its ``text`` is JSON. Colours are named by part, and the page puts in
those of its light or dark look.
"""

from shaftprint.report.plots._bode import bode_plot
from shaftprint.report.plots._differences import difference_plot
from shaftprint.report.plots._judged import budget_plot, profile_plot, residual_plot, signal_to_noise_plot
from shaftprint.report.plots._nyquist import nyquist_plot
from shaftprint.report.plots._plot import Plot, packed
from shaftprint.report.plots._quick_script import quick_script
from shaftprint.report.plots._script import plotly_script, plotly_sheets, plotly_version
from shaftprint.report.plots._time import excitation_plot, step_plot, validation_plot

__all__ = [
    "Plot",
    "bode_plot",
    "budget_plot",
    "difference_plot",
    "excitation_plot",
    "nyquist_plot",
    "packed",
    "plotly_script",
    "plotly_sheets",
    "plotly_version",
    "profile_plot",
    "quick_script",
    "residual_plot",
    "signal_to_noise_plot",
    "step_plot",
    "validation_plot",
]
