"""From signals to measured frequency responses with their covariance.

=========================== ======= ==================================================================
quantity                    unit    meaning and sign convention
=========================== ======= ==================================================================
frequency of a line ``f``   Hz      of the campaign; ``omega_rad_s`` in rad/s
amplitude                   -       complex, ``x = Re(a exp(j w t))``, over the working point; set point
                                    and speed over ``n_0``, torque over ``M_s0``, rack over ``X_0``
response                    -       output amplitude over input amplitude; a lag has negative phase
covariance                  -       of the real vector [Re, Im], outputs first
degrees of freedom          -       real degrees of freedom behind a covariance
signal-to-noise ratio       dB      local, 20 DFT bins on each side; overall ratio without unit
load drift ``delta``        -       propeller load of a window over that at the working point, minus 1
=========================== ======= ==================================================================

`estimate_spectra` gives all of it for sines and `estimate_legs` for legs, `estimate_response` the response alone,
`open_loop` and `governor_and_engine` its open-loop forms.

For drives that are no ships `response_from_arrays` makes a response from plain time series, in the units of the arrays,
`plant_from_closed_loop` takes a plant out of its loop, and `FrequencyResponse` holds what another program has measured.
"""

from shaftprint.spectra._closed_loop import plant_from_closed_loop
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._leg_spectra import SPEED, estimate_inputs_of_legs, estimate_legs
from shaftprint.spectra._line_responses import NOT_MEASURED_STD, measured
from shaftprint.spectra._measured_inputs import with_measured_inputs
from shaftprint.spectra._open_loop import governor_and_engine, open_loop
from shaftprint.spectra._plain_covariance import circular_covariance, coherence_covariance
from shaftprint.spectra._spectra import Spectra, estimate_response, estimate_spectra
from shaftprint.spectra._speed_ratios import SpeedRatio
from shaftprint.spectra.lines import (
    ExactBin,
    Harmonics,
    HighestPeak,
    LineFit,
    LoadDrift,
    SignalToNoise,
    SineMethod,
    WholePeriodSine,
    Window,
    WindowSamples,
    plan_windows,
    whole_period_window,
)
from shaftprint.spectra.records import Arbitrary, Excitation, Periodic, response_from_arrays

__all__ = [
    "NOT_MEASURED_STD",
    "SPEED",
    "Arbitrary",
    "ExactBin",
    "Excitation",
    "FrequencyResponse",
    "Harmonics",
    "HighestPeak",
    "LineFit",
    "LoadDrift",
    "Periodic",
    "SignalToNoise",
    "SineMethod",
    "Spectra",
    "SpeedRatio",
    "WholePeriodSine",
    "Window",
    "WindowSamples",
    "circular_covariance",
    "coherence_covariance",
    "estimate_inputs_of_legs",
    "estimate_legs",
    "estimate_response",
    "estimate_spectra",
    "governor_and_engine",
    "measured",
    "open_loop",
    "plan_windows",
    "plant_from_closed_loop",
    "response_from_arrays",
    "whole_period_window",
    "with_measured_inputs",
]
