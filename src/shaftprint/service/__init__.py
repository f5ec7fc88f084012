"""A fingerprint from ordinary service: the moves of the lever of a ship that works, and no test at all.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
time                s       of a file of the log
set point           V       as in campaigns; its line to the speed is found where the lever stands still
``n``               -       deviation of engine speed over that of the vessel file's working point; positive faster
``M_s``             -       deviation of shaft torque over that of the vessel file's working point; positive when the
                            engine drives the propeller
load                -       torque over the square of the speed, over that of the working point
=================== ======= ==========================================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
