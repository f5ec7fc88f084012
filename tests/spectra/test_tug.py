"""The response of the simulated tug, whose truth comes from other code."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.signals import SpeedSignal
from shaftprint.spectra import estimate_spectra, open_loop
from shaftprint.tug import Tug, linearised_response, simulate_signals
from shaftprint.vessel import load_vessel

LAST_SINE_S = 5300.0


@pytest.fixture(scope="module")
def ship():
    return load_vessel("stan-tug-1205"), load_campaign("thesis")


@pytest.fixture
def sailed(ship, make_signals):
    """Signals of a voyage past perfect sensors, with a speed sensor of 19.73 pulses a second in name only."""
    vessel, campaign = ship

    def sail(tug, seed):
        ideal = simulate_signals(
            vessel, campaign, tug=tug, seed=seed, rate_hz=100.0, stop_s=LAST_SINE_S, longest_step_s=1e-3
        )
        truth = vessel.working_point
        speed_rev_s, torque_nm = truth.engine_speed_rpm / 60.0, truth.shaft_torque_nm
        signals = make_signals(np.zeros(2), np.zeros(2), {})
        return replace(
            signals,
            rate_hz=100.0,
            set_point_rev_s=ideal.set_point_rev_s,
            shaft_torque_nm=ideal.shaft_torque_nm,
            speeds={
                "n_e": SpeedSignal(
                    name="n_e",
                    channel="PTM_e",
                    speed_rev_s=ideal.engine_speed_rev_s,
                    pulse_rate_hz=np.inf,
                    averaging_s=0.0,
                    hold_s=0.0,
                    delay_s=0.0,
                )
            },
            working_point=replace(signals.working_point, engine_speed_rev_s=speed_rev_s, shaft_torque_nm=torque_nm),
            calibration=replace(signals.calibration, slope_rev_s_per_v=tug.set_point_slope_rpm_per_v / 60.0),
        )

    return sail


def test_without_noise_the_response_is_the_linear_one(ship, sailed):
    vessel, campaign = ship
    tug = Tug.stan_tug_1205()
    spectra = estimate_spectra(sailed(tug, None), campaign)
    found = spectra.response
    truth = linearised_response(tug, vessel, found.frequency_hz)
    # the sines are 13 % of the working point: what the quadratic propeller bends stays below a tenth of a per cent
    assert np.abs(found.response / truth - 1.0).max() < 1e-3
    assert not spectra.remarks
    assert np.abs(spectra.load_drift.delta).max() < 1e-3
    # slowest lines: the propeller's second harmonic is all in the torque
    harmonics = spectra.harmonics
    assert harmonics.amplitude[:2, 1, 0] == pytest.approx(harmonics.expected_second_torque[:2], rel=0.02)
    governor, core = open_loop(found, set_point_latency_s=tug.set_point_latency_s)
    # bollard pull: torque over speed goes to 2 at low frequency
    assert np.abs(1.0 / core.response[0, 0, 0]) == pytest.approx(2.0, rel=1e-3)
    assert np.abs(governor.response[0, 0, 0]) > 50.0


def test_with_noise_the_errors_are_as_large_as_stated(ship, sailed):
    # without inflow the propeller load stays what it is in the linear response
    vessel, campaign = ship
    tug = Tug.stan_tug_1205()
    tug = replace(tug, noise=replace(tug.noise, inflow_rms=0.0))
    weighed = []
    for seed in range(4):
        found = estimate_spectra(sailed(tug, seed), campaign).response
        error = (found.response - linearised_response(tug, vessel, found.frequency_hz))[:, 0, :13]
        error = np.concatenate([error.real, error.imag])
        weighed.append(np.einsum("il,lij,jl->l", error, np.linalg.inv(found.covariance[:13]), error))
    # 4 voyages of 13 lines of 4 numbers: chi-square over 208 has a deviation of 0.1, more with few samples a line
    assert np.mean(weighed) / 4.0 == pytest.approx(1.0, abs=0.35)
