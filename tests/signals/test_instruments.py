"""Speeds that an instrument gives: what a unit means, latency, slow channels, and what has failed."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals import content_of, prepare_signals
from shaftprint.vessel import SpeedSensor, Vessel

# What instruments show at 20 turns a second.
WAYS = {
    "rpm": ({}, 1200.0),
    "rev/s": ({}, 20.0),
    "rad/s": ({}, 125.66370614),
    "deg/s": ({}, 7200.0),
    "Hz": ({"pulses_per_revolution": 120}, 2400.0),
    "Hz of a wheel": ({"wheel": "60-2"}, 1160.0),
    "Hz of a wheel with more": ({"wheel": "12+1"}, 260.0),
    "m/s": ({"diameter_m": 0.25}, 15.70796327),
    "mA": ({"rpm_per_unit": 125.0, "rpm_at_zero": -500.0}, 13.6),
    "V": ({"rpm_per_unit": -240.0, "rpm_at_zero": 0.0}, -5.0),
}


def sensor(way, **more):
    fields, _ = WAYS[way]
    return SpeedSensor.model_validate(
        {"name": "n_x", "channel": "X", "shaft": "engine", "unit": way.split(" ")[0]} | fields | more
    )


def shown_for(way, speed_rev_s):
    """The reading for a speed, by the straight line through the one at 20 rev/s."""
    _, at_20 = WAYS[way]
    at_rest = 4.0 if way == "mA" else 0.0
    return at_rest + (at_20 - at_rest) * speed_rev_s / 20.0


@pytest.mark.parametrize("way", WAYS)
def test_units_mean_what_they_say(way):
    assert sensor(way).speed_rev_s([WAYS[way][1]]) == pytest.approx([20.0], rel=1e-9)
    assert not sensor(way).gives_pulses


def vessel_with(vessel, *speeds):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [speed.model_dump() for speed in speeds]
    return Vessel.model_validate(content)


def recording_with(ship, values, make_channel, *, unit, rate_hz):
    recording = replace(ship, prepared=ship).recording()
    channels = dict(recording.channels) | {"X": make_channel(values, name="X", unit=unit, rate_hz=rate_hz)}
    return Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)


@pytest.mark.parametrize("way", ["rpm", "mA", "V", "Hz of a wheel"])
def test_a_speed_is_followed_with_its_latency_taken_off(way, vessel, ship, campaign, make_channel):
    late = np.interp(ship.time_s - 0.05, ship.time_s, ship.speed_rev_s)
    noise = 1.0 + 1e-4 * np.random.default_rng(3).standard_normal(late.size)
    one = sensor(way, latency_s=0.05)
    raw = recording_with(ship, shown_for(way, late * noise), make_channel, unit=one.unit, rate_hz=2000.0)
    signals = prepare_signals(raw, vessel_with(vessel, one), campaign)
    speed = signals.speeds["n_x"]
    true = np.interp(np.arange(speed.values.size) / 200.0, ship.time_s, ship.speed_rev_s)
    inside = slice(40, -40)
    # steps of the staircase have corners, which the filter rounds off
    assert np.sqrt(np.mean((speed.values[inside] / true[inside] - 1.0) ** 2)) < 1e-3
    assert speed.values[inside].mean() == pytest.approx(true[inside].mean(), rel=1e-5)
    # as many values a second at any speed
    assert (speed.nyquist_hz, speed.by_angle) == (1000.0, False)
    assert signals.strips == ()


def test_a_slow_speed_is_joined_by_a_spline(vessel, ship, campaign, make_channel):
    # 20 values a second: the fastest line of the campaign, 0.15 Hz, is far below
    shown = 60.0 * ship.speed_rev_s[::100]
    raw = recording_with(ship, shown, make_channel, unit="rpm", rate_hz=20.0)
    signals = prepare_signals(raw, vessel_with(vessel, sensor("rpm")), campaign)
    speed = signals.speeds["n_x"]
    true = np.interp(np.arange(speed.values.size) / 200.0, ship.time_s, ship.speed_rev_s)
    sines = slice(200 * 118, 200 * 159)
    assert speed.values[sines] == pytest.approx(true[sines], rel=1e-4)
    assert speed.nyquist_hz == 10.0
    # by the law of the cardinal spline: a sine at three tenths of the rate is 0.963 of itself
    assert speed.gain(6.0) == pytest.approx(0.963, abs=1e-3)


def test_messages_are_joined_by_a_spline_through_their_own_times(vessel, ship, campaign, make_channel):
    """SPN 190: 0.125 rpm every 20 ms, 15 % of jitter, 1 % lost, and nothing at all from 200.0 to 201.0 s."""
    rng = np.random.default_rng(5)
    times = 0.0137 + 0.02 * np.arange(12_490) + 0.003 * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, 12_490)
    times = times[(rng.random(times.size) > 0.01) & ((times < 200.0) | (times > 201.0))]
    shown = 0.125 * np.rint(60.0 * np.interp(times - 0.02, ship.time_s, ship.speed_rev_s) / 0.125)
    # "not available" is beyond the range of the message
    shown[5000] = np.nan
    bus = replace(
        make_channel(shown, name="X", unit="rpm", rate_hz=50.0, start_s=float(times[0])),
        stamps=lambda first, stop: times[first:stop],
        is_uneven=True,
    )
    raw = recording_with(ship, shown, make_channel, unit="rpm", rate_hz=50.0)
    raw = replace(raw, channels=dict(raw.channels) | {"X": bus})
    signals = prepare_signals(raw, vessel_with(vessel, sensor("rpm", latency_s=0.02)), campaign)
    speed = signals.speeds["n_x"]
    true = np.interp(signals.start_s + np.arange(speed.values.size) / 200.0, ship.time_s, ship.speed_rev_s)
    sines = slice(200 * 118, 200 * 159)
    # steps of 0.125 rpm, which a spline between them hardly enlarges
    assert np.abs(speed.values[sines] - true[sines]).max() < 0.125 / 60.0
    assert (speed.values[sines] - true[sines]).mean() == pytest.approx(0.0, abs=0.01 / 60.0)
    assert speed.nyquist_hz == 25.0
    (gap,) = signals.gaps
    assert (gap.start_s, gap.stop_s) == (pytest.approx(199.98, abs=0.03), pytest.approx(200.98, abs=0.03))
    assert any("X has times of its own: a message every 20 ms" in finding for finding in signals.findings)
    pulses = replace(bus, name="PTM_e", unit="V")
    raw = replace(raw, channels=dict(raw.channels) | {"PTM_e": pulses})
    with pytest.raises(
        SignalError, match=r"channel PTM_e: expected samples at one rate for the speed n_e, found a mess"
    ):
        prepare_signals(raw, vessel, campaign)


def test_pick_up_and_instrument_are_held_against_each_other(vessel, ship, campaign, make_channel):
    shown = 1.03 * 60.0 * ship.speed_rev_s
    raw = recording_with(ship, shown, make_channel, unit="rpm", rate_hz=2000.0)
    pick_up = vessel.sensors.speed[0]
    with pytest.raises(SignalError, match=r"channels PTM_e and X: .* found n_x / n_e = 1\.03"):
        prepare_signals(raw, vessel_with(vessel, pick_up, sensor("rpm")), campaign)


def test_a_current_loop_that_breaks_is_a_gap(vessel, ship, campaign, make_channel):
    shown = shown_for("mA", ship.speed_rev_s)
    shown[round(100.0 * 2000) : round(105.0 * 2000)] = 0.0
    raw = recording_with(ship, shown, make_channel, unit="mA", rate_hz=2000.0)
    signals = prepare_signals(raw, vessel_with(vessel, sensor("mA")), campaign)
    assert [(gap.channel, round(gap.start_s, 2), round(gap.stop_s, 2)) for gap in signals.gaps] == [("X", 100.0, 105.0)]


def test_a_speed_below_zero_is_refused(vessel, ship, campaign, make_channel):
    raw = recording_with(ship, -60.0 * ship.speed_rev_s, make_channel, unit="rpm", rate_hz=2000.0)
    with pytest.raises(SignalError, match=r"channel X: expected a speed ahead, found a mean of -1\d{3} rpm"):
        prepare_signals(raw, vessel_with(vessel, sensor("rpm")), campaign)


def test_two_recordings_can_be_compared_by_a_speed_channel(make_channel):
    channel = make_channel(np.full(4000, 1200.0), name="X", unit="rpm")
    assert content_of(channel, sensor("rpm"), rate_hz=50.0).values == pytest.approx(np.full(100, 20.0), rel=1e-6)


def test_messages_can_be_compared_with_another_recording(make_channel):
    """A speed that gains 30 rpm a second, in messages that come when they like; pulses in their place are refused."""
    times = 3.0 + 0.02 * np.arange(2000) + np.random.default_rng(1).uniform(0.0, 0.008, 2000)
    values = 1200.0 + 30.0 * times
    bus = replace(
        make_channel(values, name="X", unit="rpm", rate_hz=50.0, start_s=float(times[0])),
        stamps=lambda first, stop: times[first:stop],
        is_uneven=True,
    )
    shown = content_of(bus, sensor("rpm"), rate_hz=20.0)
    assert (shown.rate_hz, shown.start_s) == (20.0, times[0])
    assert shown.values[:-2] == pytest.approx(20.0 + 0.5 * shown.time_s[:-2], rel=1e-9)
    pulses = SpeedSensor.model_validate(
        {"name": "n", "channel": "X", "shaft": "engine", "unit": "V", "pulses_per_revolution": 1}
    )
    with pytest.raises(
        SignalError, match="channel X: expected samples at one rate for pulses or an angle, found a mess"
    ):
        content_of(bus, pulses, rate_hz=20.0)
