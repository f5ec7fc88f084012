"""Figures and the report.

========================= ========== ==========================================================================
quantity                  unit       how it is drawn
========================= ========== ==========================================================================
frequency                 rad/s      logarithmic, plain numbers
magnitude                 dB         ``20 log10 |H|``
phase                     deg        unwrapped; whole turns of data agree with the closest model drawn
interval of data          95 %       error bar; Student's t where the covariance was measured from few periods
band of a model           95 %       filled; covariance of the parameters through exact derivatives
normalised signals        -          deviation over the working point
set point, speed          rpm        of the engine
torque                    N m        at the gauge
========================= ========== ==========================================================================

Every ``plot_*`` function returns a matplotlib ``Figure`` that belongs to nobody else; ``save_figure`` writes it.
"""

from shaftprint.report._comparison import render_comparison
from shaftprint.report._curve import Curve, closed_loop_curve, open_loop_curve
from shaftprint.report._page import expect_reportlab
from shaftprint.report._render import render_pdf, render_report
from shaftprint.report.comparison import (
    LOAD_REPEATABILITY,
    Difference,
    difference_table,
    differences,
    vessel_file_sentences,
)
from shaftprint.report.figures import (
    SimulatedSignal,
    plot_bode,
    plot_calibration,
    plot_campaign,
    plot_chirp,
    plot_closed_loop_comparison,
    plot_closed_loop_fits,
    plot_closed_loop_response,
    plot_core_fit,
    plot_correlation,
    plot_differences,
    plot_excitation,
    plot_governor_fits,
    plot_limits,
    plot_line_selection,
    plot_missing_damping,
    plot_modes,
    plot_nyquist,
    plot_open_loop_comparison,
    plot_open_loop_responses,
    plot_outliers,
    plot_residuals,
    plot_scan,
    plot_sensitivity,
    plot_signal_to_noise,
    plot_simulation,
    plot_staircase,
    plot_step_delays,
    plot_strip_angles,
    plot_validation,
    plot_validation_summary,
    save_figure,
)
from shaftprint.report.sections import change_in_words
from shaftprint.report.thesis import (
    Explanation,
    damping_table,
    explain_thesis,
    explanation_sentences,
    gain_table,
    inertia_table,
    integral_table,
)

__all__ = [
    "LOAD_REPEATABILITY",
    "Curve",
    "Difference",
    "Explanation",
    "SimulatedSignal",
    "change_in_words",
    "closed_loop_curve",
    "damping_table",
    "difference_table",
    "differences",
    "expect_reportlab",
    "explain_thesis",
    "explanation_sentences",
    "gain_table",
    "inertia_table",
    "integral_table",
    "open_loop_curve",
    "plot_bode",
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
    "plot_residuals",
    "plot_scan",
    "plot_sensitivity",
    "plot_signal_to_noise",
    "plot_simulation",
    "plot_staircase",
    "plot_step_delays",
    "plot_strip_angles",
    "plot_validation",
    "plot_validation_summary",
    "render_comparison",
    "render_pdf",
    "render_report",
    "save_figure",
    "vessel_file_sentences",
]
