"""A set point whose rate is limited, against laws of triangles and ramps and a plain loop of microseconds."""

import numpy as np
import pytest

from shaftprint.limits.prediction._governor_test import GovernorTest
from shaftprint.limits.prediction._set_point import rate_limited
from shaftprint.time_domain.nonlinear._drive import Jump

EVERY_S = 0.005


def test_a_fast_sine_becomes_a_triangle():
    """Its amplitude is ``r / 4 f``: up at the rate for a half period, down for the other."""
    time = np.arange(0.0, 20.0, EVERY_S)
    rate, frequency = 0.8, 3.3
    limited = rate_limited(time, np.sin(2.0 * np.pi * frequency * time), rate)[time > 5.0]
    triangle = limited - np.mean(limited)
    # the root mean square of a triangle is its amplitude over the square root of three
    assert np.sqrt(3.0 * np.mean(triangle**2)) == pytest.approx(rate / (4.0 * frequency), rel=2e-3)


def test_a_ramp_begins_where_the_set_point_jumps():
    """The jump lies 1.7 ms after a sample: no share of a sample is lost or won."""
    time = np.sort(np.append(np.arange(0.0, 2.0, EVERY_S), [1.0017, 1.0017]))
    value = (time > 1.0017) * 0.25
    value[np.flatnonzero(time == 1.0017)[1]] = 0.25
    limited = rate_limited(time, value, 0.8)
    np.testing.assert_allclose(limited, np.clip(0.8 * (time - 1.0017), 0.0, 0.25), atol=1e-12)


def test_a_slow_set_point_passes():
    time = np.arange(0.0, 30.0, EVERY_S)
    value = 0.1 * np.sin(2.0 * np.pi * 0.2 * time)
    np.testing.assert_allclose(rate_limited(time, value, 0.2), value, atol=1e-15)


def test_any_polyline_is_followed_as_a_plain_loop_of_microseconds_follows_it():
    rng = np.random.default_rng(7)
    corners, step_s = np.arange(60) * 0.01, 1e-6
    value = np.cumsum(rng.normal(0.0, 0.02, corners.size))
    fine = np.interp(np.arange(round(0.59 / step_s) + 1) * step_s, corners, value)
    at, followed = fine[0], np.empty(fine.size)
    for k, asked in enumerate(fine.tolist()):
        at += min(max(asked - at, -0.9 * step_s), 0.9 * step_s)
        followed[k] = at
    exact = rate_limited(corners, value, 0.9)
    assert np.ptp(exact - value) > 0.02
    np.testing.assert_allclose(exact, followed[:: round(0.01 / step_s)], atol=3e-6)


@pytest.mark.parametrize("drive_hz", [100.0, 200.0])
@pytest.mark.parametrize("late_s", [0.0, 0.0123])
def test_the_ramp_of_a_record_is_the_same_on_every_grid(drive_hz, late_s):
    """A jump of 0.2 at 12.3456 s, 0.5 1/s: half way after 0.2 s."""
    time = np.arange(0.0, 30.0, EVERY_S)
    nothing = np.zeros(time.size)
    test = GovernorTest(
        name="jump", time_s=time, without_jumps=nothing, speed=nothing, shaft_torque=nothing, upstream_s=1.0,
        jumps=(Jump(inside=np.ones(1, dtype=bool), at_s=12.3456, before=0.0, after=0.2),), late_s=np.array([late_s]),
        lost=nothing > 0.0, begin_s=2.0, end_s=28.0, curve_speed=np.array([-1.0, 1.0]), curve_shape=np.ones(2),
    )  # fmt: skip
    record = test.record(drive_hz=drive_hz)
    limited = record.set_point_at(0.5)
    drive_s = record.start_s + (np.arange(limited.size) - record.margin) / drive_hz
    rising = (limited > 0.02) & (limited < 0.18)
    assert np.interp(0.1, limited[rising], drive_s[rising]) == pytest.approx(12.3456 + late_s + 0.2, abs=1e-9)
