"""What cannot be sailed is refused with a message that says why."""

import pytest
from pydantic import ValidationError

from shaftprint.campaign import Campaign, Sine, Staircase
from shaftprint.campaign._excitations import Chirp

SINE = {"name": "S1", "frequency_hz": 0.5, "amplitude_v": 0.6, "start_s": 10.0, "settled_s": 20.0, "stop_s": 50.0}
CHIRP = {
    "name": "C1",
    "start_frequency_hz": 0.01,
    "stop_frequency_hz": 1.0,
    "amplitude_v": 0.5,
    "start_s": 60.0,
    "stop_s": 90.0,
}


def _campaign(**changed):
    return Campaign(**({"name": "test", "duration_s": 100.0, "offset_v": -5.0, "sines": (Sine(**SINE),)} | changed))


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"settled_s": 5.0}, "start_s <= settled_s < stop_s, found 10, 5, 50"),
        ({"stop_s": 20.0}, "start_s <= settled_s < stop_s"),
        ({"frequency_hz": 0.03}, "at least one period of 33.3333 s between settled_s and stop_s, found 30 s"),
        ({"frequency_hz": -0.5}, "greater than 0"),
    ],
)
def test_an_impossible_sine_is_refused(changed, expected):
    with pytest.raises(ValidationError, match=expected):
        Sine(**(SINE | changed))


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({"stop_s": 60.0}, "start_s < stop_s, found 60, 60"),
        ({"stop_frequency_hz": 0.01}, "two different frequencies, found 0.01 Hz twice"),
        ({"stop_s": 60.0, "stop_frequency_hz": 0.01}, "start_s < stop_s, found 60, 60. expected two different"),
    ],
)
def test_an_impossible_chirp_is_refused(changed, expected):
    with pytest.raises(ValidationError, match=expected):
        Chirp(**(CHIRP | changed))


def test_a_window_of_exactly_one_period_is_accepted():
    # 0.3 - 0.2 is a little less than 0.1 in binary numbers
    sine = Sine(name="S", frequency_hz=10.0, amplitude_v=1.0, start_s=0.1, settled_s=0.2, stop_s=0.3)
    assert sine.periods == 1
    assert sine.window_stop_s == pytest.approx(0.3)


def test_a_stop_that_a_sum_makes_later_than_the_end_by_its_rounding_is_accepted():
    # 0.1 + 6 * 0.1 is a little more than 0.7 in binary numbers
    stairs = Staircase(name="St1", levels_v=(-4.0, -5.0, -6.0, -5.0, -4.0, -5.0), dwell_s=0.1, start_s=0.1)
    later = Sine(name="S", frequency_hz=10.0, amplitude_v=1.0, start_s=0.7, settled_s=0.8, stop_s=1.0)
    assert stairs.stop_s > 0.7
    assert _campaign(duration_s=0.7, sines=(), staircases=(stairs,)).duration_s == 0.7
    assert _campaign(duration_s=1.0, sines=(later,), staircases=(stairs,)).sines == (later,)


def test_overlaps_are_refused_with_both_names():
    stairs = Staircase(name="St1", levels_v=(-3.0, -4.0), dwell_s=10.0, start_s=40.0)
    with pytest.raises(ValidationError, match="St1 to start after S1 has stopped at 50 s, found a start at 40 s"):
        _campaign(staircases=(stairs,))


def test_an_excitation_may_start_where_another_stops():
    assert _campaign(chirps=(Chirp(**(CHIRP | {"start_s": 50.0})),)).excitations[1].name == "C1"


def test_several_faults_are_told_together():
    chirp = Chirp(**(CHIRP | {"name": "S1", "stop_s": 200.0}))
    with pytest.raises(ValidationError) as found:
        _campaign(chirps=(chirp,), sample_rate_hz=2.0)
    message = str(found.value)
    assert "every excitation to have its own name, found S1 twice" in message
    assert "expected S1 to stop within duration_s = 100, found a stop at 200 s" in message
    assert "expected S1 below half of sample_rate_hz, 1 Hz, found 1 Hz" in message


def test_a_campaign_without_excitation_is_refused():
    with pytest.raises(
        ValidationError, match="at least one sine, multisine, binary sequence, chirp or staircase, found none"
    ):
        _campaign(sines=())


def test_a_staircase_needs_a_level():
    with pytest.raises(ValidationError, match="at least 1 item"):
        Staircase(name="St1", levels_v=(), dwell_s=10.0, start_s=40.0)
