from typing import Any

import numpy as np
import pytest

from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Sailing, Tug, normalised_truth, sail
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._log import SpeedLog
from shaftprint.vessel import ShipSpeedSensor, Vessel

RATE_HZ = 2000.0


def sensor(**changes: Any) -> ShipSpeedSensor:
    given = {"channel": "v_s", "unit": "m/s", "cycle_s": 0.2, "resolution": 0.001, "latency_s": 0.3}
    return ShipSpeedSensor.model_validate(given | changes)


def values(log: SpeedLog, speed: np.ndarray, stretch_samples: int) -> np.ndarray:
    zeros = np.zeros(speed.size)
    parts = []
    for first in range(0, speed.size, stretch_samples):
        part = slice(first, first + stretch_samples)
        count = speed[part].size
        parts.append(
            log.next(
                Stretch(
                    time_s=(first + np.arange(count)) / RATE_HZ,
                    shaft_speed_rev_s=zeros[part],
                    shaft_angle_rev=zeros[part],
                    engine_speed_rev_s=zeros[part],
                    engine_angle_rev=zeros[part],
                    shaft_torque_nm=zeros[part],
                    brake_torque_nm=zeros[part],
                    rack_given=zeros[part],
                    limited=zeros[part] > 0.0,
                    machine_nm=zeros[part],
                    pitch_change=zeros[part],
                    ship_speed_m_s=speed[part],
                    demand_rev_s=np.zeros(1),
                )
            )
        )
    return np.concatenate(parts) * log.logged.scale


def log_of(rng_seed: int = 1, noise_m_s: float = 0.0, **changes: Any) -> SpeedLog:
    rng = np.random.default_rng(rng_seed)
    return SpeedLog(sensor(**changes), noise_m_s=noise_m_s, first_speed_m_s=4.0, rate_hz=RATE_HZ, rng=rng)


def test_values_are_late_by_the_latency() -> None:
    """A ship that gains 0.1 m/s a second from 4 m/s on."""
    log = log_of()
    speed = 4.0 + 0.1 * np.arange(20_000) / RATE_HZ
    time = log.times.start_s + 0.2 * np.arange(50)
    shown = values(log, speed, 20_000)
    assert shown.size == 50
    assert shown == pytest.approx(np.maximum(4.0 + 0.1 * (time - 0.3), 4.0), abs=0.0006)


@pytest.mark.parametrize("stretch_samples", [300, 777, 5000])
def test_values_do_not_depend_on_the_stretches(stretch_samples: int) -> None:
    speed = 4.0 + 0.1 * np.sin(np.arange(20_000) / 3000.0)
    whole, cut = (values(log_of(noise_m_s=0.02), speed, n) for n in (20_000, stretch_samples))
    assert np.array_equal(whole, cut)


def test_noise_has_its_size_and_knots_are_knots() -> None:
    speed = np.full(2_000_000, 4.0)
    shown = values(log_of(noise_m_s=0.05), speed, 2_000_000)
    assert shown.std() == pytest.approx(0.05, rel=0.05)
    knots = values(log_of(unit="kn"), speed[:20_000], 20_000)
    assert knots == pytest.approx(np.full(50, 4.0 * 3600.0 / 1852.0), abs=0.0006)


def test_log_adds_a_channel_and_changes_no_other(vessel: Vessel, ask: Any, tmp_path: Any) -> None:
    content = vessel.model_dump()
    content["sensors"]["ship_speed"] = sensor().model_dump()
    tug = Tug(sailing=Sailing(log_rms_m_s=0.0), noise=Noise())
    sail(Vessel.model_validate(content), ask(4.0), tmp_path / "with.nc", tug=tug, seed=1)
    sail(vessel, ask(4.0), tmp_path / "without.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "with.nc") as one, read_recording(tmp_path / "without.nc") as other:
        assert set(one.channels) - set(other.channels) == {"v_s"}
        for name, channel in other.channels.items():
            assert np.array_equal(channel.values(0, channel.count), one.channels[name].values(0, channel.count))
        log = one.channels["v_s"]
        assert (log.unit, log.rate_hz) == ("m/s", 5.0)
        assert log.values(0, log.count) == pytest.approx(
            np.full(log.count, normalised_truth(tug, vessel)["v_0"]), abs=0.01
        )
