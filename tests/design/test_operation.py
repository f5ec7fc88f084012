"""What a test asks of ship and engine, and whether it leaves their limits, by hand and beside the simulated tug."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.design import expected_operation, limit_uses, limits_from_vessel, recorded_operation
from shaftprint.design.operation._limit_use import limit_cautions, limit_reasons, ratio_reasons, stated_limits
from shaftprint.design.operation._operation import Operation
from shaftprint.errors import DesignError
from shaftprint.signals import WorkingPoint
from shaftprint.tug import Tug, like_stan_tug_1205, normalised_truth
from shaftprint.vessel import load_vessel

N_0, TORQUE = 1183.8, 1725.0 / (3.82 * 0.97)
SLOPE = -250.0


@pytest.fixture(scope="module")
def ship():
    return load_vessel("stan-tug-1205")


def multisine(period_s, amplitude_v, *, level_v=-5.0, periods=3, **campaign):
    """One line that rises from its middle; two periods and a settled start."""
    leg = {
        "name": "M1", "level_v": level_v, "period_s": period_s, "harmonics": [1], "amplitudes_v": [amplitude_v],
        "phases_rad": [np.pi], "start_s": 20.0, "settled_s": 20.0 + period_s, "stop_s": 20.0 + periods * period_s,
    }  # fmt: skip
    asked = {
        "name": "test",
        "duration_s": 60.0 + periods * period_s,
        "offset_v": -5.0,
        "ramp_s": 10.0,
        "multisines": [leg],
    }
    return Campaign.model_validate(asked | campaign)


def uses_of(operation, limits, excitation="M1"):
    return {use.limit: use for use in limit_uses(operation, limits) if use.excitation == excitation}


def test_slow_multisine_follows_the_propeller_law(ship, truth):
    # 0.5 V about the working point: 125 rpm up and down, and the torque with the square of the speed
    operation = expected_operation(multisine(400.0, 0.5), ship, truth, slope_rpm_per_v=SLOPE)
    uses = uses_of(operation, stated_limits(ship))
    assert uses["highest speed"].value == pytest.approx(N_0 + 125.0, abs=1.0)
    assert uses["lowest speed"].value == pytest.approx(N_0 - 125.0, abs=1.0)
    # crests a quarter and three quarters of a period after a whole one
    assert (uses["highest speed"].time_s - 20.0) % 400.0 == pytest.approx(100.0, abs=2.0)
    assert uses["full load"].value == pytest.approx(TORQUE * (1.0 + 125.0 / N_0) ** 2, rel=0.01)
    assert uses["full load"].value == pytest.approx(uses["full rack"].value, rel=0.002)
    # full load is 1325 N m from 1227.6 to 1472.4 rpm
    assert uses["full load"].allowed == pytest.approx(1325.0)
    assert not any(use.is_beyond for use in uses.values())


def test_torque_of_a_fast_line_is_that_of_the_closed_loop(ship, truth):
    # 1.25 Hz, 0.02 V: small enough to be linear
    s = 2j * np.pi * 1.25
    lag = 10.3**2 / (s**2 + 2.0 * 0.47 * 10.3 * s + 10.3**2)
    governor = 5.7 + 4.27 / s
    loop = governor * np.exp(-0.0703 * s) * lag / (1.336 * s + 2.0)
    speed = loop / (1.0 + loop)
    share = 0.02 * 250.0 / N_0
    brake = abs((1.336 * s + 2.0) * speed)
    asked = abs(governor * (1.0 - speed))
    operation = expected_operation(multisine(0.8, 0.02, periods=20), ship, truth, slope_rpm_per_v=SLOPE)
    settled = (operation.time_s > 30.0) & (operation.time_s < 36.0)
    crest = np.max(operation.brake_torque_nm[settled])
    assert crest / TORQUE - 1.0 == pytest.approx(brake * share, rel=0.02)
    demand = np.max(operation.torque_demand_nm[settled])
    assert demand / TORQUE - 1.0 == pytest.approx(asked * share, rel=0.02)
    # the set point changes by A omega at most
    assert operation.rate_rpm_per_s[settled].max() == pytest.approx(5.0 * abs(s), rel=0.01)


def test_offset_at_another_speed_than_the_working_point(ship, truth):
    operation = expected_operation(multisine(50.0, 0.1, offset_rpm=900.0), ship, truth, slope_rpm_per_v=SLOPE)
    assert operation.speed_rpm[0] == pytest.approx(900.0)
    assert operation.brake_torque_nm[0] == pytest.approx(TORQUE * (900.0 / N_0) ** 2)


def test_says_which_excitation_leaves_which_limit(ship):
    # M1 runs from 20 to 320 s
    time = np.arange(0.0, 400.0, 0.1)
    inside = (time > 100.0) & (time < 101.05)
    operation = Operation(
        campaign=multisine(100.0, 0.1),
        time_s=time,
        set_point_rpm=np.where(time < 330.0, 1000.0, 1000.0 + 40.0 * (time - 330.0)),
        speed_rpm=np.where(inside, 590.0, 1000.0),
        brake_torque_nm=np.where(inside, -250.0, 300.0),
    )
    limits = replace(stated_limits(ship), demand_rate_limit_rpm_per_s=30.0)
    uses = uses_of(operation, limits)
    slow = uses["lowest speed"]
    assert (slow.value, slow.allowed, slow.is_beyond) == (590.0, 600.0, True)
    assert slow.time_s == pytest.approx(100.1)
    assert slow.beyond_s == pytest.approx(1.0)
    assert slow.sentence == ("M1 leaves the limit lowest speed at 100.1 s: 590 rpm, allowed 600 rpm; 1.0 s in all.")
    # 150 + 150 n / 1183.8
    assert uses["motoring torque"].allowed == pytest.approx(-(150.0 + 150.0 * 590.0 / N_0))
    assert uses["motoring torque"].is_beyond
    assert not uses["full load"].is_beyond
    after = uses_of(operation, limits, "after M1")
    assert after["rate of the set point"].value == pytest.approx(40.0)
    assert after["rate of the set point"].is_beyond
    before = uses_of(operation, limits, "before the first excitation")
    assert not any(use.is_beyond for use in before.values())


def with_peak(beyond_s, peak_nm, *, rpm):
    """Return a leg of 300 s at one speed, in which the brake torque is high for some time."""
    campaign = multisine(100.0, 0.1, periods=3)
    (leg,) = campaign.legs
    time = np.arange(0.0, campaign.duration_s, 0.1)
    torque = np.where((time >= leg.start_s + 10.0) & (time < leg.start_s + 10.0 + beyond_s), peak_nm, 100.0)
    speed = np.full(time.size, rpm)
    return Operation(campaign=campaign, time_s=time, set_point_rpm=speed, speed_rpm=speed, brake_torque_nm=torque)


@pytest.mark.parametrize(("beyond_s", "told"), [(0.0, 0), (10.0, 0), (14.0, 1)])
def test_an_engine_at_full_load_for_more_than_a_twentieth_of_a_leg_is_told(ship, beyond_s, told):
    """M1 runs for 300 s; 5000 N m are more than the tug's engine gives at 1000 rpm."""
    operation = with_peak(beyond_s, 5000.0, rpm=1000.0)
    (leg,) = operation.campaign.legs
    uses = limit_uses(operation, stated_limits(ship))
    reasons = limit_reasons(uses, ["M1"])
    assert len(reasons) == told
    for reason in reasons:
        assert reason.kind == "engine limit"
        assert f"M1 beyond full load for 14 s of {leg.stop_s - leg.start_s:.0f} s, with 5000 of " in reason.sentence
    assert limit_reasons(uses, ["M2"]) == ()


@pytest.mark.parametrize(
    ("load", "beyond_s", "shaft", "told"),
    [
        (0.605, 14.0, "engine", True),
        (1.0, 14.0, "engine", False),
        (0.605, 5.0, "engine", False),
        (0.605, 14.0, "propeller", False),
    ],
)
def test_less_torque_at_the_propeller_and_more_at_the_engine_are_a_ratio_that_is_too_small(
    ship, load, beyond_s, shaft, told
):
    """(3.5 / 4.5)^2 is 0.605; 1500 N m are 1167 with the ratio that fits, and the tug's engine gives 1325."""
    propeller = ship.propeller.model_copy(update={"torque_coefficient_std": 0.15 * ship.propeller.torque_coefficient})
    speed = ship.sensors.speed[0].model_copy(update={"shaft": shaft})
    vessel = ship.model_copy(
        update={"sensors": ship.sensors.model_copy(update={"speed": (speed,)}), "propeller": propeller}
    )
    uses = limit_uses(with_peak(beyond_s, 1500.0, rpm=1300.0), stated_limits(vessel))
    point = WorkingPoint(
        engine_speed_rev_s=N_0 / 60.0, shaft_torque_nm=1725.0 * load, engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0, set_point_v=-5.0, load_std=0.0,
    )  # fmt: skip
    reasons = ratio_reasons(uses, ["M1"], point, vessel)
    assert [one.kind for one in reasons] == ["gear ratio"] * told
    # 3.82 times 4.5 / 3.5
    assert all("gearbox.ratio (3.82 is stated, 4.91 would fit)" in one.sentence for one in reasons)
    assert len(limit_cautions(uses, ["M1"])) == (beyond_s == 14.0)


def test_what_is_not_stated_is_not_held_against_a_test(ship, truth):
    operation = expected_operation(multisine(50.0, 0.1), ship, truth, slope_rpm_per_v=SLOPE)
    without = replace(stated_limits(ship), motoring=((0.0, 0.0),), gauge=None)
    assert set(uses_of(operation, without)) == {"highest speed", "lowest speed", "full load", "full rack"}


def test_barred_range_may_be_crossed_but_not_kept(ship):
    time = np.arange(0.0, 400.0, 0.1)
    limits = replace(stated_limits(ship), barred_rpm=((900.0, 960.0),))

    def use(seconds):
        speed = np.where((time >= 100.0) & (time < 100.0 + seconds), 930.0, 1000.0)
        quiet = Operation(
            campaign=multisine(100.0, 0.1), time_s=time, set_point_rpm=speed, speed_rpm=speed, brake_torque_nm=speed
        )
        return uses_of(quiet, limits)["barred 900 to 960 rpm"]

    assert not use(1.5).is_beyond
    assert use(3.0).beyond_s == pytest.approx(3.0)


def test_recorded_torque_is_that_of_the_simulated_engine(ship):
    campaign = multisine(2.0, 0.4, level_v=-5.5, periods=10)
    signals = simulate_signals(ship, campaign, tug=Tug())
    recorded = SimpleNamespace(
        rate_hz=200.0,
        start_s=0.0,
        set_point_rev_s=signals.set_point_rev_s,
        engine_speed=SimpleNamespace(values=signals.engine_speed_rev_s),
        shaft_torque_nm=signals.shaft_torque_nm,
        coverage=SimpleNamespace(lost=lambda time: np.zeros(time.shape, dtype=bool)),
    )
    operation = recorded_operation(recorded, campaign, ship)
    truth = np.interp(operation.time_s, signals.time_s, signals.brake_torque_nm)
    swing = np.ptp(truth[operation.time_s > 22.0])
    assert swing > 300.0
    # a mean over 0.1 s takes 0.4 % of a swing of 0.5 Hz
    assert np.max(np.abs(operation.brake_torque_nm - truth)) < 0.015 * swing
    assert operation.torque_demand_nm is None


def test_unstable_values_are_refused(ship, truth):
    with pytest.raises(DesignError, match="the loop is unstable with the assumed values"):
        expected_operation(multisine(50.0, 0.1), ship, truth | {"K_p": 100.0}, slope_rpm_per_v=SLOPE)


@pytest.mark.parametrize("name", ["12min", "5min"])
def test_shipped_tests_keep_the_limits_of_the_shipped_tug(ship, truth, name):
    # with room for four standard deviations of the noise, as they were designed: 5 rpm and 40 N m at least
    operation = expected_operation(load_campaign(name), ship, truth, slope_rpm_per_v=-251.2)
    uses = limit_uses(operation, stated_limits(ship))
    assert {use.limit for use in uses} >= {"lowest speed", "full load", "motoring torque", "full rack", "zero fuel"}
    for use in uses:
        assert abs(use.value - use.allowed) > {"rpm": 5.0, "N m": 40.0}[use.unit], use
        assert not use.is_beyond, use
    deviation = operation.set_point_rpm - operation.campaign.offset_rpm
    assert limits_from_vessel(ship, set_point_rpm=251.0).set_point_rpm >= np.max(
        np.abs(deviation[operation.stretches["M1"]])
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "campaign"),
    [
        ("stan-tug-1205-underway", "dither"),
        ("nifs-research-vessel", "pitch"),
        ("nifs-research-vessel-combinator", "combinator"),
    ],
)
def test_underway_and_with_a_moved_pitch_it_is_what_the_simulated_ship_does(name, campaign):
    vessel, asked = load_vessel(name), load_campaign(campaign)
    tug = like_stan_tug_1205(vessel, offset_v=asked.offset_v)
    slope = tug.set_point_slope_rpm_per_v
    expected = expected_operation(asked, vessel, normalised_truth(tug, vessel), slope_rpm_per_v=slope)
    # without noise steps of 2.5 ms are as good as finer ones
    sailed = simulate_signals(vessel, asked, tug=tug, longest_step_s=2.5e-3)
    for ours, theirs in (
        (expected.speed_rpm, 60.0 * sailed.engine_speed_rev_s),
        (expected.shaft_torque_nm, sailed.shaft_torque_nm),
        (expected.brake_torque_nm, sailed.brake_torque_nm),
    ):
        swing = np.ptp(theirs)
        assert np.ptp(ours) == pytest.approx(swing, rel=0.03)
        assert np.interp(sailed.time_s, expected.time_s, ours) == pytest.approx(theirs, abs=0.06 * swing)
