"""The response of the simulated tug, whose truth comes from other code."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest
from tests.made_signals import made_channels
from tests.measured_outputs import measured
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.campaign import load_campaign
from shaftprint.signals import MessageSignal
from shaftprint.spectra import estimate_spectra, open_loop
from shaftprint.spectra._open_loop import governor_and_engine
from shaftprint.tug import Tug
from shaftprint.vessel import load_vessel

LAST_SINE_S = 5300.0


@pytest.fixture(scope="module")
def ship():
    return load_vessel("stan-tug-1205"), load_campaign("thesis")


def percent_torque(rack):
    """Messages of 1 % every 50 ms, of a rack at 100 Hz; the first comes 30 ms after the start."""
    return MessageSignal(
        name="X",
        channel="X_percent",
        values=0.01 * np.rint(100.0 * rack[3::5]),
        rate_hz=20.0,
        start_s=0.03,
        resolution=0.01,
        cycle_s=0.05,
        averaging_s=0.0,
        hold_s=0.0,
        # 465.54 of 1172.44 N m
        reference=0.39707,
        reference_std=0.001,
    )


@pytest.fixture(scope="module")
def voyage(ship):
    """A voyage of a tug; the last few are kept, for two tests ask for the same ones."""
    vessel, campaign = ship

    @lru_cache(maxsize=4)
    def simulated(tug, seed):
        return simulate_signals(
            vessel, campaign, tug=tug, seed=seed, rate_hz=100.0, stop_s=LAST_SINE_S, longest_step_s=1e-3
        )

    return simulated


@pytest.fixture
def sailed(ship, voyage, make_signals):
    """Signals of a voyage past perfect sensors, with a speed sensor of 19.73 pulses a second in name only."""
    vessel = ship[0]

    def sail(tug, seed, *, messages=False):
        ideal = voyage(tug, seed)
        truth = vessel.working_point
        speed_rev_s, torque_nm = truth.engine_speed_rpm / 60.0, truth.shaft_torque_nm
        signals = make_signals(np.zeros(2), np.zeros(2), {})
        point = replace(signals.working_point, engine_speed_rev_s=speed_rev_s, shaft_torque_nm=torque_nm)
        return replace(
            signals,
            rate_hz=100.0,
            channels=made_channels(
                point,
                ideal.set_point_rev_s,
                ideal.shaft_torque_nm,
                {"n_e": {"channel": "PTM_e", "values": ideal.engine_speed_rev_s, "pulse_rate_hz": np.inf}},
                per_volt=tug.set_point_slope_rpm_per_v / 60.0,
                **({"X": percent_torque(ideal.rack_given)} if messages else {}),
            ),
            working_point=point,
            calibration=replace(signals.calibration, slope_rev_s_per_v=tug.set_point_slope_rpm_per_v / 60.0),
        )

    return sail


@pytest.mark.slow
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


@pytest.mark.long
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


@pytest.mark.long
@pytest.mark.slow
def test_rack_with_noise_errs_as_much_as_stated(ship, sailed):
    vessel, campaign = ship
    tug = Tug.stan_tug_1205()
    tug = replace(tug, noise=replace(tug.noise, inflow_rms=0.0))
    weighed = []
    for seed in range(3):
        found = estimate_spectra(sailed(tug, seed, messages=True), campaign).response
        truth = linearised_response(tug, vessel, found.frequency_hz, outputs=("n", "M_s", "X"))
        error = (found.response - truth)[:, 0, :13]
        error = np.concatenate([error.real, error.imag])
        weighed.append(np.einsum("il,lij,jl->l", error, np.linalg.inv(found.covariance[:13]), error))
    # 3 voyages of 13 lines of 6 numbers
    assert np.mean(weighed) / 6.0 == pytest.approx(1.0, abs=0.35)


@pytest.mark.long
@pytest.mark.slow
def test_governor_alone_is_the_pi_of_the_truth(ship, sailed):
    """With noise and steps of 1 %: ``X / e`` is ``K_p + K_i / s`` whatever the load does, within its own covariance."""
    vessel, campaign = ship
    tug = Tug.stan_tug_1205()
    weighed = []
    for seed in range(2):
        response = estimate_spectra(sailed(tug, seed, messages=True), campaign).response
        governor, engine = governor_and_engine(response, set_point_latency_s=tug.set_point_latency_s)
        # two lines are too fast for messages every 50 ms
        assert measured(response)[2].sum() == governor.used.sum() == 14
        s = 1j * governor.omega_rad_s[:14]
        error = governor.response[0, 0, :14] - (tug.proportional_gain + tug.integral_gain_per_s / s)
        parts = np.stack([error.real, error.imag], axis=1)
        weighed.append(np.einsum("li,lij,lj->l", parts, np.linalg.inv(governor.covariance[:14]), parts))
        # the slow lines know the integral gain, the fast ones the proportional gain
        assert governor.response[0, 0, :14] == pytest.approx(5.7 + 4.27 / s, rel=0.1)
        line = linearised_response(tug, vessel, engine.frequency_hz[9:13], outputs=("M_s", "X"))[:, 0]
        assert engine.response[0, 0, 9:13] == pytest.approx(line[0] / line[1], rel=0.06)
    # the covariance was made for three outputs: one alone is weighted a little too low
    assert 0.5 < np.mean(weighed) / 2.0 < 1.3
