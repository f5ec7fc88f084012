"""A planned test that is broken off goes on where it ended: whole periods count, those of the next leg too."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.design import Wish, read_plan, write_plan_files
from shaftprint.errors import DesignError
from shaftprint.recording import cut, read_recording, write_recording
from shaftprint.rehearsal import standing_after
from shaftprint.rehearsal._simulated_ship import tug_of_plan
from shaftprint.survey import Trial, measure
from shaftprint.tug import sail

pytestmark = pytest.mark.slow


def wishing(test, **relative):
    """The same plan with wishes."""
    plan = replace(test.plan, wish=Wish(relative=relative))
    return replace(test, plan=plan)


@pytest.fixture(scope="module")
def voyage(test, vessel, tmp_path_factory):
    """What a voyage records until a second, by a campaign and a seed."""
    tug = tug_of_plan(test, vessel)

    def recorded(campaign, seed, until_s=None):
        folder = tmp_path_factory.mktemp("voyage")
        sail(vessel, campaign, folder / "whole.nc", tug=tug, seed=seed)
        if until_s is None:
            return folder / "whole.nc"
        with read_recording(folder / "whole.nc") as whole:
            write_recording(folder / "part.nc", cut(whole, to_s=until_s).channels.values())
        return folder / "part.nc"

    return recorded


@pytest.fixture(scope="module")
def broken_off(test, vessel, voyage):
    """All of the first leg and two and a half periods of the second."""
    second = test.campaign.multisines[1]
    path = voyage(test.campaign, 5, second.settled_s + 2.5 * second.period_s)
    return measure(path, Trial(vessel=vessel, campaign=test.campaign))


def test_a_leg_that_is_broken_off_counts_to_its_last_whole_period(test, vessel, broken_off):
    standing = standing_after(test, broken_off, Trial(vessel=vessel, campaign=test.campaign))
    assert standing.recorded == {"M1": test.plan.legs[0].periods, "M2": 2}
    # nothing is wished: what is left of the plan, at least two periods
    assert standing.more == {"M1": 0, "M2": max(test.plan.legs[1].periods - 2, 2)}
    assert [leg.level_rpm for leg in standing.remaining.plan.legs] == [test.plan.legs[1].level_rpm]
    # sailed with the noise that it was planned with, near enough
    assert 0.3 < standing.noise_ratio < 3.0


def test_wishes_that_are_met_need_no_more(test, vessel, broken_off):
    trial = Trial(vessel=vessel, campaign=test.campaign)
    standing = standing_after(wishing(test, tau_dn=0.5, K_p=0.9), broken_off, trial)
    assert standing.is_enough
    assert standing.remaining is None
    assert standing.sentences[0] == "Every wish is met, as predicted."


def test_what_no_period_of_these_lines_meets_is_said(test, vessel, broken_off):
    trial = Trial(vessel=vessel, campaign=test.campaign)
    standing = standing_after(wishing(test, K_p=1e-5), broken_off, trial)
    assert standing.more is None
    assert "no number of further periods" in standing.sentences[0]


def test_the_next_leg_closes_the_gap(test, vessel, broken_off, voyage, tmp_path):
    """The further recording alone has the legs that were missing; both together meet the wish, with right numbers."""
    so_far = standing_after(test, broken_off, Trial(vessel=vessel, campaign=test.campaign))
    std = {one.name: one.std for one in so_far.fit.parameters}
    wished = wishing(test, tau_up=0.6 * std["tau_up"] / 0.93)
    standing = standing_after(wished, broken_off, Trial(vessel=vessel, campaign=test.campaign))
    assert not standing.is_enough
    assert standing.ratios["tau_up"] > 1.0
    assert standing.remaining.plan.ratios["tau_up"] == pytest.approx(1.0, abs=0.1)
    write_plan_files(standing.remaining, tmp_path, rate_hz=100.0)
    further, campaign = read_plan(tmp_path), load_campaign(tmp_path / "campaign.toml")
    assert len(further.sailed) == 2
    trial = Trial(vessel=vessel, campaign=campaign)
    final = standing_after(further, measure(voyage(campaign, 6), trial), trial)
    # the further recording has a noise of its own
    assert final.ratios["tau_up"] <= 1.05 * np.sqrt(final.noise_ratio / standing.noise_ratio)
    found = {one.name: one for one in final.fit.parameters}
    for name, truth in (("tau_up", 0.93), ("K_p", 4.9), ("tau_dn", 0.36)):
        assert abs(found[name].value - truth) < 4.0 * found[name].std, name


def test_a_recording_of_something_else_is_refused(test, vessel, broken_off):
    foreign = replace(broken_off, legs=())
    with pytest.raises(DesignError, match="expected a leg such as M1"):
        standing_after(test, foreign, Trial(vessel=vessel, campaign=test.campaign))


def test_limits_are_kept_for_the_ship_that_is_found(test, vessel, broken_off):
    """Half the deviation of the set point is allowed: the next leg has half the amplitudes, or less."""
    allowed_rpm = 0.5 * test.plan.peaks[1].set_point_rpm
    narrow = replace(test, plan=replace(test.plan, limits=replace(test.plan.limits, set_point_rpm=allowed_rpm)))
    standing = standing_after(narrow, broken_off, Trial(vessel=vessel, campaign=test.campaign))
    further = standing.remaining.plan
    strength = np.abs(further.legs[0].amplitudes) / np.abs(test.plan.legs[1].amplitudes)
    assert np.ptp(strength) < 1e-9
    assert strength[0] == pytest.approx(0.5, rel=0.01)
    assert further.peaks[0].set_point_rpm == pytest.approx(allowed_rpm, rel=0.01)
    assert max(further.peaks[0].uses.values()) <= 1.0 + 1e-9
