"""What a test reached: limits that it passed are impossible; on made-up speeds and torques whose limits are known."""

import numpy as np
import pytest

from shaftprint.limits import Kind
from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._reach import Reach

EVERY_S = 0.02
TIME = np.arange(0.0, 600.0, EVERY_S)
NOTHING = {"m_max": 60.0, "m_min": -60.0, "r_s": 1e5, "r_x": 1e5, "a_0": 1.0, "tau_tc": 1.0}


def made(torque=0.0, speed=0.0, set_point=0.0):
    """A test with a flat full-load curve, all signals as deviations, the inertia upstream of the gauge nothing."""
    flat = np.zeros(TIME.size)
    return GovernorTest(
        name="made", time_s=TIME, without_jumps=flat + set_point, jumps=(), late_s=np.zeros(0), speed=flat + speed,
        shaft_torque=flat + torque, upstream_s=0.0, lost=flat > 0.0, begin_s=1.0, end_s=599.0,
        curve_speed=np.array([-1.0, 1.0]), curve_shape=np.ones(2),
    )  # fmt: skip


def noise(rng, std):
    """Noise of the engine about 2 Hz, as its combustion has it."""
    slow = np.convolve(rng.standard_normal(TIME.size + 9), np.full(10, 0.1), "valid")
    return std * slow / np.std(slow)


def limited(highest, lowest=-9.0):
    """Torque that asks for 1.9 and -0.7 for five seconds each minute, limited."""
    asked = 1.0 + 0.9 * (np.mod(TIME, 60.0) < 5.0) - 1.7 * (np.mod(TIME - 30.0, 60.0) < 5.0)
    return np.clip(asked, lowest, highest) - 1.0


def test_the_limit_that_acts_is_possible_and_a_lower_one_is_not():
    reach = Reach.of(made(torque=limited(1.5, -0.4) + noise(np.random.default_rng(1), 0.06)))
    for level, impossible in ((1.5, False), (1.25, True), (1.8, False)):
        assert reach.passes(Kind.TORQUE, NOTHING | {"m_max": level}) is impossible
    for level, impossible in ((-0.4, False), (-0.1, True), (-0.6, False)):
        assert reach.passes(Kind.MOTORING, NOTHING | {"m_min": level}) is impossible
    assert reach.highest == pytest.approx(1.5, abs=0.15)
    assert reach.lowest == pytest.approx(-0.4, abs=0.15)


@pytest.mark.slow
def test_noise_alone_passes_no_limit_at_which_a_line_stays():
    """A torque at its limit for five seconds a minute, in 50 tests of other noise: by chance in one of 150."""
    rng = np.random.default_rng(2)
    passed = [
        Reach.of(made(torque=limited(1.3) + noise(rng, rng.uniform(0.03, 0.12)))).passes(
            Kind.TORQUE, NOTHING | {"m_max": 1.3}
        )
        for _ in range(50)
    ]
    assert sum(passed) <= 2


def test_a_boost_that_is_late_gives_no_more_than_it_has():
    """Torque 0.5, then 1.6 at once for three seconds; full load 2: without boost there is 0.4 x 2 + 0.6 x 0.5."""
    torque = np.where(np.mod(TIME, 60.0) < 3.0, 1.6, 0.5) - 1.0
    reach = Reach.of(made(torque=torque + noise(np.random.default_rng(3), 0.02)))
    slow = NOTHING | {"m_max": 2.0, "tau_tc": 5.0}
    assert reach.passes(Kind.SMOKE, slow | {"a_0": 0.4})
    # 0.75 x 2 + 0.25 x 0.5 = 1.625
    assert not reach.passes(Kind.SMOKE, slow | {"a_0": 0.75})
    # a boost that follows within a twentieth of a second limits nothing
    assert not reach.passes(Kind.SMOKE, slow | {"a_0": 0.4, "tau_tc": 0.05})


def test_a_rate_that_the_speed_passed_is_impossible():
    """Steps of 0.1 within 0.4 s, 0.25 1/s, of a loop that may overshoot: not slower than 0.25 / 3."""
    speed = 0.1 * np.clip(np.mod(TIME, 60.0) / 0.4, 0.0, 1.0) * (np.mod(TIME, 120.0) < 60.0)
    reach = Reach.of(made(speed=speed + noise(np.random.default_rng(4), 1e-3)))
    assert reach.passes(Kind.RAMP, NOTHING | {"r_s": 0.04})
    assert not reach.passes(Kind.RAMP, NOTHING | {"r_s": 0.25})
    assert 0.04 < reach.set_point_rate_per_s < 0.25


def test_noise_alone_excludes_no_rate():
    rng = np.random.default_rng(5)
    rates = [Reach.of(made(speed=noise(rng, 4e-3))).set_point_rate_per_s for _ in range(20)]
    assert max(rates) < 2e-3


def test_the_offset_of_the_set_point_is_that_of_its_slow_parts():
    """A line that falls 0.2 behind in fast sines, a quarter of the time, rests 0.03 above its set point."""
    fast = np.mod(TIME, 40.0) < 10.0
    set_point = np.where(fast, 0.1 * np.sin(2.0 * np.pi * 1.3 * TIME), 0.0)
    speed = set_point + 0.03 - 0.2 * fast + noise(np.random.default_rng(6), 4e-3)
    assert made(speed=speed, set_point=set_point).settled_offset() == pytest.approx(0.03, abs=1e-3)
