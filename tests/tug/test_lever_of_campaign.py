"""A campaign that says which lever it was made for is sailed with that lever."""

import pytest

from shaftprint.campaign import Campaign, Staircase
from shaftprint.errors import SettingsError
from shaftprint.tug import like_stan_tug_1205
from shaftprint.tug._like_stan_tug import with_lever_of
from shaftprint.tug.plant._demand import Demand
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")


def steps(**stated):
    stairs = Staircase(name="St1", levels_v=(6.5, 6.0), dwell_s=5.0, start_s=5.0)
    return Campaign(name="Lever of one's own", duration_s=20.0, offset_v=6.0, staircases=(stairs,), **stated)


def first_rpm(campaign):
    tug = with_lever_of(like_stan_tug_1205(VESSEL), VESSEL, campaign)
    return 60.0 * Demand(tug, VESSEL, campaign, start_s=0.0, step_s=1e-3).first


@pytest.mark.parametrize(("offset_rpm", "asked_rpm"), [(None, 1183.8), (1361.0, 1361.0)])
def test_it_asks_for_the_speed_of_the_campaign_at_its_offset(offset_rpm, asked_rpm):
    assert first_rpm(steps(slope_rpm_per_v=120.0, offset_rpm=offset_rpm)) == pytest.approx(asked_rpm, rel=1e-9)


def test_one_volt_more_asks_for_the_stated_slope():
    """Half a volt of 120 rpm/V is 60 rpm."""
    campaign = steps(slope_rpm_per_v=120.0)
    demand = Demand(
        with_lever_of(like_stan_tug_1205(VESSEL), VESSEL, campaign), VESSEL, campaign, start_s=7.0, step_s=1e-3
    )
    assert 60.0 * demand.first == pytest.approx(1183.8 + 60.0, rel=1e-9)


def test_without_a_stated_lever_the_tug_keeps_its_own():
    """At 6 V the lever of the tug asks for a negative speed, and the refusal says which fields would help."""
    usual = like_stan_tug_1205(VESSEL)
    assert with_lever_of(usual, VESSEL, steps()) == usual
    with pytest.raises(SettingsError, match="state slope_rpm_per_v and offset_rpm in the campaign file"):
        first_rpm(steps())
