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

from shaftprint.card._card import Card, Gauge, Pulses
from shaftprint.card._disagreement import Disagreement
from shaftprint.card._disagreements import disagreements
from shaftprint.card._series import four_quadrant_curve, open_water_curve
from shaftprint.card._vessel_text import vessel_text
from shaftprint.card._write import write_vessel

__all__ = [
    "Card",
    "Disagreement",
    "Gauge",
    "Pulses",
    "disagreements",
    "four_quadrant_curve",
    "open_water_curve",
    "vessel_text",
    "write_vessel",
]
