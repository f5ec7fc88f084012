"""Instruments on the simulated tug show its speed in their unit, as late as they say."""

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.recording import read_recording
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel


@pytest.mark.parametrize(
    ("fields", "at_rest", "per_rev_s"),
    [
        ({"unit": "rpm", "shaft": "engine"}, 0.0, 60.0),
        ({"unit": "rad/s", "shaft": "propeller"}, 0.0, 2.0 * np.pi / 3.82),
        ({"unit": "Hz", "shaft": "engine", "wheel": "60-2"}, 0.0, 58.0),
        ({"unit": "m/s", "shaft": "propeller", "diameter_m": 0.09}, 0.0, 0.09 * np.pi / 3.82),
        ({"unit": "mA", "shaft": "engine", "rpm_per_unit": 125.0, "rpm_at_zero": -500.0}, 4.0, 60.0 / 125.0),
    ],
)
def test_the_channel_shows_the_speed_late(vessel, ask, sine, quiet_tug, tmp_path, fields, at_rest, per_rev_s):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [{"name": "n_x", "channel": "X", "latency_s": 0.0303, **fields}]
    ship = Vessel.model_validate(content)
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    tug = Tug(noise=quiet_tug.noise, speed_meter_noise=0.0)
    sail(ship, campaign, tmp_path / "x.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        channel = recording.channels["X"]
        values = channel.values(0, channel.count)
    assert channel.unit == fields["unit"]
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    late = np.interp(true.time_s - 0.0303, true.time_s, true.engine_speed_rev_s)
    # one of 32,000 counts
    shown = (values - at_rest) / per_rev_s
    assert shown[: late.size] == pytest.approx(late, abs=1.3 * 30.0 / 32_000)


def test_a_control_unit_sends_the_speed_in_messages(vessel, ask, sine, quiet, tmp_path):
    """SPN 190: 0.125 rpm a bit, here every 20 ms with 15 % of jitter, one in twenty lost."""
    content = vessel.model_dump()
    content["sensors"]["speed"] = [
        {"name": "n_x", "channel": "X", "latency_s": 0.0303, "unit": "rpm", "shaft": "engine"}
    ]
    ship = Vessel.model_validate(content)
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    tug = Tug(noise=quiet, speed_cycle_s=0.02, message_jitter=0.15, messages_lost=0.05)
    sail(ship, campaign, tmp_path / "x.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        channel = recording.channels["X"]
        values, time_s = channel.values(0, channel.count), channel.time_s(0, channel.count)
        assert set(recording.channels) == {"U_setpoint", "X", "M_s"}
    assert channel.is_uneven
    assert channel.count == pytest.approx(0.95 * 21.0 / 0.02, rel=0.02)
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    late = 60.0 * np.interp(time_s - 0.0303, true.time_s, true.engine_speed_rev_s)
    assert values == pytest.approx(late, abs=0.0626)
    assert values / 0.125 == pytest.approx(np.rint(values / 0.125), abs=1e-9)
    regular = Tug(noise=quiet, speed_cycle_s=0.05)
    sail(ship, campaign, tmp_path / "even.nc", tug=regular, seed=1)
    with read_recording(tmp_path / "even.nc") as recording:
        even = recording.channels["X"]
        assert (even.rate_hz, even.is_uneven, even.count) == (20.0, False, 420)


def test_a_control_unit_reports_the_set_point_in_messages(vessel, ask, sine, quiet, tmp_path):
    """SPN 91: 0.4 % a bit of a pedal from idle to rated speed, every 20 ms, 30 ms late."""
    content = vessel.model_dump()
    line = {"v_per_unit": -0.047814, "v_at_zero": -2.7233}
    content["sensors"]["set_point"] = {"channel": "Pedal", "unit": "%", "message_latency_s": 0.03, **line}
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    tug = Tug(noise=quiet, set_point_cycle_s=0.02, message_jitter=0.15, messages_lost=0.05)
    sail(Vessel.model_validate(content), campaign, tmp_path / "x.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        pedal = recording.channels["Pedal"]
        values, time_s = pedal.values(0, pedal.count), pedal.time_s(0, pedal.count)
    assert (pedal.is_uneven, pedal.unit) == (True, "%")
    assert pedal.count == pytest.approx(0.95 * 21.0 / 0.02, rel=0.02)
    volts = -5.0 + 0.6 * np.sin(2.0 * np.pi * 0.5 * (time_s - 0.03)) + tug.set_point_offset_v
    begun = (time_s > 0.05) & (time_s < 20.0)
    shown = line["v_per_unit"] * values[begun] + line["v_at_zero"]
    assert shown == pytest.approx(volts[begun], abs=0.501 * 0.4 * 0.047814)
    assert values / 0.4 == pytest.approx(np.rint(values / 0.4), abs=1e-9)


def test_a_control_unit_reports_its_demand_in_messages(vessel, ask, sine, quiet, tmp_path):
    """The desired speed, 0.125 rpm a bit: that of the voltage a latency ago, and 10 ms on the bus."""
    content = vessel.model_dump()
    content["sensors"]["demand"] = {"channel": "Desired", "unit": "rpm", "cycle_s": 0.05, "latency_s": 0.01}
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    tug = Tug(noise=quiet, message_jitter=0.15, messages_lost=0.05)
    sail(Vessel.model_validate(content), campaign, tmp_path / "x.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        demand = recording.channels["Desired"]
        values, time_s = demand.values(0, demand.count), demand.time_s(0, demand.count)
    late_s = tug.set_point_latency_s + 0.01
    inside = (time_s > 0.1) & (time_s < 20.0)
    volts = -5.0 + 0.6 * np.sin(2.0 * np.pi * 0.5 * (time_s[inside] - late_s)) + tug.set_point_offset_v
    assert values[inside] == pytest.approx(-250.97 * volts - 83.467, abs=0.08)
    assert values / 0.125 == pytest.approx(np.rint(values / 0.125), abs=1e-9)


@pytest.mark.parametrize("is_mean", [False, True])
def test_a_telemetry_sends_the_torque_in_messages(vessel, ask, sine, quiet, tmp_path, is_mean):
    """Late by the latency of the vessel file in all, of which a mean over 20 ms is 10 ms."""
    campaign, late_s = ask(21.0, sines=[sine(0.5, 0.6)]), 0.015
    content = vessel.model_dump()
    content["sensors"]["shaft_torque"] |= {"latency_s": late_s, "resolution_nm": None}
    ship = Vessel.model_validate(content)
    tug = Tug(noise=quiet, torque_cycle_s=0.02, torque_is_mean=is_mean, message_jitter=0.15, messages_lost=0.05)
    sail(ship, campaign, tmp_path / "x.nc", tug=tug, seed=1)
    gauge = ship.sensors.shaft_torque
    with read_recording(tmp_path / "x.nc") as recording:
        channel = recording.channels[gauge.channel]
        time_s = channel.time_s(0, channel.count)
        shown = gauge.torque_nm(channel.values(0, channel.count))
    assert channel.is_uneven
    assert channel.count == pytest.approx(0.95 * 21.0 / 0.02, rel=0.02)
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    late = np.interp(time_s - late_s, true.time_s, true.shaft_torque_nm)
    moving = time_s > 2.0
    # a tenth of a period of 0.5 Hz is 200 ms: 0.1 ms moves the torque by 3e-4 of its swing
    assert np.abs((shown - late)[moving]).max() < 0.003 * np.ptp(late)
