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
from shaftprint.time_domain._record import Record, record_from_arrays
from shaftprint.time_domain._records_of import records_of

__all__ = ["Decimator", "Record", "record_from_arrays", "records_of"]
