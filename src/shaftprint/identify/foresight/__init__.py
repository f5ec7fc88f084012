"""What a test can find, before it is made: from the equations alone, or from its plan and the noise."""

from shaftprint.identify.foresight._accuracy import Accuracy, predict_accuracy, predict_joint_accuracy
from shaftprint.identify.foresight._directions import Direction
from shaftprint.identify.foresight._groups import Group
from shaftprint.identify.foresight._identifiability import Identifiability, identifiability
from shaftprint.identify.foresight._noise_levels import NoiseLevels, noise_levels, stated_noise
from shaftprint.identify.foresight._planned_response import expected_response, planned_lines, planned_response
from shaftprint.identify.foresight._predicted_intervals import predict_intervals
from shaftprint.identify.foresight._stan_tug_noise import STAN_TUG_NOISE

__all__ = [
    "STAN_TUG_NOISE",
    "Accuracy",
    "Direction",
    "Group",
    "Identifiability",
    "NoiseLevels",
    "expected_response",
    "identifiability",
    "noise_levels",
    "planned_lines",
    "planned_response",
    "predict_accuracy",
    "predict_intervals",
    "predict_joint_accuracy",
    "stated_noise",
]
