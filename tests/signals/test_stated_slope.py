"""A campaign that says which lever it was made for is held against the line that was recorded."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.signals import SetPointCalibration
from shaftprint.signals.levels._working_point import expect_stated_slope

CAMPAIGN = load_campaign("12min")


def recorded(slope_rpm_per_v, std_rpm_per_v=0.5):
    return SetPointCalibration(
        slope_rev_s_per_v=slope_rpm_per_v / 60.0,
        intercept_rev_s=0.0,
        covariance=np.diag([(std_rpm_per_v / 60.0) ** 2, 0.0]),
        level_v=np.array([-6.0, -4.0]),
        level_rev_s=np.array([25.0, 17.0]),
        level_std_rev_s=np.array([0.01, 0.01]),
    )


@pytest.mark.parametrize("slope", [-250.0, -262.0, -238.0])
def test_a_lever_as_planned_is_no_finding(slope):
    stated = CAMPAIGN.model_copy(update={"slope_rpm_per_v": -250.0})
    assert expect_stated_slope(recorded(slope), stated) == ()


@pytest.mark.parametrize("slope", [250.0, -125.0, -290.0])
def test_another_lever_is_named_with_both_slopes(slope):
    (said,) = expect_stated_slope(recorded(slope), CAMPAIGN.model_copy(update={"slope_rpm_per_v": -250.0}))
    assert f"{slope:.4g} rpm for one volt as recorded" in said
    assert "-250 rpm by slope_rpm_per_v of the campaign file" in said


def test_what_is_not_known_contradicts_nothing():
    """Five levels a hundredth of a volt apart tell no slope; and nothing is said where no lever is stated."""
    stated = CAMPAIGN.model_copy(update={"slope_rpm_per_v": -250.0})
    assert expect_stated_slope(recorded(-300.0, std_rpm_per_v=20.0), stated) == ()
    assert expect_stated_slope(recorded(100.0), CAMPAIGN.model_copy(update={"slope_rpm_per_v": None})) == ()
