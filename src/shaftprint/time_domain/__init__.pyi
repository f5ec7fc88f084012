from ._identify_chirp import identify_chirp, spectrum_term
from ._identify_in_time import TimeSettings, identify_in_time, output_error
from ._output_error import OutputError
from ._record import Record, record_from_arrays
from ._signal_records import records_of
from ._spectrum import spectrum_of
from ._spectrum_term import SpectrumTerm
from .nonlinear._fit import identify_nonlinear
from .nonlinear._settings import NonlinearSettings
from .nonlinear._structure import structure_for

__all__ = [
    "NonlinearSettings",
    "OutputError",
    "Record",
    "SpectrumTerm",
    "TimeSettings",
    "identify_chirp",
    "identify_in_time",
    "identify_nonlinear",
    "output_error",
    "record_from_arrays",
    "records_of",
    "spectrum_of",
    "spectrum_term",
    "structure_for",
]
