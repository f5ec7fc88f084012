"""Angles and counts of an encoder, wrapped or not, against a shaft whose angle is known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.wheel_truth import Turning

from shaftprint.errors import SignalError
from shaftprint.recording import Recording
from shaftprint.signals import content_of, prepare_signals
from shaftprint.signals._channel_readings import read_channels
from shaftprint.vessel import SpeedSensor, Vessel

# What is shown for one turn, and where it begins again (never, where that is 0), with what the vessel file says.
WAYS = {
    "degrees": (360.0, 360.0, {"unit": "deg"}),
    "degrees about zero": (360.0, 360.0, {"unit": "deg"}),
    "degrees of two turns": (360.0, 720.0, {"unit": "deg", "rolls_over_at": 720.0}),
    "degrees without end": (360.0, 0.0, {"unit": "deg"}),
    "radians": (2.0 * np.pi, 2.0 * np.pi, {"unit": "rad"}),
    "turns": (1.0, 0.0, {"unit": "rev"}),
    "counts": (4096.0, 65_536.0, {"unit": "counts", "counts_per_revolution": 4096.0, "rolls_over_at": 65_536.0}),
    "counts of one turn": (1024.0, 1024.0, {"unit": "counts", "counts_per_revolution": 1024.0}),
    "counts without end": (5000.0, 0.0, {"unit": "counts", "counts_per_revolution": 5000.0}),
}
GEAR_RATIO = 3.82


def shown(way, angle_rev):
    per_rev, whole, fields = WAYS[way]
    value = per_rev * angle_rev
    if fields["unit"] == "counts":
        value = np.floor(value)
    if way == "degrees about zero":
        return (value + 180.0) % 360.0 - 180.0
    return value % whole if whole else value


def sensor(way, shaft="propeller", **more):
    return SpeedSensor.model_validate({"name": "n_x", "channel": "X", "shaft": shaft} | WAYS[way][2] | more)


def vessel_with(vessel, one):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [one.model_dump()]
    return Vessel.model_validate(content)


def read(values, one, vessel, make_channel, *, rate_hz=2000.0, start_s=0.0, chunk_s=None, **more):
    """What the channel of an encoder gives on a grid of 200 Hz, beside a gauge and a set point."""
    beside = np.random.default_rng(1).standard_normal(round(values.size / rate_hz * 2000.0))
    channels = {
        "X": make_channel(values, name="X", unit=one.unit, rate_hz=rate_hz, start_s=start_s, **more),
        "M_s": make_channel(beside, name="M_s"),
        "U_setpoint": make_channel(beside, name="U_setpoint"),
    }
    recording = Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)
    readings = read_channels(recording, vessel_with(vessel, one), chunk_s=chunk_s)
    if "n_x" in readings.problems:
        raise readings.problems["n_x"]
    source = next(source for source in readings.sources if source.name == "n_x")
    reading = readings.by_name["n_x"]
    return replace(reading, findings=source.kind.judge(source, reading))


def sampled(turning, rate_hz=2000.0, *, jitter_s=0.0, seed=0):
    """Angle of the shaft [rev] at the samples of a logger, each taken a little early or late."""
    time = np.arange(round(turning.duration_s * rate_hz)) / rate_hz
    late = jitter_s * np.random.default_rng(seed).standard_normal(time.size)
    return np.interp(time + late, turning.fine_s, turning.fine_rev)


@pytest.mark.parametrize("way", WAYS)
def test_the_mean_of_forty_seconds_from_rest_with_wrong_bits(way, vessel, make_channel):
    turning = Turning(run_up_s=3.0, rest_s=0.5)
    values = shown(way, sampled(turning, jitter_s=20e-6, seed=3))
    wrong = [20_000, 33_333, 61_001]
    whole = WAYS[way][1] or 8.0 * WAYS[way][0]
    values[wrong] = (values[wrong] + 0.25 * whole) % whole if WAYS[way][1] else values[wrong] + 0.25 * whole
    values[50_000:50_020] = np.nan
    reading = read(values, sensor(way), vessel, make_channel)
    true = GEAR_RATIO * turning.mean_speed(5.0 - 0.0025, 39.5 - 0.0025)
    assert reading.values[1000:7900].mean() == pytest.approx(true, rel=1e-4)
    assert reading.gaps == ()
    assert reading.findings == ()
    # a wrong value spoils the steps on both sides of it
    assert {round(one.time_s * 2000.0 / 50.0) * 50 for one in reading.repairs} == {20_000, 33_350, 61_000, 50_000}
    assert sum(one.count for one in reading.repairs) == 2 * len(wrong) + 21


@pytest.mark.parametrize("way", WAYS)
def test_the_speed_is_followed_through_every_roll_over(way, vessel, make_channel):
    turning = Turning(ripple=0.0, duration_s=25.0)
    reading = read(shown(way, sampled(turning)), sensor(way), vessel, make_channel)
    true = GEAR_RATIO * turning.speed_at(np.arange(5000) / 200.0)
    error = reading.values[100:4900] / true[100:4900] - 1.0
    # two counts of an evenly spread error in the time of the filter, a hundredth of a second at least
    counts = {"counts": 4096.0, "counts of one turn": 1024.0, "counts without end": 5000.0}.get(way, np.inf)
    assert np.sqrt(np.mean(error**2)) < 1e-5 + np.sqrt(2.0 / 12.0) / (counts * 5.0 * 0.01)
    assert abs(error.mean()) < 1e-5
    assert reading.repairs == []


@pytest.mark.parametrize(
    ("rate_hz", "swing_hz", "share"), [(20.0, 6.0, 0.963), (200.0, 20.0, 1.0), (1000.0, 30.0, 1.0)]
)
def test_a_swing_has_the_size_that_the_signal_says(rate_hz, swing_hz, share, vessel, make_channel):
    # of a slow channel by the law of the cardinal spline, of a fast one whole
    turning = Turning(ripple=0.0, swing=0.02, swing_hz=swing_hz, duration_s=30.0)
    reading = read(sampled(turning, rate_hz), sensor("turns"), vessel, make_channel, rate_hz=rate_hz)
    time = np.arange(1000, 5000) / 200.0
    swing = 2.0 * np.mean(reading.values[1000:5000] * np.exp(-2j * np.pi * swing_hz * time))
    # a sine, in phase
    assert swing / (-1j * 0.02 * 5.0 * GEAR_RATIO) == pytest.approx(share, abs=1e-3)


def test_latency_and_times_of_the_channel_are_kept(vessel, make_channel):
    turning = Turning(ripple=0.0, swing_hz=1.0, duration_s=30.0)
    late = np.interp(np.arange(60_000) / 2000.0 + 0.2 - 0.05, turning.fine_s, turning.fine_rev)
    reading = read(shown("degrees", late), sensor("degrees", latency_s=0.05), vessel, make_channel, start_s=0.2)
    true = GEAR_RATIO * turning.speed_at(0.2 + np.arange(reading.values.size) / 200.0)
    # a sample of the logger would be 1.6e-4
    assert reading.values[100:5800] == pytest.approx(true[100:5800], rel=2e-5)


def test_the_size_of_the_pieces_that_are_read_changes_nothing(vessel, make_channel):
    values = shown("counts", sampled(Turning(duration_s=20.0)))
    values[[999, 1000, 20_000]] += 9000.0
    whole, pieces = (
        read(values, sensor("counts"), vessel, make_channel, chunk_s=chunk_s) for chunk_s in (None, 0.0505)
    )
    assert np.array_equal(whole.values, pieces.values)
    assert whole.repairs == pieces.repairs


def test_an_encoder_that_counts_down_is_turned_and_said_so(vessel, make_channel):
    turning = Turning(duration_s=20.0)
    reading = read(shown("counts", -sampled(turning)), sensor("counts"), vessel, make_channel)
    assert reading.values.mean() == pytest.approx(GEAR_RATIO * turning.mean_speed(0.0, 20.0), rel=1e-3)
    assert reading.findings == ("channel X counts down while the ship moves ahead: its sign was turned",)


def there_and_back(back_s):
    """Angle of a shaft that turns ahead, from 20 s on for some seconds astern, and ahead again, at 2000 Hz."""
    time = np.arange(80_000) / 2000.0
    astern = (time > 20.0) & (time < 20.0 + back_s)
    return np.cumsum(np.where(astern, -2.0, 5.0)) / 2000.0


@pytest.mark.parametrize("way", ["degrees", "counts", "turns"])
def test_a_shaft_that_turns_back_ends_in_a_sentence(way, vessel, make_channel):
    reading = read(shown(way, there_and_back(6.0)), sensor(way), vessel, make_channel)
    (gap,) = reading.gaps
    assert gap.sentence.startswith("channel X shows a shaft that turns back from ")
    assert (gap.start_s, gap.stop_s) == pytest.approx((20.0, 26.0), abs=0.5)
    assert reading.repairs == []


@pytest.mark.parametrize("way", ["degrees", "counts", "counts of one turn"])
def test_a_standstill_ends_in_a_sentence(way, vessel, make_channel):
    turning = Turning(rest_s=4.0, run_up_s=1.0, duration_s=30.0)
    first = sampled(Turning(duration_s=10.0))
    angle = np.concatenate([first, first[-1] + sampled(turning) - turning.start_rev])
    reading = read(shown(way, angle), sensor(way), vessel, make_channel)
    (gap,) = reading.gaps
    assert gap.sentence.startswith("channel X stands still from ")
    assert (gap.start_s, gap.stop_s) == pytest.approx((10.0, 14.0), abs=0.3)
    assert reading.repairs == []


def message_times(rate_hz, duration_s=40.0, seed=1):
    """Times of messages that tremble by 15 % of their period, one in a hundred of them lost."""
    rng = np.random.default_rng(seed)
    every = (np.arange(round(duration_s * rate_hz)) + 0.5 + 0.15 * rng.standard_normal()) / rate_hz
    every = np.sort(every + 0.15 / rate_hz * rng.standard_normal(every.size))
    return every[rng.random(every.size) > 0.01]


def messages(time_s, rate_hz):
    """What makes a channel of messages."""
    return {
        "rate_hz": rate_hz,
        "start_s": float(time_s[0]),
        "stamps": lambda start, stop: time_s[start:stop],
        "is_uneven": True,
    }


@pytest.mark.parametrize("way", ["degrees", "turns", "counts"])
def test_messages_are_angles_at_their_own_times(way, vessel, make_channel):
    turning = Turning(ripple=0.0, swing_hz=1.0)
    time_s = message_times(50.0)
    values = shown(way, np.interp(time_s, turning.fine_s, turning.fine_rev))
    reading = read(values, sensor(way), vessel, make_channel, **messages(time_s, 50.0))
    true = GEAR_RATIO * turning.speed_at(time_s[0] + np.arange(reading.values.size) / 200.0)
    inside = slice(200, -400)
    assert reading.values[inside].mean() == pytest.approx(true[inside].mean(), rel=1e-5)
    # a count in 4096 at either end of 20 ms, which the spline makes larger between close messages
    limit = 1e-2 if way == "counts" else 1e-4
    assert np.abs(reading.values[inside] / true[inside] - 1.0).max() < limit
    assert reading.gaps == ()
    assert reading.findings[0].startswith("Channel X has times of its own: ")


def test_messages_too_far_apart_for_a_turn_are_refused(vessel, make_channel):
    time_s = message_times(12.0)
    values = shown("degrees", np.interp(time_s, Turning().fine_s, Turning().fine_rev))
    with pytest.raises(SignalError, match=r"X: expected an angle that turns by less than 0\.4 .* at 12 Hz; log at"):
        read(values, sensor("degrees"), vessel, make_channel, **messages(time_s, 12.0))


def test_an_angle_that_never_moves_is_refused(vessel, make_channel):
    with pytest.raises(SignalError, match=r"^channel X: expected an angle that turns, found one that stands still"):
        read(np.full(60_000, 123.4), sensor("degrees"), vessel, make_channel)


@pytest.mark.parametrize(
    ("shown_as", "entered", "more", "expected"),
    [
        ("counts", "counts without end", {}, r"begins again at 65536 counts; write rolls_over_at = 65536"),
        ("counts", "counts", {"rolls_over_at": 4096.0}, r"begins again at 65536 counts; write rolls_over_at = 65536"),
        ("counts of one turn", "counts", {}, r"begins again at 1024 counts; write rolls_over_at = 1024"),
        (
            "counts of one turn",
            "counts of one turn",
            {"counts_per_revolution": 4096.0},
            r"at 4096 counts, .* found one that begins again at 1024 counts; .*correct counts_per_revolution",
        ),
        ("degrees of two turns", "degrees", {}, r"begins again at 720 deg; write rolls_over_at = 720"),
        ("radians", "degrees", {}, r"begins again at 6\.283 deg; write rolls_over_at = 6\.283 .*correct unit"),
        ("degrees without end", "degrees", {"rolls_over_at": 360.0}, r"found one that goes on; leave out rolls_"),
    ],
)
def test_a_roll_over_that_is_not_as_stated_is_named(shown_as, entered, more, expected, vessel, make_channel):
    with pytest.raises(SignalError, match=expected):
        read(shown(shown_as, sampled(Turning())), sensor(entered, **more), vessel, make_channel)


def test_counts_per_turn_far_from_the_truth_are_refused(vessel, make_channel):
    # quadrature counts four for each line of the disc
    values = np.floor(4096.0 * sampled(Turning()))
    one = sensor("counts without end", counts_per_revolution=1024.0)
    with pytest.raises(
        SignalError,
        match=r"channel X: expected an engine between 600 rpm, idle, and 1800 rpm, rated, found 458\d rpm .* "
        r"counts_per_revolution, of which about 3\d\d\d would give the 1184 rpm",
    ):
        read(values, one, vessel, make_channel)


def test_counts_per_turn_that_may_be_wrong_are_a_finding(vessel, make_channel):
    values = np.floor(2048.0 * sampled(Turning()))
    one = sensor("counts without end", counts_per_revolution=4096.0)
    (finding,) = read(values, one, vessel, make_channel).findings
    assert finding.startswith("channel X shows 573 rpm at the engine where the working point of the vessel file has")
    assert finding.endswith("check counts_per_revolution and shaft there")


def test_a_logger_that_is_too_slow_is_refused_with_the_rate_that_would_do(vessel, make_channel):
    # 19.7 turns a second at the working point, of which 0.4 may pass from sample to sample
    turning = Turning(speed_rev_s=19.7, swing=0.0, ripple=0.0)
    for rate_hz in (45.0, 19.0):
        values = shown("degrees", sampled(turning, rate_hz))
        with pytest.raises(SignalError, match=rf"X: expected .* at {rate_hz:g} Hz; log at 50 Hz or more"):
            read(values, sensor("degrees", "engine"), vessel, make_channel, rate_hz=rate_hz)
    fast = Turning(speed_rev_s=28.0, swing=0.0, ripple=0.0)
    with pytest.raises(SignalError, match=r"found 0\.47 of it at 60 Hz; log at 70 Hz or more"):
        read(shown("degrees", sampled(fast, 60.0)), sensor("degrees", "engine"), vessel, make_channel, rate_hz=60.0)
    # what goes on is not counted wrongly
    on = read(sampled(turning, 19.0), sensor("turns", "engine"), vessel, make_channel, rate_hz=19.0)
    assert on.values.mean() == pytest.approx(19.7, rel=1e-5)


def test_too_few_counts_are_refused(vessel, make_channel):
    values = np.floor(4.0 * sampled(Turning()))
    with pytest.raises(SignalError, match=r"expected 200 counts a second or more.*, found 20\.\d at the working point"):
        read(values, sensor("counts without end", counts_per_revolution=4.0), vessel, make_channel)


@pytest.mark.parametrize("way", ["degrees", "counts"])
def test_a_test_of_the_ship_gives_the_speed_of_the_engine(way, vessel, ship, campaign, make_channel):
    recording = replace(ship, prepared=ship).recording()
    values = shown(way, ship.angle_rev)
    channels = dict(recording.channels) | {"X": make_channel(values, name="X", unit=WAYS[way][2]["unit"])}
    raw = Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)
    signals = prepare_signals(raw, vessel_with(vessel, sensor(way, "engine")), campaign)
    speed = signals.speeds["n_x"]
    true = np.interp(np.arange(speed.values.size) / 200.0, ship.time_s, ship.speed_rev_s)
    inside = slice(40, -40)
    assert speed.values[inside].mean() == pytest.approx(true[inside].mean(), rel=1e-5)
    # steps of the staircase have corners, which the filter rounds off
    assert np.sqrt(np.mean((speed.values[inside] / true[inside] - 1.0) ** 2)) < 1e-3
    assert (speed.nyquist_hz, speed.by_angle) == (1000.0, False)
    assert all(one.channel != "X" for one in signals.repairs)


def test_pick_up_and_encoder_are_held_against_each_other(vessel, ship, campaign, make_channel):
    recording = replace(ship, prepared=ship).recording()
    values = np.floor(5000.0 * ship.angle_rev)
    channels = dict(recording.channels) | {"X": make_channel(values, name="X", unit="counts")}
    raw = Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels)
    wrong = sensor("counts without end", "engine", counts_per_revolution=6000.0)
    content = vessel.model_dump()
    content["sensors"]["speed"] = [content["sensors"]["speed"][0], wrong.model_dump()]
    both = r"PTM_e and X: .* n_x / n_e = 0\.8333; check pulses_per_revolution or counts_per_revolution in"
    with pytest.raises(SignalError, match=both):
        prepare_signals(raw, Vessel.model_validate(content), campaign)


def test_two_recordings_can_be_compared_by_an_encoder(make_channel):
    turning = Turning(ripple=0.0, swing_hz=0.2, duration_s=30.0)
    channel = make_channel(shown("counts", sampled(turning)), name="X", unit="counts")
    content = content_of(channel, sensor("counts"), rate_hz=50.0)
    assert content.values[50:-50] == pytest.approx(turning.speed_at(content.time_s)[50:-50], rel=1e-3)
