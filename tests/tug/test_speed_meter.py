"""Instruments on the simulated tug show its speed in their unit, as late as they say."""

import numpy as np
import pytest

from shaftprint.recording import read_recording
from shaftprint.tug import Tug, sail, simulate_signals
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
