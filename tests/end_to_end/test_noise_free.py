"""Without noise the way from a simulated voyage to the parameters gives back what was put in."""

from dataclasses import replace

import numpy as np
import pytest
from tests.made_signals import made_channels
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.campaign import Campaign
from shaftprint.catalogue import structure
from shaftprint.identify import identify
from shaftprint.recording import read_recording
from shaftprint.signals import SetPointCalibration, Signals, WorkingPoint, prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.tug import Noise, Tug, sail

FREQUENCIES_HZ = (0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 0.9, 1.3, 1.9, 3.0)
# 0.2 % of the speed: the square of the propeller law is 1e-6 of the torque there
AMPLITUDE_V = 0.01
# The slowest pole of the governed line is near -0.6 1/s.
SETTLING_S = 40.0
N_0 = 1183.8 / 60.0

TRUTHS = {
    "reference": {},
    "another": {
        "g": -0.3,
        "governor_delay_s": 0.04337,
        "set_point_latency_s": 0.0811,
        "proportional_gain": 4.1,
        "integral_gain_per_s": 2.9,
        "natural_frequency_rad_s": 14.2,
        "damping_ratio": 0.62,
    },
}


@pytest.fixture(scope="module")
def campaign():
    sines, start = [], 0.0
    for number, frequency in enumerate(FREQUENCIES_HZ, start=1):
        settled = start + SETTLING_S
        stop = settled + max(2, np.ceil(10.0 * frequency)) / frequency
        sines.append(
            {
                "name": f"S{number}",
                "frequency_hz": frequency,
                "amplitude_v": AMPLITUDE_V,
                "start_s": start,
                "settled_s": settled,
                "stop_s": stop,
            }
        )
        start = stop
    return Campaign(name="small sines", duration_s=start + 1.0, offset_v=-5.0, sines=tuple(sines))


@pytest.fixture(scope="module", params=TRUTHS.values(), ids=TRUTHS)
def sailed(request, vessel, campaign):
    """The truth and the response that perfect sensors give."""
    tug = Tug(**request.param)
    ideal = simulate_signals(vessel, campaign, tug=tug)
    assert not ideal.limited.any()
    point = WorkingPoint(
        engine_speed_rev_s=N_0,
        shaft_torque_nm=1725.0,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=-5.0495,
        load_std=0.0,
    )
    signals = Signals(
        rate_hz=200.0,
        start_s=0.0,
        channels=made_channels(
            point,
            ideal.set_point_rev_s,
            ideal.shaft_torque_nm,
            {"n_e": {"channel": "PTM_e", "values": ideal.engine_speed_rev_s, "pulse_rate_hz": 1e6}},
            per_volt=-250.97 / 60.0,
        ),
        working_point=point,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-250.97 / 60.0,
            intercept_rev_s=-83.467 / 60.0,
            covariance=np.zeros((2, 2)),
            level_v=np.array([-5.0495]),
            level_rev_s=np.array([N_0]),
            level_std_rev_s=np.array([0.0]),
        ),
        dc_scale=1.0,
        dc_scale_std=0.0,
        strips=(),
        step_delays=(),
        repairs=(),
        mode="shaftprint",
        recording_sha256="",
        recording_name="none",
    )
    return tug, estimate_response(signals, campaign)


@pytest.mark.slow
def test_measured_response_is_that_of_the_linearised_tug(sailed, vessel):
    tug, response = sailed
    linear = linearised_response(tug, vessel, response.frequency_hz)
    assert np.abs(response.response / linear - 1.0).max() < 1e-5
    assert response.load == pytest.approx(np.ones(len(FREQUENCIES_HZ)), abs=1e-6)
    assert response.used.all()


def test_parameters_are_the_truth(sailed):
    tug, response = sailed
    # what noise-free data state of themselves is rounding; as if each value were known to 0.1 %
    values = response.response[:, 0]
    variance = (1e-3 * np.abs(np.concatenate([values, values])).T) ** 2
    known = replace(response, covariance=np.einsum("ls,st->lst", variance, np.eye(4)))
    # g and the inertias cannot be told apart from any such test
    fit = identify(structure("GAUGE-CLOSED").held_at(g=tug.g), known, rng=np.random.default_rng(1))
    found = {estimate.name: estimate.value for estimate in fit.parameters}
    # the error of the known latency of the telemetry, where it is free
    assert found.pop("t_gauge", 0.0) == pytest.approx(0.0, abs=1e-5)
    exactly = {
        "K_p": tug.proportional_gain,
        "K_i": tug.integral_gain_per_s,
        "omega_n": tug.natural_frequency_rad_s,
        "zeta": tug.damping_ratio,
        "tau_dn": 2.0 * np.pi * 17.0 * N_0 / 3.82 / 1725.0,
        "tau_up": 2.0 * np.pi * 54.006 * N_0 / 3.82 / 1725.0,
        "k_q": 2.0,
        "c_set": 1.0,
    }
    delays = {"t_d": tug.governor_delay_s, "t_sp": tug.set_point_latency_s}
    assert set(found) == set(exactly) | set(delays)
    for name, value in exactly.items():
        assert found[name] == pytest.approx(value, rel=1e-3), name
    for name, value in delays.items():
        assert found[name] == pytest.approx(value, rel=5e-3), name
    assert all(percent > 99.999 for percent in fit.fit_percent.values())


@pytest.mark.slow
def test_whole_measurement_chain_adds_nothing(vessel, short_campaign, tmp_path):
    """Pulses, telemetry, set-point line and all, but no noise: the response is that of the linearised tug.

    At the test's amplitude of 13 % of the speed the square of the propeller law bends it by some 0.05 %.
    """
    still = Tug(noise=Noise().without(process=True, measurement=True, faults=True))
    path = tmp_path / "still.nc"
    sail(vessel, short_campaign, path, tug=still, seed=1)
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, short_campaign)
    response = estimate_response(signals, short_campaign)
    ratio = response.response / linearised_response(still, vessel, response.frequency_hz)
    assert signals.dc_scale == pytest.approx(1.0, abs=1e-4)
    assert np.abs(np.abs(ratio) - 1.0).max() < 1e-3
    assert np.abs(np.degrees(np.angle(ratio))).max() < 0.05
    # no step of the chain is late: 10 microseconds between torque and speed at 2 and 3.3 Hz
    late = -np.angle(ratio[1, 0] / ratio[0, 0]) / (2.0 * np.pi * response.frequency_hz)
    assert np.abs(late[-2:]).max() < 1e-5
