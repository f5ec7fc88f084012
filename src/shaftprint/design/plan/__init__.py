"""The noun ``Plan`` with its parts: legs, how time is divided, and the campaign that it becomes."""

from shaftprint.design.plan._campaign import campaign_of
from shaftprint.design.plan._leg import Leg, odd_harmonics, strong_lines
from shaftprint.design.plan._plan import Peaks, Plan, SailedTest, peaks_of, predicted_accuracy
from shaftprint.design.plan._timetable import FEWEST_PERIODS, Timetable

__all__ = [
    "FEWEST_PERIODS",
    "Leg",
    "Peaks",
    "Plan",
    "SailedTest",
    "Timetable",
    "campaign_of",
    "odd_harmonics",
    "peaks_of",
    "predicted_accuracy",
    "strong_lines",
]
