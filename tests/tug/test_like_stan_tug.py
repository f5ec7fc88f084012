"""The truth of the Stan Tug for another ship: its lever asks for that ship's speed at -5 V."""

import pytest

from shaftprint.tug import Tug


def test_at_its_own_speed_it_is_the_stan_tug():
    assert Tug.like_stan_tug_1205(1183.8) == Tug.stan_tug_1205()


def test_lever_of_another_ship_asks_for_its_working_speed():
    """The tug's slope of -251 rpm/V is 21.2 % of 1183.8 rpm, so 106 rpm/V for 500 rpm."""
    tug = Tug.like_stan_tug_1205(500.0)
    voltage = -5.0 + tug.set_point_offset_v
    assert tug.set_point_slope_rpm_per_v * voltage + tug.set_point_intercept_rpm == pytest.approx(500.0, rel=1e-6)
    assert tug.set_point_slope_rpm_per_v == pytest.approx(-106.0, rel=1e-3)
    assert tug.proportional_gain == Tug.stan_tug_1205().proportional_gain
