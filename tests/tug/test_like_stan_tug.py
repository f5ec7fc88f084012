"""The truth of the Stan Tug for another ship: its lever asks for that ship's speed, its governor does not hunt."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, like_stan_tug_1205
from shaftprint.vessel import load_vessel

STAN_TUG = load_vessel("stan-tug-1205")


def changed(part, **values):
    return STAN_TUG.model_copy(update={part: getattr(STAN_TUG, part).model_copy(update=values)})


def test_for_its_own_ship_it_is_the_stan_tug():
    assert like_stan_tug_1205(STAN_TUG) == Tug.stan_tug_1205()


def test_lever_of_another_ship_asks_for_its_working_speed():
    """The tug's slope of -251 rpm/V is 21.2 % of 1183.8 rpm, so 106 rpm/V for 500 rpm."""
    tug = like_stan_tug_1205(changed("working_point", engine_speed_rpm=500.0))
    voltage = -5.0 + tug.set_point_offset_v
    assert tug.set_point_slope_rpm_per_v * voltage + tug.set_point_intercept_rpm == pytest.approx(500.0, rel=1e-6)
    assert tug.set_point_slope_rpm_per_v == pytest.approx(-106.0, rel=1e-3)


def test_governor_of_a_light_line_has_smaller_gains():
    """Twice the torque at the same speed halves the inertia time of 1.336 s."""
    torque_nm = 2.0 * STAN_TUG.working_point.shaft_torque_nm
    tug, own = like_stan_tug_1205(changed("working_point", shaft_torque_nm=torque_nm)), Tug.stan_tug_1205()
    assert tug.proportional_gain == pytest.approx(0.502 * own.proportional_gain, rel=2e-3)
    assert tug.integral_gain_per_s / tug.proportional_gain == pytest.approx(
        own.integral_gain_per_s / own.proportional_gain
    )


def test_governor_of_a_heavy_line_is_left_alone():
    torque_nm = 0.5 * STAN_TUG.working_point.shaft_torque_nm
    tug = like_stan_tug_1205(changed("working_point", shaft_torque_nm=torque_nm))
    assert tug.proportional_gain == Tug.stan_tug_1205().proportional_gain


def test_underway_the_lever_asks_for_the_working_speed_at_the_voltage_of_the_campaign():
    vessel = load_vessel("stan-tug-1205-underway")
    tug = like_stan_tug_1205(vessel, offset_v=-6.66)
    voltage = -6.66 + tug.set_point_offset_v
    assert tug.set_point_slope_rpm_per_v * voltage + tug.set_point_intercept_rpm == pytest.approx(1600.0, rel=1e-3)
    assert (tug.sailing.wake_fraction, tug.sailing.thrust_deduction) == (0.20, 0.15)


def test_underway_another_propeller_is_refused():
    vessel = load_vessel("stan-tug-1205-underway")
    propeller = vessel.propeller.model_copy(update={"series": "Wageningen B"})
    with pytest.raises(SettingsError, match=r"expected a propeller Ka4-70 in nozzle 19A .* found Wageningen B"):
        like_stan_tug_1205(vessel.model_copy(update={"propeller": propeller}), offset_v=-6.66)
