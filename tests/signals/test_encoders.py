"""Angles and counts of an encoder, unwrapped over their roll-over, against a shaft whose angle is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals import prepare_signals
from shaftprint.vessel import SpeedSensor, Vessel

# What is shown of an angle in turns, before it begins again, and what the vessel file says.
WAYS = {
    "degrees": (360.0, 360.0, {"unit": "deg"}),
    "degrees of one turn of two": (360.0, 720.0, {"unit": "deg", "rolls_over_at": 720.0}),
    "radians": (2.0 * np.pi, 2.0 * np.pi, {"unit": "rad"}),
    "counts": (4096.0, 65_536.0, {"unit": "counts", "counts_per_revolution": 4096.0, "rolls_over_at": 65_536.0}),
    "few counts": (100.0, 100.0, {"unit": "counts", "counts_per_revolution": 100.0}),
}


def shown(way, angle_rev, sign=1.0):
    per_rev, whole, fields = WAYS[way]
    value = sign * per_rev * angle_rev
    return (np.floor(value) if fields["unit"] == "counts" else value) % whole


def sensor(way):
    return SpeedSensor.model_validate({"name": "n_x", "channel": "X", "shaft": "engine"} | WAYS[way][2])


def prepared(way, values, vessel, ship, campaign, make_channel):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [sensor(way).model_dump()]
    recording = replace(ship, prepared=ship).recording()
    unit = WAYS[way][2]["unit"]
    channels = dict(recording.channels) | {"X": make_channel(values, name="X", unit=unit)}
    raw = Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)
    return prepare_signals(raw, Vessel.model_validate(content), campaign)


@pytest.mark.parametrize("way", WAYS)
def test_an_angle_gives_the_speed_through_its_roll_over(way, vessel, ship, campaign, make_channel):
    signals = prepared(way, shown(way, ship.angle_rev), vessel, ship, campaign, make_channel)
    speed = signals.speeds["n_x"]
    true = np.interp(speed_time(signals), ship.time_s, ship.speed_rev_s)
    inside = slice(40, -40)
    assert speed.values[inside].mean() == pytest.approx(true[inside].mean(), rel=2e-6)
    # a count in a hundred of a turn, in a filter of 5 ms
    limit = 2e-2 if way == "few counts" else 1e-3
    assert np.sqrt(np.mean((speed.values[inside] / true[inside] - 1.0) ** 2)) < limit
    assert all(one.channel != "X" for one in signals.repairs)


def speed_time(signals):
    return signals.start_s + np.arange(signals.engine_speed.values.size) / signals.rate_hz


def test_an_encoder_that_counts_down_is_turned_and_said_so(vessel, ship, campaign, make_channel):
    signals = prepared("counts", shown("counts", ship.angle_rev, -1.0), vessel, ship, campaign, make_channel)
    assert signals.engine_speed.values.mean() > 0.0
    assert "channel X counts down while the ship moves ahead: its sign was turned" in signals.findings


def test_a_wrong_bit_is_repaired(vessel, ship, campaign, make_channel):
    values = shown("counts", ship.angle_rev)
    values[200_000] = (values[200_000] + 8192.0) % 65_536.0
    signals = prepared("counts", values, vessel, ship, campaign, make_channel)
    clean = prepared("counts", shown("counts", ship.angle_rev), vessel, ship, campaign, make_channel)
    assert {one.channel for one in signals.repairs} >= {"X"}
    assert signals.engine_speed.values == pytest.approx(clean.engine_speed.values, rel=1e-3)


def test_an_angle_that_begins_again_too_often_is_refused(vessel, ship, campaign, make_channel):
    # an encoder that begins again after a hundredth of a turn, 2000 times a second
    values = 360.0 * ship.angle_rev % 3.6
    way = "degrees"
    content = sensor(way).model_dump() | {"rolls_over_at": 3.6}
    whole = vessel.model_dump()
    whole["sensors"]["speed"] = [content]
    recording = replace(ship, prepared=ship).recording()
    channels = dict(recording.channels) | {"X": make_channel(values, name="X", unit="deg")}
    raw = Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)
    with pytest.raises(SignalError, match=r"X: expected an angle that turns by less than 0\.4 of its range of 3\.6"):
        prepare_signals(raw, Vessel.model_validate(whole), campaign)


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({"unit": "counts"}, "expected counts_per_revolution for a channel in counts, found none"),
        ({"unit": "deg", "counts_per_revolution": 100.0}, "expected counts_per_revolution left out"),
        ({"unit": "rpm", "rolls_over_at": 360.0}, "expected rolls_over_at left out"),
    ],
)
def test_what_an_encoder_needs_is_asked_for(fields, expected):
    with pytest.raises(ValueError, match=expected):
        SpeedSensor.model_validate({"name": "n", "channel": "X", "shaft": "engine", **fields})
