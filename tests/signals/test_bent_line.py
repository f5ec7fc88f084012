"""The line of the set point through levels of a lever that bends."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign, Staircase
from shaftprint.signals.levels._calibrate import calibrate_through_wander
from shaftprint.signals.levels._steady import SteadyStretch

RATE_HZ, LEVEL_S = 5.0, 60.0
SLOPE, SPEED = -4.2, 20.0  # rev/s per V at -5 V, and rev/s there


def levels(volts, *, bend_per_v, rng=None):
    """Return campaign, stretches, set point and speed of a staircase about -5 V on a lever that bends."""
    count = round(LEVEL_S * RATE_HZ)
    set_point = np.repeat(volts, count).astype(float)
    about = set_point + 5.0
    # the slope is SLOPE (1 + bend_per_v about)
    speed = SPEED + SLOPE * (about + 0.5 * bend_per_v * about**2)
    if rng is not None:
        wander = np.convolve(rng.standard_normal(speed.size), np.ones(50) / 50.0, "same")
        # the load goes with the square of the speed, and what it does to the speed with it
        speed = speed + 0.003 * SPEED * (speed / SPEED) ** 2 * wander
    stretches = tuple(
        SteadyStretch(
            start_s=k * LEVEL_S, stop_s=(k + 1) * LEVEL_S, set_point_v=volt,
            speed_rev_s=float(speed[k * count : (k + 1) * count].mean()), speed_std_rev_s=0.01, torque_nm=1.0,
            torque_std_nm=0.0,
        )
        for k, volt in enumerate(volts)
    )  # fmt: skip
    staircase = Staircase(name="St", levels_v=volts, dwell_s=LEVEL_S, start_s=0.0)
    duration_s = LEVEL_S * len(volts)
    campaign = Campaign(name="levels", duration_s=duration_s, offset_v=-5.0, staircases=(staircase,))
    return campaign, stretches, set_point, speed


def line(volts, *, bend_per_v, bend_std, rng=None):
    campaign, stretches, set_point, speed = levels(volts, bend_per_v=bend_per_v, rng=rng)
    found, *_ = calibrate_through_wander(
        stretches, campaign, about_v=-5.0, set_point_v=set_point, speed_rev_s=speed, rate_hz=RATE_HZ, start_s=0.0,
        channel="U", bend_std=bend_std,
    )  # fmt: skip
    return found


UNEVEN = (-5.0, -6.0, -5.0, -4.0, -3.0, -2.0)


def test_slope_is_that_at_the_working_voltage_and_the_bend_is_found():
    found = line(UNEVEN, bend_per_v=0.004, bend_std=0.015)
    # a straight line through these levels has a mean voltage 0.83 V higher: 0.3 % more slope and more
    assert found.slope_rev_s_per_v == pytest.approx(SLOPE, rel=2e-4)
    # twice the speed is SPEED / SLOPE volts away
    assert found.bend == pytest.approx(0.004 * SPEED / SLOPE, rel=0.02)
    assert found.slope_rev_s_per_v * -5.0 + found.intercept_rev_s == pytest.approx(SPEED, rel=1e-4)


def test_two_levels_do_not_show_a_bend_and_the_slope_says_so():
    found = line((-5.0, -5.0, -3.0, -3.0), bend_per_v=0.004, bend_std=0.02)
    # the secant of 2 V: the slope 1 V away, 0.4 % too large
    assert found.slope_rev_s_per_v == pytest.approx(SLOPE * 1.004, rel=1e-4)
    assert found.bend == 0.0
    assert found.bend_std == pytest.approx(0.02)
    # what a bend of 0.02 makes at 1 V: 0.02 * 4.2 / 20 a volt
    assert np.sqrt(found.covariance[0, 0]) / abs(SLOPE) == pytest.approx(0.0042, rel=0.05)


def test_stated_deviations_hold_the_drawn_truth():
    rng = np.random.default_rng(3)
    apart = []
    for _ in range(40):
        bend = rng.normal(0.0, 0.015)
        found = line(UNEVEN, bend_per_v=bend * SLOPE / SPEED, bend_std=0.015, rng=rng)
        apart.append([
            (found.slope_rev_s_per_v - SLOPE) / np.sqrt(found.covariance[0, 0]), (found.bend - bend) / found.bend_std
        ])  # fmt: skip
    rms = np.sqrt(np.mean(np.square(apart), axis=0))
    assert np.all(rms < 1.1)
    assert np.all(rms > 0.4)
