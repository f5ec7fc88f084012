"""The whole way: a logger's file with pulses, ripple, faults and quantisation, prepared and judged."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.nonlinearity import detect
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import Tug, sail

SINES = [(0.05, 0.6, 3), (0.12, 0.6, 5), (0.3, 0.6, 8), (0.6, 0.3, 12), (1.2, 0.2, 24), (0.13, 0.15, 5)]


@pytest.fixture(scope="module")
def voyage() -> Campaign:
    """Levels of more than 30 s: the line of the set point is found from them."""
    sines, time_s = [], 20.0
    for number, (frequency, amplitude, periods) in enumerate(SINES, start=1):
        stop_s = time_s + 8.0 + periods / frequency + 0.01
        timing = {"start_s": time_s, "settled_s": time_s + 8.0, "stop_s": stop_s}
        sines.append({"name": f"S{number}", "frequency_hz": frequency, "amplitude_v": amplitude} | timing)
        time_s = float(np.ceil(stop_s)) + 2.0
    stairs = []
    for name, levels in (("St1", [-4.0, -5.0, -6.0, -5.0, -4.0]), ("St2", [-3.0, -5.0, -7.0, -5.0, -3.0])):
        stairs.append({"name": name, "levels_v": levels, "dwell_s": 31.0, "start_s": time_s})
        time_s += 31.0 * len(levels) + 17.0
    return Campaign.model_validate(
        {"name": "voyage", "duration_s": time_s, "offset_v": -5.0, "sines": sines, "staircases": stairs}
    )


def look(folder, vessel, voyage, *, seed, **truth):
    path = folder / "voyage.nc"
    sail(vessel, voyage, path, tug=Tug(**truth), seed=seed)
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, voyage)
    return detect(signals, voyage, vessel)


def test_limits_of_the_reference_line(tmp_path, wide, voyage):
    """The truth is the full-load curve of the vessel file itself, 1316.6 N m or 2.828 M_b0 at the working point."""
    told = look(tmp_path, wide, voyage, seed=12)
    assert {finding.kind for finding in told.findings} == {"torque limit", "motoring limit"}
    assert told.start_values["limit"] == pytest.approx(1.0, abs=0.03)
    assert told.start_values["m_max"] == pytest.approx(2.828, rel=0.03)


def test_rate_limit_of_the_rack(tmp_path, strong, voyage):
    told = look(tmp_path, strong, voyage, seed=11, motoring_torque_nm=9000.0, rack_rate_limit_per_s=1.2)
    assert [finding.kind for finding in told.findings] == ["rate limit of the fuel rack"]
    assert told.start_values["r_x"] == pytest.approx(1.2 / 0.39707, rel=0.05)


def test_a_linear_line_shows_nothing(tmp_path, strong, voyage):
    told = look(tmp_path, strong, voyage, seed=11, motoring_torque_nm=9000.0)
    assert told.linear
    assert told.harmonics.smallest_p_value > 1e-3
