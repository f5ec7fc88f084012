"""What a counterpart says of itself in plain messages: descriptions that make no channel are refused in a sentence."""

import json
from dataclasses import asdict

import pytest

from shaftprint.live._block import LiveChannel
from shaftprint.live._counterpart import Abilities
from shaftprint.live.counterparts._dialect import Description
from shaftprint.live.counterparts._plain import PlainDialect, described

CHANNEL = LiveChannel(name="U", unit="V", rate_hz=2000.0, scale=0.5, dtype="int16")


def heard(**wrong):
    told = json.loads(described(Description(channels=(CHANNEL,), abilities=Abilities())))
    told["channels"] = [asdict(CHANNEL) | wrong]
    return PlainDialect(prefix="ship").heard("ship/describe", json.dumps(told).encode(), 0.0)


def test_a_description_comes_back_as_it_was_said():
    assert heard().channels == (CHANNEL,)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"rate_hz": 10**400}, "expected numbers for rate, scale and offset"),
        ({"offset": "much"}, "expected numbers for rate, scale and offset"),
        ({"dtype": []}, "expected channels of int16 or float64"),
        ({"scale": 0.0}, "expected a positive rate and a scale of channels, found 2000 and 0"),
        ({"rate_hz": -1.0}, "expected a positive rate and a scale of channels, found -1 and 0.5"),
    ],
)
def test_channels_that_are_none_are_refused(wrong, words):
    with pytest.raises(ValueError, match=words):
        heard(**wrong)
