"""What is shown of a plan, held against laws: the sum of all worths, the root of time, limits that are kept."""

from datetime import UTC, datetime

import numpy as np
import pytest
import scipy.stats

from shaftprint.design import PlannedTest, SetPointLine
from shaftprint.design.views._abort_card import abort_card
from shaftprint.design.views._line_worth import line_worths
from shaftprint.design.views._other_lengths import length_curve
from shaftprint.design.views._planned_motion import planned_motion


def test_the_lines_together_are_worth_the_number_of_parameters(plan):
    """trace(V sum J) = trace(identity): Fedorov's theorem, with nothing known besides the test."""
    total = 0.0
    for worth in line_worths(plan):
        leg = worth.leg
        each = np.interp(np.log(leg.frequency_hz), np.log(worth.frequency_hz), worth.per_second)
        total += float(np.sum(each * leg.amplitudes_rpm**2) * leg.window_s)
    free = len(plan.ship.structure.free)
    assert total == pytest.approx(free, rel=0.05)


def test_four_times_the_periods_halve_the_deviations(plan):
    curve = length_curve(plan, (1.0, 4.0))
    for ratio in curve.relative_std.values():
        assert ratio[0] == pytest.approx(2.0 * ratio[1], rel=1e-6)
    assert curve.duration_s[0] == pytest.approx(plan.duration_s)


def test_motion_keeps_the_limits_and_reaches_the_peaks(plan):
    for motion, peaks in zip(planned_motion(plan), plan.peaks, strict=True):
        assert np.abs(motion.set_point_rpm - motion.leg.level_rpm).max() == pytest.approx(peaks.set_point_rpm, rel=0.02)
        assert motion.brake_torque_nm.min() == pytest.approx(peaks.brake_torque_nm[0], rel=0.05)
        assert motion.brake_torque_nm.max() == pytest.approx(peaks.brake_torque_nm[1], rel=0.05)
        assert np.all(motion.brake_torque_nm < motion.full_load_nm)
        assert np.all(motion.brake_torque_nm > motion.motoring_nm)
        # noise on top takes the torque beyond its limits for a short part of the time alone
        over = (motion.brake_torque_nm - motion.full_load_nm) / motion.torque_std_nm
        below = (motion.motoring_nm - motion.brake_torque_nm) / motion.torque_std_nm
        assert max(scipy.stats.norm.cdf(one).mean() for one in (over, below)) < 4e-4
        # mean motion is none: the leg moves about its level
        assert motion.speed_rpm[:-1].mean() == pytest.approx(motion.leg.level_rpm, rel=1e-9)


def test_the_card_for_the_bridge_keeps_within_the_limits_of_the_ship(plan, limits):
    test = PlannedTest(
        name="two speeds",
        vessel="tug",
        plan=plan,
        line=SetPointLine(slope_rpm_per_v=-251.0, offset_v=-5.0),
        created=datetime(2026, 11, 23, tzinfo=UTC),
        noise_source="assumed",
    )
    card = abort_card(test)
    assert limits.lowest_speed_rpm - 1e-6 <= card.speed_rpm[0] < card.speed_rpm[1] <= limits.highest_speed_rpm + 1e-6
    highest = max(torque for _, torque in limits.full_load)
    assert min(peaks.brake_torque_nm[0] for peaks in plan.peaks) > -450.0
    assert highest > max(peaks.brake_torque_nm[1] for peaks in plan.peaks)
    assert card.brake_torque_nm[1] > max(peaks.brake_torque_nm[1] for peaks in plan.peaks)
    # full load keeps the leg from being stronger: with noise it would be passed, and no engine gives more than it has
    assert card.brake_torque_nm[1] <= highest
    assert card.brake_torque_nm[0] >= -450.0
    # 1 V about both levels, 1.15 and 0.70 of 1183.8 rpm: 828.7 - 251 and 1361.4 + 251 rpm
    assert card.set_point_rpm[0] >= 577.6
    assert card.set_point_rpm[1] <= 1612.4
    assert card.duration_s == test.campaign.duration_s
