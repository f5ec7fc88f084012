"""The linear model of a structure about its working point, with exact delays, in the form that other programs take."""

from shaftprint.export.linear._delay_model import DelayModel, delay_model
from shaftprint.export.linear._past_rates import without_past_rates

__all__ = [
    "DelayModel",
    "delay_model",
    "without_past_rates",
]
