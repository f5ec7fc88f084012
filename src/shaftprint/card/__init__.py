"""What stands on a ship's card, the vessel file that follows from it, and whether a vessel file agrees with itself.

===================== ======= ===============================================================================
quantity              unit    meaning and sign
===================== ======= ===============================================================================
card                          engine, gearbox and propeller by the numbers that every ship's papers have
``K_Q``               -       torque coefficient of a propeller series at zero advance
derived               as is   a number of the vessel file that the card does not have, with its origin
disagreement                  a field that other fields of the same file contradict, or that is strange
===================== ======= ===============================================================================

The simulated tug shares no physics with this room: it reads the file that is written here.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
