"""Two inputs moved in one leg: lines of their own, one period, and what a campaign file may not ask."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign, load_campaign, setpoint
from shaftprint.campaign._file_text import campaign_text

PERIOD_S = 20.0
TIMES = {"start_s": 10.0, "settled_s": 30.0, "stop_s": 110.0, "period_s": PERIOD_S}
SPEED = {
    "name": "M1",
    "level_v": -5.0,
    "harmonics": [1, 5],
    "amplitudes_v": [0.1, 0.2],
    "phases_rad": [0.0, 1.0],
    **TIMES,
}
PITCH = {
    "name": "P1",
    "input": "pitch_set_point",
    "level_v": 4.0,
    "harmonics": [3],
    "amplitudes_v": [0.5],
    "phases_rad": [0.0],
    **TIMES,
}


def campaign(pitch=(), **more):
    content = {"name": "both", "duration_s": 130.0, "offset_v": -5.0, "ramp_s": 2.0}
    content |= {"multisines": [SPEED, PITCH | dict(pitch)], "further_offsets_v": {"pitch_set_point": 4.0}}
    return Campaign.model_validate(content | more)


def test_each_input_moves_with_its_own_lines():
    both = campaign()
    assert both.inputs == ("set_point", "pitch_set_point")
    assert [leg.name for leg in both.legs] == ["M1"]
    assert [one.name for one in both.beside(both.legs[0])] == ["P1"]
    time = np.array([5.0, 10.0 + PERIOD_S / 12.0, 120.0])
    # the third harmonic is at its crest after a twelfth of the period
    assert setpoint(both, time, input="pitch_set_point") == pytest.approx([4.0, 4.5, 4.0])
    alone = Campaign.model_validate(both.model_dump() | {"multisines": [SPEED], "further_offsets_v": {}})
    assert np.array_equal(setpoint(both, time), setpoint(alone, time))


@pytest.mark.parametrize(
    ("pitch", "more", "message"),
    [
        ({"harmonics": [5]}, {}, r"expected P1 to have harmonics of its own, found 5 in M1 too"),
        ({"period_s": 16.0}, {}, r"expected P1, which moves pitch_set_point, beside a multisine of the speed"),
        ({"start_s": 12.0}, {}, r"beside a multisine of the speed with the same start_s"),
        ({"level_v": 3.0}, {}, r"expected level_v of P1 to be further_offsets_v\.pitch_set_point = 4"),
        ({}, {"further_offsets_v": {}}, r"expected further_offsets_v\.pitch_set_point, the middle of the tests"),
        ({"name": "M1"}, {}, r"expected every excitation to have its own name, found M1 twice"),
    ],
)
def test_what_cannot_be_told_apart_is_refused(pitch, more, message):
    with pytest.raises(ValueError, match=message):
        campaign(pitch, **more)


def test_a_file_of_two_inputs_is_read_back_equal(tmp_path):
    path = tmp_path / "both.toml"
    path.write_text(campaign_text(campaign()), encoding="utf-8")
    assert load_campaign(path) == campaign()
    assert campaign_text(campaign()).count("input = ") == 1


def test_shipped_campaign_has_odd_lines_that_stay_apart():
    shipped = load_campaign("pitch")
    lines = [line for one in shipped.multisines for line in one.harmonics]
    assert len(lines) == len(set(lines))
    assert all(line % 2 for line in lines)
