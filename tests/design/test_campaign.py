"""A plan as a campaign: the voltage that is put out is the planned speed."""

import numpy as np
import pytest

from shaftprint.campaign import setpoint
from shaftprint.design import campaign_of
from shaftprint.errors import DesignError

SLOPE = -251.2


@pytest.fixture(scope="module")
def campaign(plan):
    """The plan on a tug that asks for more speed with a lower voltage, -5 V at 1183.8 rpm."""
    return campaign_of(plan, name="planned", offset_v=-5.0, slope_rpm_per_v=SLOPE)


def speed_rpm(campaign, time_s):
    return 1183.8 + SLOPE * (setpoint(campaign, time_s) + 5.0)


def test_voltage_is_the_planned_speed(plan, campaign):
    for leg, multisine in zip(plan.legs, campaign.multisines, strict=True):
        time = np.linspace(multisine.start_s, multisine.stop_s, 5000, endpoint=False)
        assert speed_rpm(campaign, time) == pytest.approx(leg.set_point_rpm(time - multisine.start_s), abs=1e-6)
        assert multisine.periods == leg.periods
        assert multisine.level_v == pytest.approx(-5.0 + (leg.level_rpm - 1183.8) / SLOPE)


def test_ramps_go_from_level_to_level_without_a_jump(plan, campaign):
    first, second = campaign.multisines
    time = np.arange(first.stop_s, second.start_s, 0.01)
    speed = speed_rpm(campaign, time)
    assert (speed[0], speed[-1]) == pytest.approx((plan.legs[0].level_rpm, plan.legs[1].level_rpm), abs=1.0)
    assert np.abs(np.diff(speed)).max() == pytest.approx(0.3, rel=1e-3)
    assert campaign.offset_v == first.level_v
    # a ramp back and a rest of 5 s
    assert campaign.duration_s == pytest.approx(second.stop_s + 0.45 * 1183.8 / 30.0 + 0.01 + 5.0)
    assert campaign.duration_s == plan.duration_s


def test_set_point_without_a_slope_is_refused(plan):
    with pytest.raises(DesignError, match="campaign planned: expected a slope of the set point in rpm"):
        campaign_of(plan, name="planned", offset_v=-5.0, slope_rpm_per_v=0.0)
