"""Physical values against numbers worked out by hand for the Stan Tug 1205 at 1183.8 rpm and 1725 N m.

The propeller shaft turns at 1183.8 / 60 / 3.82 = 5.164921 rev/s, so 2 pi n_s0 = 32.45216 rad/s.
"""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.fingerprint import physical_quantities
from shaftprint.identify import Prior, Settings


@pytest.fixture
def found(gauge_fit, working_point, vessel):
    return {quantity.name: quantity for quantity in physical_quantities(gauge_fit, working_point, vessel)}


@pytest.mark.parametrize(
    ("name", "value", "unit"),
    [
        ("I_dn", 17.0096, "kg m2"),  # 0.32 * 1725 / 32.45216
        ("I_up", 54.0056, "kg m2"),  # 1.016 * 1725 / 32.45216
        ("governor proportional action", 8.30588, "N m/rpm"),  # 5.7 * 1725 / 1183.8
        ("governor integral action", 6.22212, "N m/(rpm s)"),  # 4.27 * 1725 / 1183.8
        ("K_Q", 0.049430, "-"),  # 1725 / (1025 * 5.164921^2 * 1.05^5)
    ],
)
def test_values_are_those_worked_out_by_hand(found, name, value, unit):
    assert found[name].value == pytest.approx(value, rel=2e-5)
    assert found[name].unit == unit


def test_values_stand_beside_those_of_the_torsional_vibration_calculation(found):
    assert (found["I_up"].expected, found["I_dn"].expected) == pytest.approx((54.006, 17.0), abs=1e-3)
    # water 1.5, propeller 0.61 and shaft 0.10 kg m2 in quadrature
    assert found["I_dn"].expected_std == pytest.approx(1.6224, rel=1e-3)
    assert found["K_Q"].expected == 0.04943
    assert found["governor integral action"].expected is None


def known_from_a_prior(fit, name, values, parameter, std, held=()):
    """A fit whose data say next to nothing, so that all that is known of one parameter is its prior."""
    settings = Settings(starts=5, priors={parameter: Prior(values[parameter], std)})
    return fit(name, values, share=1e4, settings=settings, held=held)


@pytest.fixture
def core(fit):
    """An inertia time of 0.32 s, known to 1 %."""
    return known_from_a_prior(fit, "OL1", {"tau_n": 0.32}, "tau_n", 0.0032)


def test_standard_deviations_are_fit_and_gauge_in_quadrature(core, working_point, vessel):
    # 1 % of the fit and 2 % of the gauge's scale: 2.236068 %
    found = {quantity.name: quantity for quantity in physical_quantities(core, working_point, vessel)}
    assert found["I"].value == pytest.approx(17.0096, rel=1e-5)
    assert found["I"].std == pytest.approx(0.02236068 * 17.0096, rel=1e-4)
    # 2 % of the gauge's scale, 25 / 1725 of its zero, 0.5 % of the load
    assert found["K_Q"].std == pytest.approx(0.0252000 * 0.049430, rel=1e-4)


def test_standard_deviation_of_the_governor_action(fit, truth, working_point, vessel):
    held = ["K_i", "tau_dn", "tau_up", "k_q", "g", "t_sp", "omega_n", "c_set"]
    governed = known_from_a_prior(fit, "GAUGE-CLOSED", truth, "K_p", 0.057, held=held)
    found = {quantity.name: quantity for quantity in physical_quantities(governed, working_point, vessel)}
    assert found["governor proportional action"].std == pytest.approx(0.02236068 * 8.30588, rel=1e-3)
    # K_i is held: 2 % of the gauge's scale, 0.5 % of the load and 0.01 of 19.73 rev/s, by which it is multiplied
    assert found["governor integral action"].std == pytest.approx(0.0206217 * 6.22212, rel=1e-4)


def test_accuracy_that_is_not_stated_is_that_of_the_trade(core, working_point, vessel):
    sensor = vessel.sensors.shaft_torque.model_copy(update={"scale_std_fraction": None, "zero_std_nm": None})
    plain = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": sensor})})
    point = replace(working_point, load_std=0.01)
    found = {quantity.name: quantity for quantity in physical_quantities(core, point, plain)}
    # 1 % of the fit and 1 % of the scale; 1 % of the working point, 1 % of the scale and 25 N m of the zero
    assert found["I"].std == pytest.approx(17.0096 * 0.01 * 2.0**0.5, rel=1e-4)
    assert found["K_Q"].std == pytest.approx(0.049430 * (2.0 * 0.01**2 + (25.0 / 1725.0) ** 2) ** 0.5, rel=1e-4)


def test_inertia_of_the_thesis_is_that_of_its_own_arithmetic(fit, working_point, vessel):
    # thesis: tau_n 0.3897 s; 0.3897 * 1725 / 32.45216 = 20.71 kg m2
    core = fit("OL1", {"tau_n": 0.3897})
    found = {quantity.name: quantity for quantity in physical_quantities(core, working_point, vessel)}
    assert set(found) == {"I", "K_Q"}
    assert found["I"].value == pytest.approx(20.71, abs=0.01)
    assert found["I"].expected == pytest.approx(54.006, abs=1e-3)


def test_values_grow_with_the_torque_of_the_working_point(gauge_fit, working_point, vessel):
    # twice the torque at the same normalised inertia time: twice the inertia, the same share of uncertainty of the fit
    double = replace(working_point, shaft_torque_nm=3450.0, shaft_torque_std_nm=16.0)
    once = physical_quantities(gauge_fit, working_point, vessel)
    twice = physical_quantities(gauge_fit, double, vessel)
    for before, after in zip(once, twice, strict=True):
        factor = 1.0 if before.name == "gauge zero share" else 2.0
        assert after.value == pytest.approx(factor * before.value)
        if before.name != "K_Q":
            assert after.std == pytest.approx(factor * before.std)


def test_torque_coefficient_is_that_of_the_whole_test(core, working_point, vessel):
    """The mean load is known to 0.6 %."""
    point = replace(working_point, load_std=0.006, engine_speed_std_rev_s=0.5)
    found = {quantity.name: quantity for quantity in physical_quantities(core, point, vessel)}
    assert found["K_Q"].value == pytest.approx(0.049430, rel=2e-5)
    # 2 % of the gauge's scale, 25 / 1725 of its zero, 0.6 % of the load; not the speed, whose square the torque follows
    assert found["K_Q"].std == pytest.approx(0.0254172 * 0.049430, rel=1e-4)


def test_a_zero_that_the_fit_has_found_is_off_the_torque_coefficient(fit, truth, working_point, vessel):
    """Of 1725 N m 50 are the gauge's zero: the propeller takes 1675, and its slope is 2 * 1675 / 1725."""
    found = fit("GAUGE-CLOSED", truth | {"k_q": 2.0 * 1675.0 / 1725.0})
    numbers = {q.name: q for q in physical_quantities(found, replace(working_point, load_std=0.006), vessel)}
    assert numbers["K_Q"].value == pytest.approx(1675.0 / 1725.0 * 0.049430, rel=1e-4)
    slope = next(e for e in found.parameters if e.name == "k_q")
    own = np.hypot(slope.std / slope.value, 0.006)
    assert numbers["K_Q"].std / numbers["K_Q"].value == pytest.approx(np.hypot(own, 0.02), rel=1e-3)
    # beside it what the vessel file knows of the zero: 25 of 1725 N m
    zero = numbers["gauge zero share"]
    assert (zero.expected, zero.expected_std) == (0.0, pytest.approx(1.44928, rel=1e-5))
