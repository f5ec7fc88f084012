"""A set point held between messages: what the delays of the jumps tell of the cycle."""

import numpy as np
import pytest

from shaftprint.limits.prediction._governor_test import GovernorTest, sum_of_jumps
from shaftprint.limits.prediction._held_set_point import explained
from shaftprint.time_domain.nonlinear._drive import Jump

STD_S, MEAN_STD_S = np.full(8, 2e-3), 4e-3


def drawn(rng, cycle_s):
    """Delays of eight jumps behind the sines: each waits for a message, and is known to 2 ms."""
    common = MEAN_STD_S * rng.standard_normal()
    return common + cycle_s * rng.uniform(-0.5, 0.5, STD_S.size) + STD_S * rng.standard_normal(STD_S.size)


@pytest.mark.long
def test_the_cycle_is_in_its_interval_as_often_as_stated():
    rng = np.random.default_rng(2)
    inside = 0
    for _ in range(200):
        cycle_s = rng.uniform(0.02, 0.1)
        messages = explained(drawn(rng, cycle_s), STD_S, MEAN_STD_S)
        inside += messages.quantile(0.025) <= cycle_s <= messages.quantile(0.975)
    # 95 % of 200, and three standard deviations of that count
    assert 180 <= inside <= 200


@pytest.mark.slow
def test_jumps_of_one_delay_show_no_cycle():
    rng = np.random.default_rng(3)
    gains = [explained(drawn(rng, 0.0), STD_S, MEAN_STD_S).gain for _ in range(200)]
    # half a chi square of one degree of freedom: above 10 once in 1300
    assert np.max(gains) < 12.0


def test_a_jump_that_is_not_seen_tells_nothing():
    rng = np.random.default_rng(4)
    late = drawn(rng, 0.05)
    known = explained(late, STD_S, MEAN_STD_S)
    more = explained(np.append(late, 9.0), np.append(STD_S, np.inf), MEAN_STD_S)
    np.testing.assert_allclose(more.density, known.density)
    assert known.excluded_beyond(15.0) > known.quantile(0.975)


@pytest.mark.parametrize("late_s", [0.0, 0.0031, -0.0173])
@pytest.mark.parametrize("begin_s", [0.0, 0.0044])
def test_a_late_jump_keeps_its_area_on_any_grid(late_s, begin_s):
    time = begin_s + np.arange(0.0, 4.0, 0.01)
    jump = Jump(inside=np.ones(1, dtype=bool), at_s=2.0013, before=0.0, after=0.2)
    passed = sum_of_jumps(time, [jump], np.array([late_s]))
    # samples stand for half a step on either side
    end_s = time[-1] + 0.005
    assert np.sum(passed) * 0.01 == pytest.approx(0.2 * (end_s - 2.0013 - late_s), abs=1e-9)


def test_a_held_sine_is_smaller():
    """``sin(pi f T) / (pi f T)`` of its amplitude at 3 Hz and 80 ms: 0.908; the half cycle is in ``t_sp``."""
    time = np.arange(0.0, 20.0, 0.005)
    test = governor_test_of(time, np.sin(2.0 * np.pi * 3.0 * time))
    held = test.held(0.08, np.zeros(0)).without_jumps
    inside = (time > 1.0) & (time < 19.0)
    turn = np.exp(-2j * np.pi * 3.0 * time[inside])
    ratio = np.sum(turn * held[inside]) / np.sum(turn * test.without_jumps[inside])
    assert ratio == pytest.approx(0.9079, abs=1e-3)


def governor_test_of(time, set_point):
    nothing = np.zeros(time.size)
    return GovernorTest(
        name="sine", time_s=time, without_jumps=set_point, jumps=(), late_s=np.zeros(0), speed=nothing,
        shaft_torque=nothing, upstream_s=1.0, lost=nothing > 0.0, begin_s=0.0, end_s=20.0,
        curve_speed=np.array([-1.0, 1.0]), curve_shape=np.ones(2),
    )  # fmt: skip
