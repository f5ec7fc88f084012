"""What a campaign will make a ship do, held against the envelope before anything is armed."""

import pytest

import shaftprint as sp
from shaftprint.live._envelope import envelope_of
from shaftprint.live._proof import prove

VESSEL = sp.vessel.load_vessel("stan-tug-1205")


def foreseen(campaign, **known):
    proof = prove(sp.campaign.load_campaign(campaign), VESSEL, envelope_of(VESSEL, is_rehearsed=True), **known)
    return {one.quantity: one for one in proof.foreseen}, proof


def test_the_second_speed_of_a_shipped_test_is_foreseen_where_the_ship_goes():
    # simulated without noise the tug goes from 627 to 1624 rpm; a loop that is linear about the first speed said 484
    found, proof = foreseen("5min", slope_rpm_per_v=-251.0)
    assert proof.refusals == ()
    assert 600.0 < found["engine speed"].lowest < 640.0
    assert 1620.0 < found["engine speed"].highest < 1720.0


def test_a_campaign_below_idle_is_refused_with_the_speed():
    _, proof = foreseen("5min", slope_rpm_per_v=-290.0)
    assert any("engine speed: expected within 600 to 1800 rpm" in words for words in proof.refusals)


@pytest.mark.slow
def test_a_fingerprint_foresees_with_its_own_slope_and_band(demo):
    folder, _ = demo
    fingerprint = sp.fingerprint.read_fingerprint(folder / "fingerprint.json")
    campaign = folder / "campaign.toml"
    found, proof = foreseen(campaign, fingerprint=fingerprint)
    usual, _ = foreseen(campaign, slope_rpm_per_v=-251.0)
    assert "fingerprint" in proof.band
    assert found["engine speed"].lowest == pytest.approx(usual["engine speed"].lowest, rel=0.2)
    assert found["engine speed"].highest == pytest.approx(usual["engine speed"].highest, rel=0.1)
    # how the torque swings is known, where of a usual ship it may swing half as much again
    assert usual["shaft torque"].lowest < found["shaft torque"].lowest < 0.0
    assert 2300.0 < found["shaft torque"].highest < usual["shaft torque"].highest


def test_a_lever_of_which_nothing_is_known_is_asked_for():
    with pytest.raises(sp.errors.LiveError, match="--rpm-per-volt"):
        foreseen("short")
