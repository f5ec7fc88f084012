"""Figures of matplotlib, one a file; every ``plot_*`` function returns a ``Figure`` that belongs to nobody else."""

from shaftprint.report.figures._bode import plot_bode
from shaftprint.report.figures._bode_parts import BAND_STEP, ENDLESS_DB, Trace, channel_of, measured_phase_deg, trace_of
from shaftprint.report.figures._calibration import plot_calibration, plot_strip_angles
from shaftprint.report.figures._campaign import plot_campaign, spread
from shaftprint.report.figures._covariance import PERCENT, plot_budget, plot_correlation
from shaftprint.report.figures._differences import in_percent, plot_differences, shown_names, shown_percent
from shaftprint.report.figures._envelope import channel_envelope, envelope, worthwhile
from shaftprint.report.figures._explanation import plot_missing_damping
from shaftprint.report.figures._limits import plot_limits
from shaftprint.report.figures._modes import plot_modes
from shaftprint.report.figures._nyquist import plot_nyquist
from shaftprint.report.figures._outliers import plot_outliers
from shaftprint.report.figures._profiles import ROOM, plot_profiles
from shaftprint.report.figures._residuals import line_chi_square, normalised_residuals, plot_residuals
from shaftprint.report.figures._responses import (
    plot_closed_loop_comparison,
    plot_closed_loop_fits,
    plot_closed_loop_response,
    plot_core_fit,
    plot_governor_fits,
    plot_line_selection,
    plot_open_loop_comparison,
    plot_open_loop_responses,
)
from shaftprint.report.figures._scan import plot_scan
from shaftprint.report.figures._sensitivity import parameter_steps, plot_sensitivity
from shaftprint.report.figures._signal_to_noise import THESIS_LIMIT_DB, plot_signal_to_noise
from shaftprint.report.figures._simulation import SimulatedSignal, plot_simulation
from shaftprint.report.figures._step_band import DURATION_S, plot_step_band
from shaftprint.report.figures._steps import plot_step_delays
from shaftprint.report.figures._style import LOOKS, house_style, legend_below, new_figure, save_figure, shorter_svg
from shaftprint.report.figures._time_series import plot_chirp, plot_excitation, plot_staircase
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.report.figures._validation import plot_validation, plot_validation_summary

__all__ = [
    "BAND_STEP",
    "DURATION_S",
    "ENDLESS_DB",
    "LOOKS",
    "PERCENT",
    "ROOM",
    "THESIS_LIMIT_DB",
    "SimulatedSignal",
    "Trace",
    "channel_envelope",
    "channel_of",
    "envelope",
    "house_style",
    "in_percent",
    "legend_below",
    "line_chi_square",
    "measured_phase_deg",
    "measured_points",
    "new_figure",
    "normalised_residuals",
    "parameter_steps",
    "plot_bode",
    "plot_budget",
    "plot_calibration",
    "plot_campaign",
    "plot_chirp",
    "plot_closed_loop_comparison",
    "plot_closed_loop_fits",
    "plot_closed_loop_response",
    "plot_core_fit",
    "plot_correlation",
    "plot_differences",
    "plot_excitation",
    "plot_governor_fits",
    "plot_limits",
    "plot_line_selection",
    "plot_missing_damping",
    "plot_modes",
    "plot_nyquist",
    "plot_open_loop_comparison",
    "plot_open_loop_responses",
    "plot_outliers",
    "plot_profiles",
    "plot_residuals",
    "plot_scan",
    "plot_sensitivity",
    "plot_signal_to_noise",
    "plot_simulation",
    "plot_staircase",
    "plot_step_band",
    "plot_step_delays",
    "plot_strip_angles",
    "plot_validation",
    "plot_validation_summary",
    "save_figure",
    "shorter_svg",
    "shown_names",
    "shown_percent",
    "spread",
    "trace_of",
    "worthwhile",
]
