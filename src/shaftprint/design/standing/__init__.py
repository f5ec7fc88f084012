"""The noun ``Standing``: a planned test that was sailed in part, and what is still missing."""

from shaftprint.design.standing._periods import PeriodInformation, missing_periods
from shaftprint.design.standing._standing import Standing, standing_of

__all__ = [
    "PeriodInformation",
    "Standing",
    "missing_periods",
    "standing_of",
]
