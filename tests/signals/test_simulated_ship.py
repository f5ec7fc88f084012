"""From the raw recording of a simulated ship back to its truth."""

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import Campaign
from shaftprint.recording import read_recording
from shaftprint.signals import inspect_channels, prepare_signals
from shaftprint.tug import Noise, Tug, read_truth, sail, truth_path


@pytest.fixture(scope="module")
def voyage() -> Campaign:
    sines = [(0.02, 160.0, 320.0), (0.04, 330.0, 420.0), (0.0848, 430.0, 480.0), (0.3728, 485.0, 510.0)]
    return Campaign.model_validate(
        {
            "name": "short voyage",
            "duration_s": 540.0,
            "offset_v": -5.0,
            "staircases": [{"name": "St", "levels_v": [-4.0, -5.0, -6.0], "dwell_s": 40.0, "start_s": 20.0}],
            "sines": [
                {
                    "name": f"S{number + 1}",
                    "frequency_hz": frequency,
                    "amplitude_v": 0.6,
                    "start_s": start,
                    "settled_s": start + 8.0,
                    "stop_s": stop,
                }
                for number, (frequency, start, stop) in enumerate(sines)
            ],
        }
    )


@pytest.fixture(scope="module")
def noisy(tmp_path_factory, vessel, voyage):
    path = tmp_path_factory.mktemp("voyage") / "noisy.nc"
    often = Noise(
        missing_pulse_interval_s=60.0,
        doubled_pulse_interval_s=90.0,
        torque_spike_interval_s=20.0,
        torque_dropout_interval_s=60.0,
        set_point_spike_interval_s=40.0,
    )
    sail(vessel, voyage, path, tug=Tug(noise=often), seed=5)
    with read_recording(path) as recording:
        yield recording, read_truth(truth_path(path))


@pytest.fixture(scope="module")
def signals(noisy, vessel, voyage):
    return prepare_signals(noisy[0], vessel, voyage)


@pytest.mark.slow
def test_strip_angles_within_a_tenth_of_a_degree(noisy, signals):
    (truth,) = [strips for strips in noisy[1].strips if strips.channel == "PTM_4"]
    found = signals.strips[0].angle_rev * 360.0
    assert min(np.abs(np.roll(found, k) - truth.angle_deg).max() for k in range(4)) < 0.02


def test_line_of_the_set_point_within_two_thousandths(signals):
    slope = signals.calibration.slope_rev_s_per_v * 60.0
    assert slope == pytest.approx(-250.97, rel=2e-3)
    assert slope * signals.dc_scale == pytest.approx(-250.97, rel=2e-3)
    assert signals.calibration.intercept_rev_s * 60.0 == pytest.approx(-83.467, abs=0.002 * 1184.0)


def test_working_point(signals):
    assert signals.working_point.engine_speed_rev_s * 60.0 == pytest.approx(1183.8, rel=1e-3)
    assert signals.working_point.shaft_torque_nm == pytest.approx(1725.0, rel=0.02)


def test_every_pulse_fault_and_no_other_is_found(noisy, vessel):
    recording, truth = noisy
    for report in inspect_channels(recording, vessel)[:3]:
        true = [fault for fault in truth.faults if fault.channel == report.channel]
        assert len(true) > 5
        assert [fault.kind for fault in report.faults] == [
            fault.kind for fault in sorted(true, key=lambda one: one.time_s)
        ]
        found = np.array([fault.time_s for fault in report.faults])
        assert found == pytest.approx(np.sort([fault.time_s for fault in true]), abs=0.03)


def test_dropouts_and_set_point_spikes_are_found_and_ripple_is_not(noisy, signals):
    truth = noisy[1]
    true = {
        kind: np.array([fault.time_s for fault in truth.faults if (fault.channel, fault.kind) == kind])
        for kind in (("M_s", "hold"), ("M_s", "rail"), ("M_s", "spike"), ("U_setpoint", "spike"))
    }
    found = {
        channel: np.array([repair.time_s for repair in signals.repairs if repair.channel == channel])
        for channel in ("M_s", "U_setpoint")
    }
    for (channel, _), times in true.items():
        hits = np.array([np.abs(found[channel] - time).min() < 0.002 for time in times])
        # a spike may end within the noise, everything else is seen
        assert hits.mean() > 0.8
    every = np.concatenate([true["M_s", kind] for kind in ("hold", "rail", "spike")])
    assert all(np.abs(every - time).min() < 0.3 for time in found["M_s"])
    assert all(np.abs(true["U_setpoint", "spike"] - time).min() < 0.002 for time in found["U_setpoint"])


@pytest.mark.slow
def test_speed_and_torque_follow_the_truth(tmp_path, vessel, voyage):
    """Without process noise the truth is known at every instant; sensors keep their noise and faults."""
    tug = Tug(noise=Noise().without(process=True))
    path = tmp_path / "calm.nc"
    sail(vessel, voyage, path, tug=tug, seed=6)
    with read_recording(path) as recording:
        found = prepare_signals(recording, vessel, voyage)
    true = simulate_signals(vessel, voyage, tug=tug)
    time = true.time_s
    slow = (time > 1.0) & (time < 539.0)
    for step in (20.0, 60.0, 100.0, 140.0):
        slow &= np.abs(time - step - 2.0) > 3.0
    for sine in voyage.sines:
        slow &= (np.abs(time - sine.start_s) > 1.0) & (np.abs(time - sine.stop_s - 2.0) > 3.0)
    error = {name: speed.speed_rev_s / true.engine_speed_rev_s - 1.0 for name, speed in found.speeds.items()}
    # 40 us of jitter in 51, 194 and 48 ms; the last sine is fast for one strip a turn of the shaft
    for name, limit in (("n_e", 2e-3), ("n_e1", 2e-3), ("n_e4", 2e-3)):
        assert np.sqrt(np.mean(error[name][slow] ** 2)) < limit
        assert abs(np.mean(error[name][slow])) < 1e-4
    # ripple and noise of the gauge average out
    mean = np.mean((found.shaft_torque_nm - true.shaft_torque_nm)[slow])
    assert mean == pytest.approx(0.0, abs=3.0)
    assert found.set_point_rev_s[slow] == pytest.approx(true.set_point_rev_s[slow], rel=1e-3)
