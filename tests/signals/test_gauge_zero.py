"""The zero of the torque gauge from the law of the propeller, against torques that were written down for it."""

from dataclasses import replace

import pytest

from shaftprint.signals import WorkingPoint
from shaftprint.signals.levels._gauge_zero import zero_between, zero_of_share, zero_reason
from shaftprint.vessel import load_vessel

TUG = load_vessel("stan-tug-1205")
# 4000 N m at 20 rev/s and a quarter of that at half the speed, shown with 300 N m too much
FAST = WorkingPoint(
    engine_speed_rev_s=20.0, shaft_torque_nm=4300.0, engine_speed_std_rev_s=0.0, shaft_torque_std_nm=40.0,
    set_point_v=-5.0, load_std=0.01,
)  # fmt: skip
SLOW = replace(FAST, engine_speed_rev_s=10.0, shaft_torque_nm=1300.0, shaft_torque_std_nm=10.0)


@pytest.mark.parametrize("points", [(FAST, SLOW), (SLOW, FAST)])
def test_two_speeds_tell_it(points):
    zero_nm, std_nm = zero_between(points)
    assert zero_nm == pytest.approx(300.0)
    # a quarter of 40 N m beside 10 N m, over three quarters
    assert std_nm == pytest.approx(18.856, abs=1e-3)


def test_two_speeds_that_are_near_each_other_tell_nothing():
    assert zero_between((FAST, replace(FAST, engine_speed_rev_s=18.5, shaft_torque_nm=3722.5))) is None


def test_a_slope_of_the_load_tells_it_too():
    """Of 4300 N m the law of the square moves 4000: a slope of 2 * 4000 / 4300, which is a share of 7.5 %."""
    zero_nm, std_nm = zero_of_share(0.075, 0.01, 4300.0)
    assert zero_nm == pytest.approx(300.0)
    assert std_nm == pytest.approx(0.01 * 4300.0 / 1.075**2)


def test_it_is_told_with_the_number_that_belongs_into_the_vessel_file():
    sensor = TUG.sensors.shaft_torque.model_copy(update={"zero_nm": 20.0})
    vessel = TUG.model_copy(update={"sensors": TUG.sensors.model_copy(update={"shaft_torque": sensor})})
    reason = zero_reason(-300.0, 12.0, 1700.0, vessel)
    assert reason.kind == "gauge zero"
    assert "-300 +/- 12 N m are taken off" in reason.sentence
    assert "zero_nm = -280" in reason.sentence


def test_a_zero_that_the_vessel_file_or_dry_friction_allows_is_no_reason():
    allowed = 3.0 * (TUG.sensors.shaft_torque.zero_std**2 + 17.0**2) ** 0.5
    assert zero_reason(0.99 * allowed, 0.0, 1700.0, TUG) is None
    assert zero_reason(-1.01 * allowed, 0.0, 1700.0, TUG) is not None


def test_at_one_speed_where_a_gauge_that_bends_looks_alike_two_deviations_speak_against_it():
    allowed = 2.0 * (TUG.sensors.shaft_torque.zero_std**2 + 17.0**2) ** 0.5
    assert zero_reason(0.99 * allowed, 0.0, 1700.0, TUG, by_slope=True) is None
    assert zero_reason(1.01 * allowed, 0.0, 1700.0, TUG, by_slope=True).kind == "gauge line"


def test_underway_nothing_tells_it_from_the_way_of_the_ship():
    assert zero_reason(1000.0, 12.0, 1700.0, load_vessel("stan-tug-1205-underway")) is None
