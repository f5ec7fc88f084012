"""A campaign with its tests chosen by eye."""

import tomllib

import pytest
from pydantic import ValidationError

from shaftprint.campaign import Campaign
from shaftprint.campaign._chosen import Choice, chosen
from shaftprint.campaign._file_text import campaign_text

SINES = """
name = "two sines"
duration_s = 100.0
ramp_s = 1.0
offset_v = -5.0
[further_offsets_v]
pitch = 1.0
[[staircases]]
name = "St1"
levels_v = [-4.0, -6.0]
dwell_s = 5.0
start_s = 0.0
[[sines]]
name = "S1"
frequency_hz = 0.5
amplitude_v = 0.5
start_s = 20.0
settled_s = 24.0
stop_s = 40.0
[[multisines]]
name = "M1"
level_v = -5.0
start_s = 50.0
settled_s = 52.0
stop_s = 72.0
period_s = 10.0
harmonics = [1]
amplitudes_v = [0.1]
phases_rad = [0.0]
[[multisines]]
name = "P1"
input = "pitch"
level_v = 1.0
start_s = 50.0
settled_s = 52.0
stop_s = 72.0
period_s = 10.0
harmonics = [2]
amplitudes_v = [0.1]
phases_rad = [0.0]
"""


@pytest.fixture
def campaign():
    return Campaign.model_validate(tomllib.loads(SINES))


def test_what_nothing_is_chosen_of_is_the_same_to_the_last_digit(campaign):
    assert chosen(campaign, {}) == campaign
    assert chosen(campaign, {"S1": Choice(), "M1": Choice()}) == campaign


def test_a_test_is_moved_and_its_window_within_it(campaign):
    (sine,) = chosen(campaign, {"S1": Choice(later_s=1.1, from_later_s=0.5, to_later_s=-3.0)}).sines
    assert (sine.start_s, sine.settled_s, sine.stop_s) == (21.1, 25.6, 38.1)


def test_what_moves_something_else_goes_with_its_leg(campaign):
    moved = chosen(campaign, {"M1": Choice(later_s=2.0)})
    assert {(one.name, one.start_s, one.stop_s) for one in moved.multisines} == {("M1", 52, 74), ("P1", 52, 74)}
    assert chosen(campaign, {"M1": Choice(is_used=False)}).multisines == ()


def test_the_campaign_becomes_as_long_as_its_tests(campaign):
    assert chosen(campaign, {"M1": Choice(later_s=40.0)}).duration_s == 140.0
    with pytest.raises(ValidationError, match="M1 to start after S1 has stopped at 60 s"):
        chosen(campaign, {"S1": Choice(later_s=20.0)})


@pytest.mark.parametrize(
    ("choices", "words"),
    [
        ({"S1": Choice(to_later_s=-15.0)}, "at least one period of 2 s"),
        ({"S1": Choice(from_later_s=-5.0)}, "expected start_s <= settled_s"),
        (dict.fromkeys(("St1", "S1", "M1"), Choice(is_used=False)), "found none"),
    ],
)
def test_what_is_no_campaign_is_refused(campaign, choices, words):
    with pytest.raises(ValidationError, match=words):
        chosen(campaign, choices)


def test_the_file_is_read_back_equal(campaign):
    moved = chosen(campaign, {"S1": Choice(later_s=0.3), "St1": Choice(is_used=False)})
    assert Campaign.model_validate(tomllib.loads(campaign_text(moved, remarks="by eye"))) == moved
