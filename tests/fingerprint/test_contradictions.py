"""What a test contradicts of the vessel file, against what was stated of it."""

import re
from dataclasses import replace
from types import SimpleNamespace

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.fingerprint._contradictions import contradictions
from shaftprint.identify import Estimate
from shaftprint.signals import WorkingPoint
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel import load_vessel

CAMPAIGN = load_campaign("12min")
TUG = load_vessel("stan-tug-1205")


def _numbers(factor, vessel):
    """Torque coefficient and inertia behind the gauge, both so many times what the file expects."""
    coefficient, inertia = vessel.torque_coefficient, 17.0
    return (
        Estimate(
            name="K_Q", unit="-", value=factor * coefficient, std=0.01 * coefficient,
            expected=coefficient, expected_std=vessel.torque_coefficient_std,
        ),
        Estimate(
            name="I_dn", unit="kg m2", value=factor * inertia, std=0.015 * inertia, expected=inertia, expected_std=6.0
        ),
    )  # fmt: skip


def _reasons(factor, vessel):
    return _reasons_of(_numbers(factor, vessel), vessel, factor)


def _reasons_of(numbers, vessel, factor=1.0):
    # 1.15 times the speed of the working point: by the law of the propeller 1.15^2 of its torque
    point = WorkingPoint(
        engine_speed_rev_s=1.15 * rev_s_from_rpm(vessel.working_point.engine_speed_rpm),
        shaft_torque_nm=factor * 1.15**2 * vessel.working_point.shaft_torque_nm,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=-5.7,
        load_std=0.0,
    )
    signals = SimpleNamespace(working_point=point, levels_rpm=(), legs=(), read_hz=2000.0)
    return contradictions(numbers, signals, vessel, CAMPAIGN)


def test_a_gauge_that_shows_too_little_is_told_by_the_torque_over_the_square_of_the_speed():
    (reason,) = _reasons(0.9, TUG)
    assert "torque over the square of the speed, K_Q and I_dn are 0.90, 0.90 and 0.90 times" in reason.sentence
    # the fifth power of 1.028 / 1.05 is 0.9
    assert "500 N m for one V is stated, 555.6 would fit" in reason.sentence
    assert "diameter_m = 1.05 is stated, 1.03 would fit" in reason.sentence


@pytest.mark.parametrize(("share", "kinds"), [(0.2, ["gauge scale"]), (12.0, ["gauge scale", "gauge line"])])
def test_a_gauge_that_bends_is_no_scale_alone(share, kinds):
    """What shows 0.9 of inertia and torque, and 0.88 of the slope of the load, is off in the slope of its line."""
    zero = Estimate(name="gauge zero share", unit="%", value=share, std=0.2)
    assert [one.kind for one in _reasons_of((*_numbers(0.9, TUG), zero), TUG, 0.9)] == kinds


@pytest.mark.parametrize(("factor", "doubts"), [(0.9, 0), (1.12, 0), (2.0, 1)])
def test_a_coefficient_of_a_propeller_series_contradicts_nothing_within_what_it_is_known_to(factor, doubts):
    propeller = TUG.propeller.model_copy(update={"torque_coefficient_std": 0.15 * TUG.propeller.torque_coefficient})
    assert len(_reasons(factor, TUG.model_copy(update={"propeller": propeller}))) == doubts


def _of_diameter(diameter_m, *, load=1.0, inertia=1.0):
    """Reasons of a ship whose file states another diameter than its propeller has, of which all else is right."""
    propeller = TUG.propeller.model_copy(update={"diameter_m": diameter_m})
    vessel = TUG.model_copy(update={"propeller": propeller})
    rev_s = rev_s_from_rpm(vessel.working_point.engine_speed_rpm)
    torque_nm = load * vessel.working_point.shaft_torque_nm
    point = WorkingPoint(
        engine_speed_rev_s=rev_s,
        shaft_torque_nm=torque_nm,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=-5.0,
        load_std=0.0,
    )
    found = vessel.coefficient_of(torque_nm, rev_s)
    coefficient, behind = _numbers(1.0, vessel)
    numbers = (
        replace(coefficient, value=found, std=0.01 * found),
        replace(behind, value=inertia * behind.value, expected_std=1.0),
    )
    return contradictions(
        numbers, SimpleNamespace(working_point=point, levels_rpm=(), legs=(), read_hz=2000.0), vessel, CAMPAIGN
    )


@pytest.mark.parametrize("diameter_m", [0.9, 1.2, 10.5])
def test_another_diameter_is_named_first_where_torque_and_inertia_are_as_stated(diameter_m):
    (reason,) = _of_diameter(diameter_m)
    assert (reason.kind, reason.where) == ("propeller", "K_Q")
    assert reason.sentence.startswith(
        f"The torque fits a propeller of 1.05 m, and diameter_m is {diameter_m:g} m: K_Q is "
    )
    assert "while the torque and I_dn are as the vessel file says; check diameter_m" in reason.sentence


@pytest.mark.parametrize(("diameter_m", "load"), [(1.05, 1.3), (1.0, 1.0), (1.1, 1.0)])
def test_a_fouled_propeller_and_a_diameter_within_its_reach_speak_against_nothing(diameter_m, load):
    assert _of_diameter(diameter_m, load=load) == ()


@pytest.mark.parametrize(("inertia_std", "kind"), [(6.0, "gear ratio"), (0.7, "propeller")])
def test_a_coefficient_that_is_off_beside_a_torque_as_stated_is_the_ratio_or_the_diameter(inertia_std, kind):
    """A pick-up on the engine alone and 2.97 for 3.82: (2.97 / 3.82)^2 of K_Q and 2.97 / 3.82 of the inertia.

    A guess of 15 % is one of torque and K_Q alike. An inertia that is known, and is as stated, leaves the diameter.
    """
    speed = TUG.sensors.speed[0].model_copy(update={"shaft": "engine"})
    vessel = TUG.model_copy(
        update={
            "sensors": TUG.sensors.model_copy(update={"speed": (speed,)}),
            "propeller": TUG.propeller.model_copy(
                update={"torque_coefficient_std": 0.15 * TUG.propeller.torque_coefficient}
            ),
            "gearbox": TUG.gearbox.model_copy(update={"ratio": 2.97}),
        }
    )
    rev_s, torque_nm = rev_s_from_rpm(TUG.working_point.engine_speed_rpm), TUG.working_point.shaft_torque_nm
    point = WorkingPoint(
        engine_speed_rev_s=rev_s, shaft_torque_nm=torque_nm, engine_speed_std_rev_s=0.0, shaft_torque_std_nm=0.0,
        set_point_v=-5.0, load_std=0.0,
    )  # fmt: skip
    found = vessel.coefficient_of(torque_nm, rev_s)
    coefficient, inertia = _numbers(1.0, vessel)
    of_ratio = 2.97 / 3.82 if kind == "gear ratio" else 1.0
    numbers = (
        replace(coefficient, value=found, std=0.01 * found),
        replace(inertia, value=of_ratio * 17.0, std=0.2, expected_std=inertia_std),
    )
    signals = SimpleNamespace(working_point=point, levels_rpm=(), legs=(), read_hz=2000.0)
    (reason,) = contradictions(numbers, signals, vessel, CAMPAIGN)
    assert reason.kind == kind
    # the file rounds K_Q
    fitting = [float(one) for one in re.findall(r"gearbox.ratio \(2.97 is stated, (\S+) would fit\)", reason.sentence)]
    assert fitting == ([pytest.approx(3.82, rel=0.01)] if kind == "gear ratio" else [])


def test_a_torque_that_the_vessel_file_excludes_is_told_whatever_the_inertia_behind_the_gauge_is():
    """0.55 of a torque that is known to 10 % at the least is six deviations off; an inertia of a card tells nothing."""
    coefficient, inertia = _numbers(0.55, TUG)
    (reason,) = _reasons_of((coefficient, replace(inertia, value=25.0, expected_std=12.0)), TUG, 0.55)
    assert reason.kind == "gauge scale"
    assert "0.55 times that" in reason.sentence


def test_torque_and_inertia_that_are_off_alike_are_the_gauge():
    (reason,) = _of_diameter(1.05, load=0.5, inertia=0.5)
    assert reason.kind == "gauge scale"


@pytest.mark.parametrize(("found", "std", "told"), [(0.15, 0.21, True), (1.7, 0.2, True), (6.0, 0.3, False)])
def test_a_torque_without_the_inertia_behind_the_gauge_is_told(found, std, told):
    """A propeller of 17 kg m2 by the file: a tenth of it is no propeller, a third may be a file of another ship."""
    coefficient, inertia = (replace(one, value=one.expected, std=0.01 * one.expected) for one in _numbers(1.0, TUG))
    reasons = _reasons_of((coefficient, replace(inertia, value=found, std=std, expected_std=1.6)), TUG)
    assert [one.kind for one in reasons] == ["hidden inertia"] * told
    assert all("shows next to no inertia behind the gauge" in one.sentence for one in reasons)
