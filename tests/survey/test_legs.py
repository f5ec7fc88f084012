"""Structures at the working points of legs, and how well one model explains each."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import shipped_structure, structure
from shaftprint.identify import identify_jointly, priors_from_vessel
from shaftprint.identify.fit._part_tests import part_tests
from shaftprint.signals import WorkingPoint
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey._legs import structure_at
from shaftprint.survey._of_vessel import at_speeds
from shaftprint.vessel import load_vessel

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


def _fit_of_bent_lever(structure_of_fit, *, seed):
    """Return a fit to a lever whose slope is 0.6 % less at 14 than at 20 rev/s: a bend of 0.02 at twice the speed."""
    rng = np.random.default_rng(seed)
    pairs = []
    for point, scale in ((MAIN, 1.003), (OTHER, 0.997)):
        true, fitted = (structure_at(one, point, main=MAIN) for one in (GAUGE, structure_of_fit))
        pairs.append((fitted, _response({"c_set": scale}, true, rng=rng)))
    return identify_jointly(pairs, rng=np.random.default_rng(1))


def _away(fit, name, truth):
    estimate = next(one for one in fit.parameters if one.name == name)
    return (estimate.value - truth) / estimate.std


def test_lever_that_bends_moves_no_gain():
    # 1.003 (1 - 0.3 b) = 0.997
    bend = 0.006 / 1.003 / 0.3
    fit = _fit_of_bent_lever(at_speeds(GAUGE, (20.0, 14.0)), seed=0)
    assert fit.p_value > 0.01
    assert abs(_away(fit, "b_set", bend)) < 3.5
    assert abs(_away(fit, "K_p", 5.0)) < 3.5
    assert abs(_away(fit, "c_set", 1.003)) < 3.5
    # one scale for both speeds: what the bend does is put into the line, or seen as a misfit
    plain = _fit_of_bent_lever(GAUGE, seed=0)
    assert plain.p_value < 1e-3 or abs(_away(plain, "K_p", 5.0)) > 3.5


def test_bend_acts_at_other_speeds_alone_and_keeps_its_gradient():
    bent = at_speeds(GAUGE, (20.0, 14.0))
    values, s = {"b_set": 0.02}, 1j * OMEGA
    at_main, at_other = structure_at(bent, MAIN, main=MAIN), structure_at(bent, OTHER, main=MAIN)
    plain = structure_at(GAUGE, OTHER, main=MAIN)
    assert at_main.response(bent.vector(values), s) == pytest.approx(GAUGE.response(GAUGE.vector({}), s))
    # at 14 of 20 rev/s the slope is 1 - 0.3 * 0.02 of that at 20
    assert at_other.response(bent.vector(values), s) == pytest.approx(0.994 * plain.response(GAUGE.vector({}), s))
    _, slope = at_other.gradient(bent.vector(values), s, ["b_set"])
    assert slope[0] == pytest.approx(-0.3 * plain.response(GAUGE.vector({}), s))


def test_legs_of_one_speed_have_no_bend():
    assert at_speeds(GAUGE, (20.0, 20.1)) is GAUGE
    assert at_speeds(structure("ENGINE"), (20.0, 14.0)).names == structure("ENGINE").names


def test_structure_of_a_file_with_a_bend_is_bent():
    names = at_speeds(GAUGE, (20.0, 14.0)).names
    assert shipped_structure("GAUGE-CLOSED", names).names == names
    assert shipped_structure("GAUGE-CLOSED", GAUGE.names).names == GAUGE.names


def test_vessel_file_says_how_far_a_lever_may_bend():
    vessel = load_vessel("stan-tug-1205")
    bent = at_speeds(GAUGE, (20.0, 14.0))
    # 1.5 % at twice the 1183.8 rpm of the vessel file is 1.521 % at twice 1200 rpm
    assert priors_from_vessel(bent, vessel, MAIN)["b_set"].std == pytest.approx(0.015 * 1200.0 / 1183.8)
    sensor = vessel.sensors.set_point.model_copy(update={"bend_std": 0.002})
    stated = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"set_point": sensor})})
    assert priors_from_vessel(bent, stated, MAIN)["b_set"].std == pytest.approx(0.002 * 1200.0 / 1183.8)
    assert "b_set" not in priors_from_vessel(GAUGE, vessel, MAIN)
