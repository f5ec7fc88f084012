"""What each figure of a report shows, one a file; every ``*_chart`` function returns a ``Chart``, whoever draws it."""

from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.figures._calibration import calibration_chart, strip_chart
from shaftprint.report.figures._campaign import campaign_chart, spread
from shaftprint.report.figures._covariance import budget_chart, correlation_chart
from shaftprint.report.figures._differences import difference_chart, in_percent, shown_names
from shaftprint.report.figures._envelope import channel_envelope, envelope
from shaftprint.report.figures._explanation import missing_damping_chart
from shaftprint.report.figures._fit import fit_chart
from shaftprint.report.figures._history import history_chart
from shaftprint.report.figures._limits import limit_chart
from shaftprint.report.figures._modes import mode_chart
from shaftprint.report.figures._nyquist import nyquist_chart
from shaftprint.report.figures._outliers import outlier_chart
from shaftprint.report.figures._plan import (
    length_chart,
    planned_line_chart,
    planned_motion_chart,
    planned_set_point_chart,
)
from shaftprint.report.figures._profiles import profile_chart
from shaftprint.report.figures._residuals import line_chi_square, normalised_residuals, residual_chart
from shaftprint.report.figures._responses import CRITICAL_SPAN_RAD_S, open_loop_chart
from shaftprint.report.figures._scan import scan_chart
from shaftprint.report.figures._sensitivity import parameter_steps, sensitivity_chart
from shaftprint.report.figures._signal_to_noise import THESIS_LIMIT_DB, signal_to_noise_chart
from shaftprint.report.figures._simulation import SimulatedSignal, simulation_chart
from shaftprint.report.figures._sisters import sister_chart
from shaftprint.report.figures._step_band import step_chart
from shaftprint.report.figures._steps import delay_chart
from shaftprint.report.figures._time_series import chirp_chart, excitation_chart, signal_chart, staircase_chart
from shaftprint.report.figures._traces import measured_phase_deg, trace_of
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.report.figures._validation import validation_chart, validation_summary_chart

__all__ = [
    "CRITICAL_SPAN_RAD_S",
    "THESIS_LIMIT_DB",
    "SimulatedSignal",
    "bode_chart",
    "budget_chart",
    "calibration_chart",
    "campaign_chart",
    "channel_envelope",
    "chirp_chart",
    "correlation_chart",
    "delay_chart",
    "difference_chart",
    "envelope",
    "excitation_chart",
    "fit_chart",
    "history_chart",
    "in_percent",
    "length_chart",
    "limit_chart",
    "line_chi_square",
    "measured_phase_deg",
    "measured_points",
    "missing_damping_chart",
    "mode_chart",
    "normalised_residuals",
    "nyquist_chart",
    "open_loop_chart",
    "outlier_chart",
    "parameter_steps",
    "planned_line_chart",
    "planned_motion_chart",
    "planned_set_point_chart",
    "profile_chart",
    "residual_chart",
    "scan_chart",
    "sensitivity_chart",
    "shown_names",
    "signal_chart",
    "signal_to_noise_chart",
    "simulation_chart",
    "sister_chart",
    "spread",
    "staircase_chart",
    "step_chart",
    "strip_chart",
    "trace_of",
    "validation_chart",
    "validation_summary_chart",
]
