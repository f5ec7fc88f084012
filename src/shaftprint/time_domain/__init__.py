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

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
