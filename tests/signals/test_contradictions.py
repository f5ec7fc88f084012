"""Channels that were swapped show by their pulses and the sign of the torque, without a campaign."""

import pytest

from shaftprint.errors import SignalError
from shaftprint.signals import inspect_channels, prepare_signals
from shaftprint.signals._contradictions import contradictions

PICK_UPS = {"PTM_e": "n_e", "PTM_1": "n_e1", "PTM_4": "n_e4"}


@pytest.fixture
def swapped(ship, spoiled, vessel):
    """What is said of a recording in which columns took each other's places, as new=old."""

    def said(**columns):
        changes = {new: (lambda counts, old=old: ship.counts[old].copy()) for new, old in columns.items()}
        recording = spoiled(**changes)
        return contradictions(inspect_channels(recording, vessel), vessel)

    return said


def test_a_recording_in_order_has_none(swapped):
    assert swapped() == ()


@pytest.mark.parametrize(("one", "other"), [("PTM_e", "PTM_1"), ("PTM_e", "PTM_4"), ("PTM_1", "PTM_4")])
def test_two_pick_ups(swapped, vessel, one, other):
    (sentence,) = swapped(**{one: other, other: one})
    assert sentence.startswith(f"channels {one} and {other} seem to be swapped: expected one engine speed, found ")
    assert f"with {PICK_UPS[one]} = {other}, {PICK_UPS[other]} = {one} all pick-ups agree" in sentence


def test_a_swap_is_no_gear_ratio(swapped):
    """Four strips turn 3.82 times as slowly as the engine's one: 4 / 3.82 pulses of the first to one of the other."""
    (sentence,) = swapped(PTM_e="PTM_1", PTM_1="PTM_e")
    # the engine's channel gives 1 / 3.82, the single strip's 3.82 times the speed
    assert f"found n_e1 / n_e = {3.82**2:.3g}; with" in sentence
    assert "gear ratio" not in sentence


def test_all_three_turned_round(swapped):
    (sentence,) = swapped(PTM_e="PTM_1", PTM_1="PTM_4", PTM_4="PTM_e")
    assert sentence.startswith("channels PTM_e and PTM_1 and PTM_4 seem to be swapped")
    assert "with n_e = PTM_4, n_e1 = PTM_e, n_e4 = PTM_1 all pick-ups agree" in sentence


def test_torque_and_set_point(swapped):
    (sentence,) = swapped(M_s="U_setpoint", U_setpoint="M_s")
    assert sentence.startswith("channels M_s and U_setpoint seem to be swapped: expected a torque around 1725 N m")
    # 500 N m a volt; the set point is around -5 V
    found = float(sentence.partition("a mean of ")[2].partition(" N m")[0])
    assert -2750.0 < found < -2000.0


@pytest.mark.parametrize("other", ["M_s", "U_setpoint"])
def test_a_pick_up_whose_pulses_stand_in_another_channel(ship, spoiled, vessel, campaign, other):
    """So far it was a rate too low for pulses that are noise."""
    recording = spoiled(
        **{
            name: (lambda counts, old=old: ship.counts[old].copy())
            for name, old in (("PTM_e", other), (other, "PTM_e"))
        }
    )
    use = {"M_s": "shaft torque", "U_setpoint": "set point"}[other]
    said = f"channels PTM_e and {other} seem to be swapped: expected pulses in PTM_e, found them in {other}, .* {use}"
    with pytest.raises(SignalError, match=said):
        prepare_signals(recording, vessel, campaign)
    reports = {one.channel: one.problem for one in inspect_channels(recording, vessel)}
    assert f"channels PTM_e and {other} seem to be swapped" in reports["PTM_e"]


def test_a_set_point_that_stands_in_the_channel_of_the_torque(ship, spoiled, vessel, campaign):
    """Both positive, as a lever in mA is: no sign tells."""
    recording = spoiled(M_s=lambda counts: -ship.counts["U_setpoint"], U_setpoint=lambda counts: -ship.counts["M_s"])
    with pytest.raises(SignalError, match="channels U_setpoint and M_s seem to be swapped: expected the set point of"):
        prepare_signals(recording, vessel, campaign)


def test_units_that_stand_in_each_others_channels_are_a_swap_and_a_channel_that_is_taken_is_no_advice(
    ship, spoiled, vessel, campaign
):
    """PTM_e and others are in V too: what another sensor has is never advised."""
    gauge = vessel.sensors.shaft_torque.model_copy(update={"unit": "kN m", "scale_nm_per_unit": 1000.0})
    in_knm = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": gauge})})
    swapped = spoiled(units={"M_s": "V", "U_setpoint": "kN m"})
    with pytest.raises(SignalError, match=r"U_setpoint has it, and is to be in V: the two seem to be swapped"):
        prepare_signals(swapped, in_knm, campaign)
    with pytest.raises(SignalError, match=r'found "mA"; correct the unit in the vessel file, and the scale'):
        prepare_signals(spoiled(units={"U_setpoint": "mA"}), vessel, campaign)


def test_a_gauge_mounted_the_other_way_round(spoiled, vessel):
    recording = spoiled(M_s=lambda counts: -counts)
    (sentence,) = contradictions(inspect_channels(recording, vessel), vessel)
    assert sentence.startswith("channel M_s: expected a torque around 1725 N m, found a mean of -")
    assert "the sign of sensors.shaft_torque.scale_nm_per_unit" in sentence


def test_a_wrong_number_of_strips_is_no_swap(ship, vessel):
    *others, four = vessel.sensors.speed
    speed = (*others, four.model_copy(update={"pulses_per_revolution": 3}))
    wrong = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"speed": speed})})
    (sentence,) = contradictions(inspect_channels(ship.recording(), wrong), wrong)
    assert "swapped" not in sentence
    assert "as with 4 pulses of n_e4 where 3 are stated; check pulses_per_revolution in the vessel file" in sentence


def test_a_wrong_gear_ratio_is_no_swap(ship, vessel):
    wrong = vessel.model_copy(update={"gearbox": vessel.gearbox.model_copy(update={"ratio": 4.5})})
    (sentence,) = contradictions(inspect_channels(ship.recording(), wrong), wrong)
    assert "swapped" not in sentence
    assert "as with a gear ratio of 3.82 instead of 4.5; check gearbox.ratio and pulses_" in sentence
    assert "pulses of" not in sentence
