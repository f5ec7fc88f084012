from ._curve import Curve
from ._plot import plot
from ._render import render_pdf, render_report
from .charts._pictures import save_chart
from .comparison._differences import differences
from .figures._bode import bode_chart
from .figures._calibration import calibration_chart, strip_chart
from .figures._campaign import campaign_chart
from .figures._covariance import budget_chart, correlation_chart
from .figures._differences import difference_chart
from .figures._explanation import missing_damping_chart
from .figures._fit import fit_chart
from .figures._history import history_chart
from .figures._limits import limit_chart
from .figures._modes import mode_chart
from .figures._nyquist import nyquist_chart
from .figures._outliers import outlier_chart
from .figures._profiles import profile_chart
from .figures._residuals import residual_chart
from .figures._responses import open_loop_chart
from .figures._scan import scan_chart
from .figures._sensitivity import sensitivity_chart
from .figures._signal_to_noise import signal_to_noise_chart
from .figures._simulation import simulation_chart
from .figures._sisters import sister_chart
from .figures._step_band import step_chart
from .figures._steps import delay_chart
from .figures._time_series import chirp_chart, excitation_chart, signal_chart, staircase_chart
from .figures._validation import validation_chart, validation_summary_chart

__all__ = [
    "Curve",
    "bode_chart",
    "budget_chart",
    "calibration_chart",
    "campaign_chart",
    "chirp_chart",
    "correlation_chart",
    "delay_chart",
    "difference_chart",
    "differences",
    "excitation_chart",
    "fit_chart",
    "history_chart",
    "limit_chart",
    "missing_damping_chart",
    "mode_chart",
    "nyquist_chart",
    "open_loop_chart",
    "outlier_chart",
    "plot",
    "profile_chart",
    "render_pdf",
    "render_report",
    "residual_chart",
    "save_chart",
    "scan_chart",
    "sensitivity_chart",
    "signal_chart",
    "signal_to_noise_chart",
    "simulation_chart",
    "sister_chart",
    "staircase_chart",
    "step_chart",
    "strip_chart",
    "validation_chart",
    "validation_summary_chart",
]
