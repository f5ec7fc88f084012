"""What a test can find, before it is made: from the equations alone, or from its plan and the noise."""

from shaftprint.identify.prediction._accuracy import Accuracy, predict_accuracy, predict_joint_accuracy
from shaftprint.identify.prediction._formulas import unit_of
from shaftprint.identify.prediction._identifiability import Identifiability, identifiability
from shaftprint.identify.prediction._inseparable_groups import Group
from shaftprint.identify.prediction._line_information import LineInformation, line_information
from shaftprint.identify.prediction._lost_directions import Direction
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels, noise_levels, stated_noise
from shaftprint.identify.prediction._planned_legs import PlannedLeg, planned_legs
from shaftprint.identify.prediction._planned_response import expected_response, planned_lines, planned_response
from shaftprint.identify.prediction._predicted_intervals import predict_intervals, predict_joint_intervals
from shaftprint.identify.prediction._stan_tug_noise import STAN_TUG_NOISE

__all__ = [
    "STAN_TUG_NOISE",
    "Accuracy",
    "Direction",
    "Group",
    "Identifiability",
    "LineInformation",
    "NoiseLevels",
    "PlannedLeg",
    "expected_response",
    "identifiability",
    "line_information",
    "noise_at",
    "noise_levels",
    "planned_legs",
    "planned_lines",
    "planned_response",
    "predict_accuracy",
    "predict_intervals",
    "predict_joint_accuracy",
    "predict_joint_intervals",
    "stated_noise",
    "unit_of",
]
