"""Figures and the report.

========================= ========== ==========================================================================
quantity                  unit       how it is drawn
========================= ========== ==========================================================================
frequency                 rad/s      logarithmic, plain numbers
magnitude                 dB         ``20 log10 |H|``
phase                     deg        whole turns of data agree with the closest model; of many turns the place in one
interval of data          95 %       error bar; Student's t where the covariance was measured from few periods
band of a model           95 %       filled; covariance of the parameters through exact derivatives
normalised signals        -          deviation over the working point
set point, speed          rpm        of the engine
torque                    N m        at the gauge
========================= ========== ==========================================================================

Every ``plot_*`` function returns a matplotlib ``Figure`` that belongs to nobody else; ``save_chart`` writes it.
"""

from shaftprint.report._class_page import render_class
from shaftprint.report._comparison import render_comparison
from shaftprint.report._curve import Curve, closed_loop_curve, open_loop_curve
from shaftprint.report._drive_page import render_drive
from shaftprint.report._history_page import render_history, sizes_of_tests
from shaftprint.report._page import expect_reportlab
from shaftprint.report._plot import plot
from shaftprint.report._render import render_pdf, render_report
from shaftprint.report.charts import Chart, save_chart
from shaftprint.report.comparison import (
    Difference,
    cause_spread_table,
    cause_table,
    course_table,
    difference_table,
    differences,
    history_table,
    number_spread_table,
    sister_table,
    stated_table,
    vessel_file_sentences,
)
from shaftprint.report.figures import (
    SimulatedSignal,
    bode_chart,
    budget_chart,
    calibration_chart,
    campaign_chart,
    chirp_chart,
    correlation_chart,
    delay_chart,
    difference_chart,
    excitation_chart,
    fit_chart,
    history_chart,
    limit_chart,
    missing_damping_chart,
    mode_chart,
    nyquist_chart,
    open_loop_chart,
    outlier_chart,
    profile_chart,
    residual_chart,
    scan_chart,
    sensitivity_chart,
    signal_chart,
    signal_to_noise_chart,
    simulation_chart,
    sister_chart,
    staircase_chart,
    step_chart,
    strip_chart,
    validation_chart,
    validation_summary_chart,
)
from shaftprint.report.plan import render_plan
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
    "Chart",
    "Curve",
    "Difference",
    "Explanation",
    "SimulatedSignal",
    "bode_chart",
    "budget_chart",
    "calibration_chart",
    "campaign_chart",
    "cause_spread_table",
    "cause_table",
    "change_in_words",
    "chirp_chart",
    "closed_loop_curve",
    "correlation_chart",
    "course_table",
    "damping_table",
    "delay_chart",
    "difference_chart",
    "difference_table",
    "differences",
    "excitation_chart",
    "expect_reportlab",
    "explain_thesis",
    "explanation_sentences",
    "fit_chart",
    "gain_table",
    "history_chart",
    "history_table",
    "inertia_table",
    "integral_table",
    "limit_chart",
    "missing_damping_chart",
    "mode_chart",
    "number_spread_table",
    "nyquist_chart",
    "open_loop_chart",
    "open_loop_curve",
    "outlier_chart",
    "plot",
    "profile_chart",
    "render_class",
    "render_comparison",
    "render_drive",
    "render_history",
    "render_pdf",
    "render_plan",
    "render_report",
    "residual_chart",
    "save_chart",
    "scan_chart",
    "sensitivity_chart",
    "signal_chart",
    "signal_to_noise_chart",
    "simulation_chart",
    "sister_chart",
    "sister_table",
    "sizes_of_tests",
    "staircase_chart",
    "stated_table",
    "step_chart",
    "strip_chart",
    "validation_chart",
    "validation_summary_chart",
    "vessel_file_sentences",
]
