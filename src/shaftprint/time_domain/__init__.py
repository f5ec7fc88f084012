"""Fits in time: records of tests, noise of any colour, residuals of simulated outputs.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
time                s       of the recording
``n_set``           -       deviation of the engine-speed set point over the speed of the working point
``n``               -       deviation of engine speed over its working-point value; positive faster
``M_s``             -       deviation of shaft torque at the gauge over its working-point value; positive when the
                            engine drives the propeller
=================== ======= ==========================================================================================
"""

from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._identify_chirp import identify_chirp, spectrum_term
from shaftprint.time_domain._identify_in_time import TimeSettings, identify_in_time, output_error, with_noise_at
from shaftprint.time_domain._noise_model import NoiseModel, estimate_noise, white_noise
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record, record_from_arrays
from shaftprint.time_domain._record_fit import RecordFit
from shaftprint.time_domain._record_repeats import RecordRepeats
from shaftprint.time_domain._signal_records import records_of
from shaftprint.time_domain._simulator import ExactDelays, Simulator
from shaftprint.time_domain._simulator import on_record as simulated_on
from shaftprint.time_domain._span import qr_reduced
from shaftprint.time_domain._spectrum import Spectrum, spectrum_of
from shaftprint.time_domain._spectrum_term import FittedSpectrum, SpectrumRepeats, SpectrumTerm
from shaftprint.time_domain._whiteness import whiteness_p_value
from shaftprint.time_domain._whitening import Whitening
from shaftprint.time_domain.nonlinear import (
    Jump,
    JumpStretch,
    LimitedModel,
    LimitNumber,
    NonlinearFit,
    NonlinearSettings,
    identify_nonlinear,
    jumps_in,
    limit_numbers,
    structure_for,
    with_jumps,
    without_orders,
)

__all__ = [
    "Decimator",
    "ExactDelays",
    "FittedSpectrum",
    "Jump",
    "JumpStretch",
    "LimitNumber",
    "LimitedModel",
    "NoiseModel",
    "NonlinearFit",
    "NonlinearSettings",
    "OutputError",
    "Record",
    "RecordFit",
    "RecordRepeats",
    "Simulator",
    "Spectrum",
    "SpectrumRepeats",
    "SpectrumTerm",
    "TimeSettings",
    "Whitening",
    "estimate_noise",
    "identify_chirp",
    "identify_in_time",
    "identify_nonlinear",
    "jumps_in",
    "limit_numbers",
    "output_error",
    "qr_reduced",
    "record_from_arrays",
    "records_of",
    "simulated_on",
    "spectrum_of",
    "spectrum_term",
    "structure_for",
    "white_noise",
    "whiteness_p_value",
    "with_jumps",
    "with_noise_at",
    "without_orders",
]
