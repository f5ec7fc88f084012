"""What a governor with limits predicts of a test from its set point, and its prediction errors without their colour."""

from shaftprint.limits.prediction._governor_test import GovernorTest, governor_test, sum_of_jumps
from shaftprint.limits.prediction._held_set_point import Messages, explained, messages_of
from shaftprint.limits.prediction._noise_colour import ORDER, Innovations, innovations
from shaftprint.limits.prediction._prediction_error import OUTPUT, PredictedTorque, PredictionError
from shaftprint.limits.prediction._reach import Reach
from shaftprint.limits.prediction._set_point import GovernorRecord, rate_limited

__all__ = [
    "ORDER",
    "OUTPUT",
    "GovernorRecord",
    "GovernorTest",
    "Innovations",
    "Messages",
    "PredictedTorque",
    "PredictionError",
    "Reach",
    "explained",
    "governor_test",
    "innovations",
    "messages_of",
    "rate_limited",
    "sum_of_jumps",
]
