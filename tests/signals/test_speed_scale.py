"""One factor of the speed, or the gear's ratio in the torque: named where it is certain, and never of a healthy ship.

The truth is arithmetic: a propeller takes torque with the square of its speed, and a wrong count changes what is shown.
"""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.signals import WorkingPoint
from shaftprint.signals._contradictions import contradictions
from shaftprint.signals._load_reasons import torque_beside_file, torque_to_look_at
from shaftprint.signals._scale_reasons import scale_reasons
from shaftprint.signals.levels._speed_scale import ScaleEvidence
from shaftprint.vessel import load_vessel

VESSEL = load_vessel("stan-tug-1205")
RPM, TORQUE_NM, RATIO = 1183.8, 1725.0, 3.82
# -5.707 V ask for 1361.37 rpm in one, -5 V for the working point in the other
TESTS = {"12min": 1361.37, "short": RPM}
CAMPAIGNS = {name: load_campaign(name) for name in TESTS}
COUNTS = {0.5: "half", 2.0: "twice", 2 / 3: "two thirds of", 1.5: "one and a half times", 1 / 3: "a third of"}


def one_pick_up(**fields):
    speed = VESSEL.sensors.speed[0].model_copy(update=fields)
    return VESSEL.model_copy(update={"sensors": VESSEL.sensors.model_copy(update={"speed": (speed,)})})


def reasons_of(vessel, test, true_rpm, *, load=1.0, of_speed=1.0, of_torque=1.0, inertia_std=None, rate_hz=None):
    """Reasons of a ship that runs at a true speed under a load, shown by factors too large."""
    campaign = CAMPAIGNS[test]
    shown = WorkingPoint(
        engine_speed_rev_s=true_rpm / 60.0 * of_speed,
        shaft_torque_nm=TORQUE_NM * load * (true_rpm / RPM) ** 2 * of_torque,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=10.0,
        set_point_v=campaign.offset_v,
        load_std=0.01,
    )
    inertia = ScaleEvidence(log=np.log(of_torque / of_speed), std=inertia_std or 1.0, of_speed=-1.0, of_torque=1.0)
    return scale_reasons(
        shown,
        vessel,
        campaign,
        levels_rpm=[true_rpm * of_speed],
        of_fit={"I_dn": inertia} if inertia_std else {},
        rate_hz=rate_hz,
    )


@pytest.mark.parametrize("load", [0.8, 1.0, 1.2])
@pytest.mark.parametrize("factor", COUNTS)
@pytest.mark.parametrize("test", TESTS)
def test_a_wrong_count_is_named_with_its_factor_and_field(test, factor, load):
    # the load of another day, and an inertia that the vessel file knows to 10 %
    (reason,) = reasons_of(one_pick_up(), test, TESTS[test], load=load, of_speed=factor, inertia_std=0.1)
    assert reason.kind == "speed scale"
    assert f"it seems to be {COUNTS[factor]} the true one" in reason.sentence
    assert "pulses_per_revolution of PTM_e" in reason.sentence


def test_the_count_that_would_fit_is_told():
    (reason,) = reasons_of(one_pick_up(pulses_per_revolution=2), "12min", 1361.37, of_speed=0.5)
    assert reason.sentence.endswith("pulses_per_revolution of PTM_e: 2 is stated, 1 would fit.")
    (reason,) = reasons_of(one_pick_up(), "short", RPM, of_speed=0.5)
    assert "as on the camshaft of a four-stroke engine" in reason.sentence


@pytest.mark.parametrize("vessel", [VESSEL, one_pick_up()], ids=["three pick-ups", "one"])
def test_a_rate_that_is_half_the_loggers_is_no_count(vessel):
    """The logger takes 2000 samples a second: read as 1000, pulses come half as often."""
    (reason,) = reasons_of(vessel, "12min", 1361.37, of_speed=0.5, rate_hz=1000.0)
    assert reason.sentence.endswith("with which the speed fits: read it with --sample-rate 2000.")
    (reason,) = reasons_of(vessel, "12min", 1361.37, of_speed=0.5, rate_hz=2000.0)
    assert "--sample-rate" not in reason.sentence


def test_a_value_in_rpm_is_off_by_its_scale_and_by_no_rate():
    """A factor of 0.25 for 0.125 in the file of a bus; the logger's rate is twice that of the messages by chance."""
    vessel = one_pick_up(unit="rpm", pulses_per_revolution=1)
    (reason,) = reasons_of(vessel, "12min", 1361.37, of_speed=2.0, rate_hz=4000.0)
    assert "--sample-rate" not in reason.sentence
    assert "the scale of PTM_e (0.5 times it would fit, as with another factor in the file" in reason.sentence


def test_a_pick_up_of_the_other_shaft_is_named():
    (reason,) = reasons_of(one_pick_up(), "12min", 1361.37, of_speed=1.0 / RATIO)
    assert 'the gear ratio of 3.82: write shaft = "propeller" for PTM_e' in reason.sentence


def test_pick_ups_that_agree_are_not_miscounted_one_by_one():
    (reason,) = reasons_of(VESSEL, "12min", 1361.37, of_speed=0.5)
    assert "all of PTM_e, PTM_1, PTM_4 agree" in reason.sentence


@pytest.mark.parametrize(("factor", "fitting"), [(RATIO, "130.9"), (1.0 / RATIO, "1910")])
def test_a_torque_of_the_other_side_of_the_gear_is_a_scale_of_the_gauge(factor, fitting):
    # 500 N m for a volt on the propeller's shaft are 131 on the engine's, and the other way round 1910
    (reason,) = reasons_of(one_pick_up(), "12min", 1361.37, of_torque=factor, inertia_std=0.1)
    assert reason.kind == "gauge scale"
    assert "near the gear ratio of 3.82" in reason.sentence
    assert f": {fitting} would fit." in reason.sentence


@pytest.mark.parametrize("factor", [1.5, 2 / 3])
def test_a_lever_whose_line_asks_for_another_speed_is_no_wrong_count(factor):
    """A turned lever: the torque belongs to the speed that is shown, and the set point asks for another."""
    (reason,) = reasons_of(one_pick_up(), "12min", factor * TESTS["12min"])
    assert reason.kind == "set-point scale"
    assert reason.where == "U_setpoint"
    assert "asks for 1361 rpm, and speed and torque agree on" in reason.sentence


@pytest.mark.parametrize("factor", [0.5, 0.8, 1.25, 2.0])
def test_a_gauge_that_is_off_by_another_factor_is_no_speed(factor):
    assert reasons_of(one_pick_up(), "12min", 1361.37, of_torque=factor, inertia_std=0.1) == ()


def test_a_ship_of_another_day_is_healthy():
    """Load from 0.6 to 1.7, speed up to 30 % beside the expected, inertia within 2.5 of its standard deviations."""
    rng = np.random.default_rng(7)
    vessel, alarms = one_pick_up(), 0
    for _ in range(3000):
        load = float(np.clip(rng.lognormal(0.0, 0.2), 0.6, 1.7))
        beside = float(np.clip(rng.lognormal(0.0, 0.15), 0.75, 1.3))
        campaign = CAMPAIGNS["short"]
        shown = WorkingPoint(
            engine_speed_rev_s=RPM * beside / 60.0,
            shaft_torque_nm=TORQUE_NM * load * beside**2,
            engine_speed_std_rev_s=0.01,
            shaft_torque_std_nm=10.0,
            set_point_v=campaign.offset_v,
            load_std=0.01,
        )
        off = 0.1 * float(np.clip(rng.standard_normal(), -2.5, 2.5))
        inertia = ScaleEvidence(log=off, std=0.1, of_speed=-1.0, of_torque=1.0)
        alarms += bool(scale_reasons(shown, vessel, campaign, levels_rpm=[RPM * beside], of_fit={"I_dn": inertia}))
    # three of ten thousand: of 3000 more than four are less likely than 0.3 %
    assert alarms <= 4


@pytest.mark.parametrize("rpm", [700.0, 900.0, 1500.0, 1750.0])
def test_a_test_at_another_speed_is_healthy(rpm):
    assert reasons_of(one_pick_up(), "short", rpm) == ()


def test_a_lever_that_asks_for_half_is_no_wrong_count():
    """The campaign states twice the speed, and torque goes with the speed that is shown: the speed is right."""
    assert reasons_of(one_pick_up(), "12min", 0.55 * 1361.37) == ()


# 0.7074 V above the offset of -5.7074 V ask for 251 rpm a volt less
LOWER_RPM, LOWER_V = 1361.37 - 251.0, -4.7074


def reasons_between(*, of_lower=1.0, load=1.0, lower_rpm=LOWER_RPM):
    """Reasons of a test of two speeds whose lower one is shown by a factor, under a load that changed between them."""

    def point(rpm, volt, load=1.0, of_speed=1.0):
        return WorkingPoint(
            engine_speed_rev_s=rpm / 60.0 * of_speed,
            shaft_torque_nm=TORQUE_NM * load * (rpm / RPM) ** 2,
            engine_speed_std_rev_s=0.01,
            shaft_torque_std_nm=10.0,
            set_point_v=volt,
            load_std=0.01,
        )

    upper, lower = point(1361.37, -5.7074), point(lower_rpm, LOWER_V, load, of_lower)
    campaign = CAMPAIGNS["12min"].model_copy(
        update={"offset_v": -5.7074, "offset_rpm": 1361.37, "slope_rpm_per_v": -251}
    )
    return scale_reasons(upper, VESSEL, campaign, legs={"upper": upper, "lower": lower})


@pytest.mark.parametrize("factor", COUNTS)
@pytest.mark.parametrize("load", [0.9, 1.0, 1.1])
def test_pulses_that_are_lost_in_one_leg_are_named_with_it(factor, load):
    (reason,) = reasons_between(of_lower=factor, load=load)
    assert reason.kind == "speed scale"
    assert f"in lower it seems to be {COUNTS[factor]} the true one beside that of upper" in reason.sentence
    assert f"{LOWER_RPM * factor:.4g} rpm" in reason.sentence


@pytest.mark.parametrize("load", [0.75, 0.9, 1.0, 1.1, 1.3])
@pytest.mark.parametrize("droop", [0.95, 1.0, 1.05])
def test_legs_of_another_load_and_a_lever_that_bends_are_healthy(load, droop):
    assert reasons_between(load=load, lower_rpm=droop * LOWER_RPM) == ()


def card_of(diameter, *, share=0.15, one=False):
    """The tug's file as a card makes it of a propeller that is so many times as large: torque with its fifth power."""
    vessel, torque = (one_pick_up() if one else VESSEL), TORQUE_NM * diameter**5
    coefficient = torque / (1025.0 * (RPM / RATIO / 60.0) ** 2 * (1.05 * diameter) ** 5)
    propeller = {"diameter_m": 1.05 * diameter, "torque_coefficient": coefficient}
    return vessel.model_copy(
        update={
            "propeller": vessel.propeller.model_copy(
                update=propeller | {"torque_coefficient_std": share * coefficient}
            ),
            "working_point": vessel.working_point.model_copy(update={"shaft_torque_nm": torque}),
        }
    )


def point_at(rpm, load=1.0):
    return WorkingPoint(
        engine_speed_rev_s=rpm / 60.0,
        shaft_torque_nm=TORQUE_NM * load * (rpm / RPM) ** 2,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=10.0,
        set_point_v=-5.7,
        load_std=0.01,
    )


def test_a_propeller_of_another_diameter_is_named_with_the_one_that_fits():
    """2.4 m in place of 2.1: the file expects (8 / 7)^5 = 1.95 times the torque, at every level of the test."""
    legs = [SimpleNamespace(name=f"{rpm:g}", working_point=point_at(rpm)) for rpm in (1361.37, 900.0)]
    signals = SimpleNamespace(
        working_point=legs[0].working_point,
        levels_rpm=(1361.37, 900.0),
        legs=legs,
        read_hz=2000.0,
        calibration=SimpleNamespace(slope_rev_s_per_v=-4.18),
    )
    (told,) = contradictions((), card_of(8 / 7), signals=signals, campaign=CAMPAIGNS["12min"])
    # 1725 N m at 1183.8 rpm are 2281 at 1361.37, and ln 1.95 is 4.4 of 15 % with 1 % of the gauge
    assert "expected a torque around 4448 N m at 1361 rpm" in told
    assert "found 2281 N m, 0.51 times that, 0.51 times at 900 rpm, 4.4 standard deviations" in told
    assert "diameter_m = 1.2 is stated, 1.05 would fit" in told
    assert "500 N m for one V is stated, 974.8 would fit" in told
    # pick-ups on both shafts agree in the ratio
    assert "gear" not in told
    # a ratio that is too small by the root of the factor makes the same torque of it
    assert "gearbox.ratio (3.82 is stated, 5.33 would fit)" in torque_beside_file(
        [point_at(1361.37)], card_of(8 / 7, one=True)
    )


@pytest.mark.parametrize(("diameter", "share"), [(1.0, 0.02), (1.1, 0.15), (8 / 7, 0.4), (0.95, 0.02)])
def test_a_torque_that_the_file_does_not_know_better_is_no_contradiction(diameter, share):
    """1.1^5 is 1.61, 3.2 of 15 %; and a day changes the load by more than 2 %."""
    assert torque_beside_file([point_at(1361.37)], card_of(diameter, share=share)) == ""


@pytest.mark.parametrize(
    ("diameter", "share", "told"),
    [
        (1.1, 0.15, True),
        (1.06, 0.15, True),
        (0.92, 0.15, True),
        (1.03, 0.15, False),
        (0.97, 0.15, False),
        (8 / 7, 0.15, False),
    ],
)
def test_a_torque_of_a_size_that_no_day_makes_is_worth_a_look_however_badly_it_is_known(diameter, share, told):
    """1.06^5 is 1.34 and 1.03^5 is 1.16; of (8 / 7)^5, which is 1.95, more is said than that."""
    found = torque_to_look_at([point_at(1361.37)], card_of(diameter, share=share, one=True))
    assert bool(found) == told
    if told:
        # 500 N m for a volt fit the torque as found with 500 times what is expected over it
        assert f"{500.0 * diameter**5:.4g} would fit" in found
        assert f"gearbox.ratio (3.82 is stated, {3.82 * diameter**2.5:.3g} would fit)" in found


def test_a_torque_that_is_off_at_one_level_alone_is_no_scale():
    assert torque_beside_file([point_at(1361.37), point_at(900.0, load=1.95)], card_of(8 / 7)) == ""
    assert torque_beside_file([point_at(1361.37), point_at(900.0, load=4.0)], card_of(8 / 7)) == ""


def test_a_gear_that_would_make_the_torque_is_named():
    told = torque_beside_file([point_at(1361.37, load=1.0 / RATIO)], VESSEL)
    assert "whether it is the torque of the engine's shaft, before the gear of 3.82" in told
    told = torque_beside_file([point_at(1361.37, load=RATIO)], VESSEL)
    assert "whether the gear of 3.82 is in its scale a second time" in told
