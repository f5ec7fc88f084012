"""Encoders on the simulated tug show the angle of its shaft, as late as they say, and begin again."""

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel


def with_encoder(vessel, **fields):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [{"name": "n_x", "channel": "X", **fields}]
    return Vessel.model_validate(content)


@pytest.mark.parametrize(
    ("fields", "whole", "per_engine_rev", "step"),
    [
        ({"unit": "deg", "shaft": "engine"}, 360.0, 360.0, 360.0 / 65_536),
        ({"unit": "rad", "shaft": "propeller"}, 2.0 * np.pi, 2.0 * np.pi / 3.82, 2.0 * np.pi / 65_536),
        (
            {"unit": "counts", "shaft": "engine", "counts_per_revolution": 4096.0, "rolls_over_at": 65_536.0},
            65_536.0,
            4096.0,
            1.0,
        ),
        ({"unit": "counts", "shaft": "propeller", "counts_per_revolution": 1000.0}, 1000.0, 1000.0 / 3.82, 1.0),
    ],
)
def test_the_channel_shows_the_angle_late(vessel, ask, sine, quiet_tug, tmp_path, fields, whole, per_engine_rev, step):
    ship = with_encoder(vessel, latency_s=0.03, **fields)
    campaign = ask(21.0, sines=[sine(0.5, 0.6)])
    tug = Tug(noise=quiet_tug.noise, encoder_error_deg=0.0)
    sail(ship, campaign, tmp_path / "x.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        channel = recording.channels["X"]
        values = channel.values(0, channel.count)
    assert channel.unit == fields["unit"]
    assert 0.0 <= values.min() < 0.02 * whole
    assert 0.98 * whole < values.max() < whole
    true = simulate_signals(ship, campaign, tug=tug, rate_hz=2000.0)
    speed = true.engine_speed_rev_s
    turned = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))]) / 2000.0
    shown = np.unwrap(values, period=whole)[60 : speed.size]
    # 30 ms are 60 samples; two values are each as much as a step too small
    assert shown - shown[0] == pytest.approx(per_engine_rev * turned[: speed.size - 60], abs=1.01 * step)


def test_the_error_of_the_angle_is_as_large_as_the_truth_says(vessel, ask, quiet_tug, tmp_path):
    ship = with_encoder(vessel, unit="deg", shaft="propeller")
    sail(ship, ask(10.0), tmp_path / "x.nc", tug=Tug(noise=quiet_tug.noise, encoder_error_deg=0.1), seed=1)
    with read_recording(tmp_path / "x.nc") as recording:
        values = recording.channels["X"].values(0, 20_000)
    # the speed is steady: second differences of white noise have six times its variance
    assert np.diff(np.unwrap(values, period=360.0), 2).std() == pytest.approx(0.1 * np.sqrt(6.0), rel=0.03)


def test_a_counter_of_more_than_sixteen_bits_is_refused(vessel, ask, tmp_path):
    ship = with_encoder(vessel, unit="counts", shaft="engine", counts_per_revolution=4096.0, rolls_over_at=2.0**24)
    with pytest.raises(SettingsError, match=r"expected rolls_over_at of at most 65536 counts for channel X"):
        sail(ship, ask(5.0), tmp_path / "x.nc", seed=1)
