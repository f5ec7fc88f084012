"""The tests of a campaign in the recorded set point: found, matched with what was asked, and timed."""

from shaftprint.signals.excitation._found_test import FoundTest, common_shift_s
from shaftprint.signals.excitation._found_tests import found_tests
from shaftprint.signals.excitation._match import expect_campaign, left_out
from shaftprint.signals.excitation._message_lines import joined_about_lines
from shaftprint.signals.excitation._proposed_campaign import proposed_campaign
from shaftprint.signals.excitation._quantum import rounding_error, steps_of_sine, take_out_steps
from shaftprint.signals.excitation._steps import find_step_delays

__all__ = [
    "FoundTest",
    "common_shift_s",
    "expect_campaign",
    "find_step_delays",
    "found_tests",
    "joined_about_lines",
    "left_out",
    "proposed_campaign",
    "rounding_error",
    "steps_of_sine",
    "take_out_steps",
]
