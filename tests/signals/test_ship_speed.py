"""The speed of the ship on the common grid: latency, units, hold, and what cannot be used."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.recording import Channel
from shaftprint.signals._clock import Clock
from shaftprint.signals.kinds._ship_speed import read_ship_speed, ship_speed_signal
from shaftprint.signals.levels._steady import SteadyStretch
from shaftprint.vessel import ShipSpeedSensor

CLOCK = Clock(start_s=10.0, rate_hz=50.0, count=2000, mode="shaftprint", chunk_s=None, advance=lambda n: None)


def log(values, *, rate_hz=5.0, start_s=9.0, scale=1.0):
    return Channel(
        name="v_s",
        unit="m/s",
        rate_hz=rate_hz,
        start_s=start_s,
        count=values.size,
        scale=scale,
        offset=0.0,
        source=lambda first, stop: values[first:stop],
    )


def sensor(**changes):
    given = {"channel": "v_s", "unit": "m/s", "cycle_s": 0.2, "resolution": 0.01, "latency_s": 0.3}
    return ShipSpeedSensor.model_validate(given | changes)


def stretch(start_s, stop_s):
    return SteadyStretch(
        start_s=start_s,
        stop_s=stop_s,
        set_point_v=-5.0,
        speed_rev_s=20.0,
        speed_std_rev_s=0.01,
        torque_nm=1700.0,
        torque_std_nm=1.0,
    )


def test_latency_and_unit_are_taken_off():
    """A ship that gains 0.02 kn a second; the log shows at 9 s what was there at 8.7 s."""
    time = 9.0 + np.arange(230) / 5.0
    speed = read_ship_speed(log(5.0 + 0.02 * (time - 0.3)), sensor(unit="kn"), CLOCK, latency_s=0.3).values
    grid = 10.0 + np.arange(2000) / 50.0
    assert speed == pytest.approx((5.0 + 0.02 * grid) * 1852.0 / 3600.0, rel=1e-12)


@pytest.mark.parametrize("held", [False, True])
def test_gain_is_what_joining_or_holding_makes_of_a_sine(held):
    frequency_hz = 0.4
    time = 9.0 + np.arange(230) / 5.0
    values = 4.0 + 0.1 * np.cos(2 * np.pi * frequency_hz * (time - 0.3))
    fine = log(np.repeat(values, 1000), rate_hz=5000.0) if held else log(values)
    # a fine grid: its own step would be seen as half of it in delay where the steps of the log fall on it
    clock = replace(CLOCK, rate_hz=2000.0, count=80_000)
    speed = read_ship_speed(fine, sensor(), clock, latency_s=0.3).values
    signal = ship_speed_signal(speed, fine, sensor(), clock, (stretch(10.0, 30.0),))
    grid = 10.0 + np.arange(80_000) / 2000.0
    found = 2.0 * np.mean((speed - 4.0) * np.exp(-2j * np.pi * frequency_hz * grid)) / 0.1
    assert found == pytest.approx(signal.gain(frequency_hz), abs=2e-3)
    assert signal.nyquist_hz == 2.5
    assert 2.2 < signal.highest_hz < 2.3


def test_working_point_and_its_scatter():
    rng = np.random.default_rng(1)
    values = 4.0 + 0.05 * rng.standard_normal(230)
    speed = read_ship_speed(log(values), sensor(), CLOCK, latency_s=0.3).values
    found = ship_speed_signal(speed, log(values), sensor(), CLOCK, (stretch(12.0, 28.0), stretch(30.0, 46.0)))
    # 160 values in all
    assert found.reference == pytest.approx(4.0, abs=4.0 * 0.05 / np.sqrt(160.0))
    assert found.reference_std < 0.02


def test_a_moored_ship_has_no_speed():
    values = np.full(230, 0.1)
    speed = read_ship_speed(log(values), sensor(), CLOCK, latency_s=0.3).values
    assert ship_speed_signal(speed, log(values), sensor(), CLOCK, (stretch(12.0, 28.0),)) is None


@pytest.mark.parametrize(
    ("channel", "words"),
    [
        (log(np.full(50, 4.0), rate_hz=1.0), "expected 5 values a second or more, .* found 1"),
        (log(np.full(100, 4.0)), r"expected the speed of the ship from 10.0 to 50.0 s, found it from 8.7 to 28.5 s"),
        (log(np.full(230, np.nan)), "expected numbers, found none"),
    ],
    ids=["slow", "short", "not a number"],
)
def test_what_cannot_be_used_is_refused(channel, words):
    with pytest.raises(SignalError, match=words):
        read_ship_speed(channel, sensor(), CLOCK, latency_s=0.3)


def test_what_the_log_did_not_give_is_a_gap():
    values = 4.0 + 0.01 * np.arange(230)
    values[100:120] = np.nan
    values[50] = np.nan
    found = read_ship_speed(log(values), sensor(), CLOCK, latency_s=0.3)
    (gap,) = found.gaps
    assert (gap.start_s, gap.stop_s) == pytest.approx((9.0 + 20.0 - 0.3, 9.0 + 24.0 - 0.3))
    # a ship that gains speed evenly is on the straight line all the same
    grid = 10.0 + np.arange(2000) / 50.0
    assert found.values == pytest.approx(4.0 + 0.05 * (grid - 9.0 + 0.3), rel=1e-12)


def test_a_receiver_that_sends_when_it_likes_is_taken_at_its_times():
    """A value every 0.2 s, up to 60 ms late, none from 30 to 33 s, of a ship that gains 0.02 m/s a second."""
    time = 9.0 + np.arange(230) / 5.0 + np.random.default_rng(1).uniform(0.0, 0.06, 230)
    time = time[(time < 30.0) | (time > 33.0)]
    values = 5.0 + 0.02 * (time - 0.3)
    uneven = replace(log(values), start_s=float(time[0]), stamps=lambda first, stop: time[first:stop], is_uneven=True)
    reading = read_ship_speed(uneven, sensor(), CLOCK, latency_s=0.3)
    grid = 10.0 + np.arange(2000) / 50.0
    assert reading.values == pytest.approx(5.0 + 0.02 * grid, rel=1e-12)
    (gap,) = reading.gaps
    assert (gap.start_s, gap.stop_s) == pytest.approx((time[time < 30.0][-1] - 0.3, time[time > 33.0][0] - 0.3))
