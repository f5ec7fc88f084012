"""Structures at the working points of legs, and how well one model explains each."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import identify_jointly
from shaftprint.identify.fit import part_tests
from shaftprint.signals import WorkingPoint
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey import structure_at

OMEGA = np.geomspace(0.2, 15.0, 25)
GAUGE = structure("GAUGE-CLOSED")


def _point(speed_rev_s, torque_nm):
    return WorkingPoint(
        engine_speed_rev_s=speed_rev_s,
        shaft_torque_nm=torque_nm,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=0.0,
        load_std=0.0,
    )


MAIN, OTHER = _point(20.0, 1700.0), _point(14.0, 850.0)


def test_inertia_times_and_gains_go_with_speed_over_torque():
    # an inertia of 17 kg m2 behind a gearbox of 4: 2 pi 17 (14 / 4) / 850 = 0.43982 s at the other working point
    at_main = 2.0 * np.pi * 17.0 * (20.0 / 4.0) / 1700.0
    other = structure_at(GAUGE, OTHER, main=MAIN)
    assert other.factors["tau_dn"] * at_main == pytest.approx(0.439823, rel=1e-5)
    # a rack that changes the torque by 40 N m for an error of 1 rev/s: 40 * 20 / 1700 becomes 40 * 14 / 850
    assert other.factors["K_p"] * 40.0 * 20.0 / 1700.0 == pytest.approx(40.0 * 14.0 / 850.0)
    assert set(other.factors) == {"tau_dn", "tau_up", "K_p", "K_i", "g", "k_q"}
    # a gauge that shows 51 N m too much: k_q is 2 (1 - 51 / 1700) = 1.94, and 2 (1 - 51 / 850) = 1.88 there
    assert other.factors["k_q"] * 1.94 + other.offsets["k_q"] == pytest.approx(1.88)


def test_zero_of_the_gauge_under_a_swinging_speed():
    """With ``M = m u^2 + z`` the working point is ``m + z share``, and the slope ``2 m`` over that."""
    swinging = replace(OTHER, zero_share=1.04)
    other = structure_at(GAUGE, swinging, main=MAIN)
    without_zero = 850.0 - 51.0 * 1.04
    assert other.factors["k_q"] * 1.94 + other.offsets["k_q"] == pytest.approx(2.0 * without_zero / 850.0)


def _response(values, at, *, rng):
    exact = at.response(at.vector(values), 1j * OMEGA)
    std = 2e-3
    noise = std * (rng.standard_normal(exact.shape) + 1j * rng.standard_normal(exact.shape))
    return FrequencyResponse(
        frequency_hz=OMEGA / (2.0 * np.pi),
        response=(exact + noise)[:, np.newaxis],
        covariance=np.broadcast_to(std**2 * np.eye(4), (OMEGA.size, 4, 4)),
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )


def _fit(second_values, *, seed):
    rng = np.random.default_rng(seed)
    other = structure_at(GAUGE, OTHER, main=MAIN)
    pairs = [(GAUGE, _response({}, GAUGE, rng=rng)), (other, _response(second_values, other, rng=rng))]
    return identify_jointly(pairs, rng=np.random.default_rng(1))


def test_one_line_at_two_speeds_is_explained_at_both():
    fit = _fit({}, seed=2)
    tests = part_tests(fit)
    assert fit.p_value > 0.01
    assert all(test.p_value > 0.01 for test in tests)
    # what the parts lose by the fit adds up to the parameters: 200 data and 12 parameters
    assert sum(test.mean for test in tests) == pytest.approx(200.0 - 12.0, abs=0.01)
    assert sum(test.chi_square for test in tests) == pytest.approx(fit.chi_square)


def test_a_governor_with_other_gains_at_the_other_speed_is_refused():
    # a governor whose gains are scheduled on the speed: 10 % more at the other
    fit = _fit({"K_p": 5.5, "K_i": 4.4}, seed=2)
    assert fit.p_value < 1e-6
    assert min(test.p_value for test in part_tests(fit)) < 1e-3


def test_a_fit_to_one_response_is_one_part():
    rng = np.random.default_rng(4)
    response = _response({}, GAUGE, rng=rng)
    known = GAUGE.held_at(tau_up=1.0, g=0.0)
    fit = identify_jointly([(known, response)], rng=np.random.default_rng(1))
    (test,) = part_tests(fit)
    assert test.p_value == pytest.approx(fit.p_value, abs=0.02)
    assert replace(test).degrees_of_freedom == fit.degrees_of_freedom
