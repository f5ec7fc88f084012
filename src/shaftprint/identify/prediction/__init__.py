"""What a test can find, before it is made: from the equations alone, or from its plan and the noise."""

from shaftprint.identify.prediction._accuracy import (
    Accuracy,
    predict_accuracy,
    predict_joint_accuracy,
    predict_joint_deviations,
)
from shaftprint.identify.prediction._combinator_noise import COMBINATOR_NOISE
from shaftprint.identify.prediction._formulas import unit_of
from shaftprint.identify.prediction._identifiability import Identifiability, identifiability
from shaftprint.identify.prediction._inseparable_groups import Group
from shaftprint.identify.prediction._line_information import LineInformation, line_information
from shaftprint.identify.prediction._log_noise import with_log
from shaftprint.identify.prediction._lost_directions import Direction
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels, noise_levels, stated_noise
from shaftprint.identify.prediction._noise_of_line import noise_of_line
from shaftprint.identify.prediction._order_cost import common_share
from shaftprint.identify.prediction._pitch_noise import PITCH_NOISE
from shaftprint.identify.prediction._planned_legs import PlannedLeg, first_leg, planned_beside, planned_legs
from shaftprint.identify.prediction._planned_response import expected_response, planned_lines, planned_response
from shaftprint.identify.prediction._predicted_intervals import predict_intervals, predict_joint_intervals
from shaftprint.identify.prediction._research_vessel_noise import RESEARCH_VESSEL_NOISE
from shaftprint.identify.prediction._stan_tug_noise import STAN_TUG_NOISE
from shaftprint.identify.prediction._stan_tug_noise_at_speeds import STAN_TUG_LINE, STAN_TUG_NOISE_AT_SPEEDS
from shaftprint.identify.prediction._stan_tug_noise_underway import STAN_TUG_NOISE_UNDERWAY

__all__ = [
    "COMBINATOR_NOISE",
    "PITCH_NOISE",
    "RESEARCH_VESSEL_NOISE",
    "STAN_TUG_LINE",
    "STAN_TUG_NOISE",
    "STAN_TUG_NOISE_AT_SPEEDS",
    "STAN_TUG_NOISE_UNDERWAY",
    "Accuracy",
    "Direction",
    "Group",
    "Identifiability",
    "LineInformation",
    "NoiseLevels",
    "PlannedLeg",
    "common_share",
    "expected_response",
    "first_leg",
    "identifiability",
    "line_information",
    "noise_at",
    "noise_levels",
    "noise_of_line",
    "planned_beside",
    "planned_legs",
    "planned_lines",
    "planned_response",
    "predict_accuracy",
    "predict_intervals",
    "predict_joint_accuracy",
    "predict_joint_deviations",
    "predict_joint_intervals",
    "stated_noise",
    "unit_of",
    "with_log",
]
