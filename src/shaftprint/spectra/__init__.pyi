from ._closed_loop import plant_from_closed_loop
from ._frequency_response import FrequencyResponse
from ._open_loop import open_loop
from ._plain_covariance import circular_covariance, coherence_covariance
from ._spectra import Spectra, estimate_response, estimate_spectra
from .lines._bin_selection import ExactBin, HighestPeak
from .lines._harmonics import Harmonics
from .lines._signal_to_noise import SignalToNoise, signal_to_noise
from .lines._windows import plan_windows, whole_period_window
from .records._from_arrays import response_from_arrays
from .records._periodic import Periodic

__all__ = [
    "ExactBin",
    "FrequencyResponse",
    "Harmonics",
    "HighestPeak",
    "Periodic",
    "SignalToNoise",
    "Spectra",
    "circular_covariance",
    "coherence_covariance",
    "estimate_response",
    "estimate_spectra",
    "open_loop",
    "plan_windows",
    "plant_from_closed_loop",
    "response_from_arrays",
    "signal_to_noise",
    "whole_period_window",
]
