"""Campaigns of both shafts: in turn, at once, and those that could not be told apart."""

from typing import Any

import numpy as np
import pytest

from shaftprint.campaign import CampaignOfBoth
from shaftprint.campaign._both_shafts import load_campaign_of_both
from shaftprint.errors import SettingsError


def leg(harmonics: list[int], start_s: float = 10.0, **change: Any) -> dict[str, Any]:
    lines = len(harmonics)
    return {
        "name": "M1",
        "level_v": -5.0,
        "start_s": start_s,
        "settled_s": start_s + 10.0,
        "stop_s": start_s + 60.5,
        "period_s": 25.0,
        "harmonics": harmonics,
        "amplitudes_v": [0.1] * lines,
        "phases_rad": [0.0] * lines,
    } | change


def side(*legs: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"offset_v": -5.0, "ramp_s": 3.0, "multisines": list(legs)} | more


def both(port: dict[str, Any], starboard: dict[str, Any], excited: str = "at once", **more: Any) -> CampaignOfBoth:
    content = {"name": "Both", "duration_s": 200.0, "excited": excited, "port": port, "starboard": starboard}
    return CampaignOfBoth.model_validate(content | more)


def test_sides_are_campaigns_of_one_recording() -> None:
    campaign = both(side(leg([1, 5])), side(leg([3, 7])), place="Quay 12")
    assert [one.name for one in campaign.sides] == ["Both, port", "Both, starboard"]
    assert {(one.duration_s, one.place) for one in campaign.sides} == {(200.0, "Quay 12")}


@pytest.mark.parametrize("name", ["at-once", "in-turn"])
def test_lines_of_one_side_are_nothing_in_the_lines_of_the_other(name: str) -> None:
    """Over the whole periods of a leg, the set point of the other side has no part in the leg's lines."""
    campaign = load_campaign_of_both(name)
    for own, other in (campaign.sides, campaign.sides[::-1]):
        for test in own.multisines:
            samples = 4096
            time_s = test.settled_s + test.period_s * np.arange(samples) / samples
            values = np.full(samples, other.offset_v)
            for one in other.multisines:
                if one.start_s <= test.settled_s < one.stop_s:
                    values = one.value_at(time_s)
            lines = np.abs(np.fft.rfft(values)[list(test.harmonics)]) * 2.0 / samples
            assert lines.max() < 1e-9


@pytest.mark.parametrize(
    ("port", "starboard", "excited", "said"),
    [
        (side(leg([1, 5])), side(leg([5, 9])), "at once", "found 1 lines in both, the first at 0.2 Hz"),
        (side(leg([1, 5])), side(leg([1, 5])), "at once", "found 2 lines in both, the first at 0.04 Hz"),
        (side(leg([1, 5])), side(leg([3, 7])), "in turn", "found both from 10 to 70.5 s"),
        (side(leg([1, 5])), side(leg([3, 7], period_s=24.0)), "at once", "expected the same start_s, settled_s"),
        (side(leg([1, 5])), side(leg([3, 7], start_s=11.0)), "at once", "expected the same start_s, settled_s"),
        (side(leg([1, 5])), side(leg([3, 7], start_s=90.0)), "at once", 'found none; say "in turn"'),
        (
            side(leg([1, 5])),
            {"offset_v": -5.0, "staircases": [{"name": "St", "levels_v": [-4.0], "dwell_s": 9.0, "start_s": 20.0}]},
            "at once",
            "expected multisines where both sides are excited at once",
        ),
        (
            side(leg([1, 5])),
            side(leg([3, 7], start_s=75.0, level_v=-4.0), ramp_s=10.0),
            "in turn",
            "expected the other side to stand still during port.M1",
        ),
    ],
)
def test_sides_that_could_not_be_told_apart_are_refused_in_one_sentence(
    port: dict[str, Any], starboard: dict[str, Any], excited: str, said: str
) -> None:
    with pytest.raises(ValueError, match=said) as refused:
        both(port, starboard, excited)
    assert len(refused.value.errors()) == 1  # type: ignore[attr-defined]


def test_what_stands_once_for_both_is_refused_in_a_side() -> None:
    with pytest.raises(ValueError, match=r"expected port\.duration_s left out"):
        both(side(leg([1, 5]), duration_s=100.0), side(leg([3, 7])))


def test_unknown_name_lists_those_that_are_shipped() -> None:
    with pytest.raises(SettingsError, match="at-once, in-turn"):
        load_campaign_of_both("thesis")
