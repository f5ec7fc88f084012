"""The noun ``Plan`` with its parts: legs, how time is divided, and the campaign that it becomes."""

from shaftprint.design.plan._band import HELD, Band
from shaftprint.design.plan._campaign import campaign_of
from shaftprint.design.plan._leg import Leg, odd_harmonics, strong_lines
from shaftprint.design.plan._plan import (
    Peaks,
    Plan,
    SailedTest,
    length_words,
    noise_freedom,
    peaks_of,
    predicted_accuracy,
)
from shaftprint.design.plan._timetable import FEWEST_PERIODS, STAIRS, Timetable

__all__ = [
    "FEWEST_PERIODS",
    "HELD",
    "STAIRS",
    "Band",
    "Leg",
    "Peaks",
    "Plan",
    "SailedTest",
    "Timetable",
    "campaign_of",
    "length_words",
    "noise_freedom",
    "odd_harmonics",
    "peaks_of",
    "predicted_accuracy",
    "strong_lines",
]
