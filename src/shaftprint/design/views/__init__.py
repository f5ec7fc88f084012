"""What is shown of a plan: motion over time, the worth of lines, other lengths, and the card for the bridge."""

from shaftprint.design.views._abort_card import AbortCard, abort_card
from shaftprint.design.views._line_worth import LineWorth, line_worths
from shaftprint.design.views._other_lengths import LengthCurve, length_curve
from shaftprint.design.views._planned_motion import PlannedMotion, planned_motion

__all__ = [
    "AbortCard",
    "LengthCurve",
    "LineWorth",
    "PlannedMotion",
    "abort_card",
    "length_curve",
    "line_worths",
    "planned_motion",
]
