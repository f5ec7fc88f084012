"""Shaft torque that a telemetry sends in messages: at their own times, without what cannot be true."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.recording import Recording
from shaftprint.signals import prepare_signals
from shaftprint.signals._clock import Clock
from shaftprint.signals.conditioning._condition import SentValues
from shaftprint.signals.excitation._message_lines import joined_about_lines
from shaftprint.vessel import Vessel


def sent(rng, *, period_s, until_s, jitter=0.15, lost=0.01):
    """Times of messages, and those of the cycle of their sender; some are lost."""
    due = 0.3 * period_s + period_s * np.arange(int(until_s / period_s))
    times = due + jitter * period_s * np.sqrt(12.0) * (rng.random(due.size) - 0.5)
    kept = rng.random(due.size) >= lost
    return times[kept], due[kept]


def amplitude(time_s, values, frequency_hz):
    phase = 2.0 * np.pi * frequency_hz * time_s
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(time_s.size), time_s - time_s.mean()])
    cosine, sinus = np.linalg.lstsq(design, values, rcond=None)[0][:2]
    return cosine - 1j * sinus


def grid_of(seconds):
    count = int(200.0 * seconds)
    return Clock(start_s=0.0, rate_hz=200.0, count=count, mode="shaftprint", chunk_s=None, advance=lambda _: None)


def recording_of(ship, make_channel, *, period_s=0.01, hole_s=(0.0, 0.0), spikes=()):
    time, _ = sent(np.random.default_rng(5), period_s=period_s, until_s=ship.time_s[-1])
    time = time[(time < hole_s[0]) | (time > hole_s[1])]
    # the noise of the gauge, which is not filtered before it is sent
    noise = 5.0 * np.random.default_rng(6).standard_normal(time.size)
    shown = np.interp(time - ship.torque_latency_s, ship.time_s, ship.torque_nm) + noise
    shown[list(spikes)] = 9000.0
    torque = make_channel(shown, name="Torque", unit="N m", rate_hz=1.0 / period_s, start_s=float(time[0]))
    torque = replace(torque, stamps=lambda first, stop: time[first:stop], is_uneven=True)
    channels = dict(replace(ship, prepared=ship).recording().channels) | {"Torque": torque}
    return Recording(path=Path("ship.nc"), sha256="0" * 64, format="memory", channels=channels), time


def vessel_with_messages(vessel, ship):
    content = vessel.model_dump()
    gauge = {"channel": "Torque", "unit": "N m", "scale_nm_per_unit": 1.0, "zero_nm": 0.0}
    gauge |= {"latency_s": ship.torque_latency_s, "full_scale_nm": 10000.0}
    content["sensors"]["shaft_torque"] = gauge
    return Vessel.model_validate(content)


@pytest.mark.slow
def test_torque_in_messages_is_that_of_the_shaft(vessel, ship, campaign, make_channel):
    """Of a hundred messages a second: late by what is known, faults left out at the time of their message."""
    raw, time = recording_of(ship, make_channel, spikes=(4000, 9000), hole_s=(42.1, 42.5))
    signals = prepare_signals(raw, vessel_with_messages(vessel, ship), campaign)
    grid = signals.start_s + np.arange(signals.samples) / signals.rate_hz
    for sine in campaign.sines:
        inside = (grid >= sine.settled_s) & (grid < sine.window_stop_s)
        found, goal = (
            amplitude(grid[inside], values[inside], sine.frequency_hz)
            for values in (signals.shaft_torque_nm, np.interp(grid, ship.time_s, ship.torque_nm))
        )
        messages = 100.0 * sine.window_s
        # five deviations of the noise of so many messages
        assert abs(found - goal) < 5.0 * 5.0 * np.sqrt(2.0 / messages)
    faults = [one for one in signals.repairs if one.channel == "Torque"]
    assert [one.time_s for one in faults] == pytest.approx([time[4000], time[9000]])
    hole = next(gap for gap in signals.gaps if gap.channel == "Torque")
    assert (hole.start_s, hole.stop_s) == pytest.approx((42.1, 42.5), abs=0.02)
    assert any("Torque has times of its own: a message every 10 ms" in one for one in signals.findings)
    assert signals.channels["M_s"].nyquist_hz == 50.0


@pytest.mark.parametrize("waits", [False, True])
@pytest.mark.parametrize("rate_hz", [10.0, 50.0])
def test_lines_of_a_third_of_the_rate_are_measured_at_their_messages(rate_hz, waits):
    """A spline alone is 3 % off at 0.33 of the rate, and 2 % where the messages wait."""
    frequency_hz = 0.33 * rate_hz
    campaign = Campaign.model_validate(
        {
            "name": "one line", "offset_v": -5.0, "duration_s": 100.0,
            "sines": [{"name": "S1", "frequency_hz": frequency_hz, "amplitude_v": 0.1, "start_s": 10.0,
                       "settled_s": 20.0, "stop_s": 90.0}],
        }
    )  # fmt: skip
    sine = campaign.sines[0]
    stamps, due = sent(np.random.default_rng(3), period_s=1.0 / rate_hz, until_s=100.0)
    taken = due if waits else stamps
    true = np.where(taken > sine.start_s, np.cos(2.0 * np.pi * frequency_hz * taken + 0.4), 0.0)
    messages = SentValues(time_s=stamps, values=3.0 + true, rate_hz=rate_hz)
    joined = joined_about_lines(messages, campaign, grid_of(100.0))
    assert joined is not None
    grid = np.arange(20_000) / 200.0
    inside = (grid >= sine.settled_s) & (grid < sine.window_stop_s)
    found = amplitude(grid[inside], joined[1][inside], frequency_hz)
    # by the law of the cardinal spline at 0.33 of the rate: sinc(x)^4 / sum of sinc(x + k)^4
    images = np.sinc(0.33 + np.arange(-40, 41)) ** 4
    assert abs(found) == pytest.approx(images[40] / images.sum(), abs=2e-3)
    # where the cycle lies is known as the mean of the stamps that tremble about it: to 0.15 of a period by their root
    late_rad = 2.0 * np.pi * 0.33 * 0.15 / np.sqrt(stamps.size) if waits else 0.0
    assert np.angle(found) == pytest.approx(0.4, abs=1e-3 + 3.0 * late_rad)


def test_slow_lines_need_no_more_than_the_spline(campaign):
    stamps, _ = sent(np.random.default_rng(3), period_s=0.01, until_s=campaign.duration_s)
    messages = SentValues(time_s=stamps, values=np.random.default_rng(1).standard_normal(stamps.size), rate_hz=100.0)
    assert joined_about_lines(messages, campaign, grid_of(campaign.duration_s)) is None
