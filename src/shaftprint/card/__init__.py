"""What stands on a ship's card, the vessel file that follows from it, and whether a vessel file agrees with itself.

===================== ======= ===============================================================================
quantity              unit    meaning and sign
===================== ======= ===============================================================================
``K_Q``               -       torque coefficient of a propeller series at zero advance
disagreement                  a field that other fields of the same file contradict, or that is strange
===================== ======= ===============================================================================
"""

from shaftprint.card._disagreements import Disagreement, disagreements

__all__ = ["Disagreement", "disagreements"]
