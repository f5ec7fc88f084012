import math

import pytest

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.errors import ValidationError
from shaftprint.validation import ValidationSettings
from shaftprint.validation._validation_records import default_records, excerpts_of


def cut(campaign, records, *, used=(), allow_in_sample=False, **settings):
    return excerpts_of(
        campaign,
        records,
        used=used,
        allow_in_sample=allow_in_sample,
        settings=ValidationSettings(**settings),
    )


def test_short_chirp_and_steps_are_the_default():
    # the thesis identifies on sines and on the long chirp C21 to C23, and validates on C11 and the steps
    assert default_records(load_campaign("thesis"), ()) == ("C11", "St1", "St2")


def test_what_the_model_has_seen_is_no_default():
    thesis = load_campaign("thesis")
    assert default_records(thesis, ("S1", "St1", "C21")) == ("C11", "St2")


def test_bands_of_the_short_chirp_of_the_thesis():
    # 0.001 to 3.981 Hz in 600 s from 8850 s on: 1 rad/s is 0.159155 Hz, reached after
    # 600 ln(159.155) / ln(3981) = 600 * 5.069876 / 8.289288 = 366.97 s; 5 and 10 rad/s likewise
    bands = {e.title: (e.start_s, e.stop_s) for e in cut(load_campaign("thesis"), ["C11"])}
    assert bands["up to 1 rad/s"] == pytest.approx((8850.0, 9216.97), abs=0.01)
    assert bands["1 to 5 rad/s"] == pytest.approx((9216.97, 9333.46), abs=0.01)
    assert bands["5 to 10 rad/s"] == pytest.approx((9333.46, 9383.63), abs=0.01)
    assert bands["above 10 rad/s"] == pytest.approx((9383.63, 9450.0), abs=0.01)
    low, high = bands["about 10 rad/s"]
    assert high - low == pytest.approx(600.0 * math.log(11.0 / 9.0) / math.log(3981.0), abs=1e-6)


def test_a_chirp_from_high_to_low_is_cut_in_time():
    falling = {
        "name": "C",
        "start_frequency_hz": 4.0,
        "stop_frequency_hz": 0.01,
        "amplitude_v": 0.5,
        "start_s": 0,
        "stop_s": 100,
    }
    campaign = Campaign(name="falling", duration_s=100, offset_v=-5.0, chirps=(falling,))
    found = {e.title: e for e in cut(campaign, ["C"])}
    assert found["above 10 rad/s"].start_s == pytest.approx(0.0)
    assert found["up to 1 rad/s"].stop_s == pytest.approx(100.0)
    assert all(e.start_s < e.stop_s for e in found.values())


def test_bands_that_a_chirp_does_not_reach_are_left_out(campaign):
    # C21 ends at 0.2 Hz, 1.26 rad/s
    assert [e.title for e in cut(campaign, ["C21"])] == ["up to 1 rad/s", "1 to 5 rad/s"]


def test_steps_of_a_staircase(campaign):
    whole, *steps = cut(campaign, ["St1"])
    assert (whole.kind, whole.start_s, whole.stop_s) == ("staircase", 200.0, 360.0)
    assert [s.step_s for s in steps] == [200.0, 240.0, 280.0, 320.0]
    assert steps[1].title == "step at 240.0 s, -4 to -5 V"
    assert (steps[1].start_s, steps[1].stop_s) == (238.0, 252.0)


def test_a_level_that_does_not_change_is_no_step():
    stairs = {"name": "St", "levels_v": (-5, -4, -4), "dwell_s": 30, "start_s": 0}
    campaign = Campaign(name="few", duration_s=100, offset_v=-5.0, staircases=(stairs,))
    assert [e.step_s for e in cut(campaign, ["St"]) if e.kind == "step"] == [30.0]


def test_a_step_ends_before_the_next():
    stairs = {"name": "St", "levels_v": (-4, -5), "dwell_s": 8, "start_s": 20}
    campaign = Campaign(name="quick", duration_s=100, offset_v=-5.0, staircases=(stairs,))
    first = next(e for e in cut(campaign, ["St"]) if e.kind == "step")
    assert first.stop_s == pytest.approx(26.0)


def test_a_record_of_the_identification_is_refused(campaign):
    with pytest.raises(ValidationError, match=r"record C21: the model was identified from it"):
        cut(campaign, ["St1", "C21"], used=("C21", "S1"))


def test_a_record_of_the_identification_is_marked_where_it_is_allowed(campaign):
    found = cut(campaign, ["St1", "C21"], used=("C21",), allow_in_sample=True)
    assert {e.record for e in found if e.in_sample} == {"C21"}


def test_a_record_that_is_not_there(campaign):
    with pytest.raises(ValidationError, match=r"record C9: expected a chirp or staircase of campaign test, one of C11"):
        cut(campaign, ["C9"])


def test_a_campaign_of_sines_only_has_nothing_to_validate_on():
    campaign = Campaign(
        name="sines",
        duration_s=100.0,
        offset_v=-5.0,
        sines=({"name": "S1", "frequency_hz": 1, "amplitude_v": 0.5, "start_s": 1, "settled_s": 2, "stop_s": 50},),
    )
    with pytest.raises(ValidationError, match="found none; it has sines only"):
        cut(campaign, default_records(campaign, ()))


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ({"largest_error": 0.0}, "largest_error: expected a positive number, found 0.0"),
        ({"coverage": 1.0}, "coverage: expected a share below 1"),
        ({"band_edges_rad_s": (5.0, 1.0)}, "band_edges_rad_s: expected positive frequencies that ascend"),
        ({"about_rad_s": (-1.0, 1.0)}, "about_rad_s: expected positive frequencies that ascend"),
    ],
)
def test_settings_that_make_no_sense(setting, words):
    with pytest.raises(ValidationError, match=words):
        ValidationSettings(**setting)
