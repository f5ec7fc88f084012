"""The mean load of a whole test and its standard deviation, against loads whose wander is known."""

from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.signals import WorkingPoint
from shaftprint.signals._load import mean_of_wander, with_load_of_test

TESTS = 400
STEP_S = 0.5
SIZE = 0.014


def wandering(correlation_s, duration_s, rng):
    """Return loads about 1 of many tests by the recursion of the simulated tug, shape (tests, steps)."""
    keep = np.exp(-STEP_S / correlation_s)
    white = rng.standard_normal((round(duration_s / STEP_S), TESTS))
    found = np.empty_like(white)
    state = SIZE * rng.standard_normal(TESTS)
    for place, step in enumerate(white):
        state = keep * state + SIZE * np.sqrt(1.0 - keep**2) * step
        found[place] = state
    return 1.0 + found.T


@pytest.fixture(scope="module")
def windows():
    """Sines of the short campaign: ten windows of 100 down to 21 s in ten minutes."""
    sines = load_campaign("short").sines
    return np.array([s.settled_s for s in sines]), np.array([s.window_stop_s for s in sines])


@pytest.mark.parametrize("correlation_s", [20.0, 64.0, 120.0])
def test_stated_deviation_holds_the_truth_in_nineteen_of_twenty_tests(windows, correlation_s):
    """The tug's own wander has 64 s. Of 400 tests 380 are expected within 1.96 standard deviations, 371 or fewer in one
    of forty runs."""
    begins, ends = windows
    loads = wandering(correlation_s, float(ends.max()) + 1.0, np.random.default_rng(3))
    found = []
    for load in loads:
        values = [load[round(b / STEP_S) : round(e / STEP_S)].mean() for b, e in zip(begins, ends, strict=True)]
        found.append(mean_of_wander(np.array(values), begins, ends))
    mean, std = np.array(found).T
    assert np.count_nonzero(np.abs(mean - 1.0) < 1.96 * std) > 371
    # neither far too wide: at most double what the means scatter
    assert np.median(std) < 2.0 * np.std(mean)


def test_mean_goes_with_what_is_measured_and_not_with_its_unit(windows):
    begins, ends = windows
    values = 1.0 + 0.01 * np.random.default_rng(5).standard_normal(begins.size)
    mean, std = mean_of_wander(values, begins, ends)
    larger = mean_of_wander(1725.0 * values, begins, ends)
    assert larger == pytest.approx((1725.0 * mean, 1725.0 * std), rel=1e-9)
    later = mean_of_wander(values, begins + 1e4, ends + 1e4)
    assert later == pytest.approx((mean, std), rel=1e-6)


def test_a_load_that_stands_still_has_no_wander(windows):
    begins, ends = windows
    mean, std = mean_of_wander(np.full(begins.size, 1.03), begins, ends)
    assert mean == pytest.approx(1.03)
    assert std == pytest.approx(0.0, abs=1e-12)


POINT = WorkingPoint(
    engine_speed_rev_s=20.0,
    shaft_torque_nm=1600.0,
    engine_speed_std_rev_s=0.01,
    shaft_torque_std_nm=8.0,
    set_point_v=-5.0,
)


def signals_of(campaign, factor):
    """Speed that swings by a tenth about 20 rev/s, torque ``4 factor n^2``, at 20 Hz."""
    time_s = np.arange(round(campaign.duration_s * 20.0)) / 20.0
    speed = np.full(time_s.size, 20.0)
    for sine in campaign.sines:
        inside = (time_s >= sine.start_s) & (time_s < sine.stop_s)
        speed[inside] += 2.0 * np.sin(2.0 * np.pi * sine.frequency_hz * (time_s[inside] - sine.start_s))
    return speed, 4.0 * factor * speed**2


def test_load_of_a_quadratic_propeller_is_its_factor_however_the_speed_swings():
    campaign = load_campaign("short")
    speed, torque = signals_of(campaign, 1.05)
    found = with_load_of_test(POINT, (), campaign, speed_rev_s=speed, torque_nm=torque, rate_hz=20.0, start_s=0.0)
    assert found.load == pytest.approx(1.05, rel=1e-9)
    assert found.load_std < 1e-9


def test_too_few_windows_leave_the_working_point_as_it_is():
    campaign = load_campaign("short")
    speed, torque = signals_of(campaign, 1.05)
    three = SimpleNamespace(excitations=campaign.excitations[:4])  # staircase and three sines
    found = with_load_of_test(POINT, (), three, speed_rev_s=speed, torque_nm=torque, rate_hz=20.0, start_s=0.0)
    assert found == POINT
    assert (found.load, found.load_std) == (1.0, None)


def test_windows_before_the_recording_are_left_out():
    """A logger that was started 250 s late has missed the start of the first sine, whose window begins at 242 s."""
    campaign = load_campaign("short")
    speed, torque = signals_of(campaign, 1.05)
    torque[: round(342.0 * 20.0)] *= 2.0
    late = round(250.0 * 20.0)
    found = with_load_of_test(
        POINT, (), campaign, speed_rev_s=speed[late:], torque_nm=torque[late:], rate_hz=20.0, start_s=250.0
    )
    assert found.load == pytest.approx(1.05, rel=1e-9)
    assert found.load_std < 1e-9


def test_a_quiet_stretch_at_the_end_of_the_recording_counts():
    """Four windows, the last of which ends where the recording does, but for the rounding of its end."""
    speed = np.full(2000, 20.0)
    bounds = np.linspace(0.0, np.nextafter(100.0, 101.0), 5)
    quiet = tuple(SimpleNamespace(start_s=begin, stop_s=end) for begin, end in pairwise(bounds))
    campaign = SimpleNamespace(excitations=())
    found = with_load_of_test(
        POINT, quiet, campaign, speed_rev_s=speed, torque_nm=4.2 * speed**2, rate_hz=20.0, start_s=0.0
    )
    assert found.load == pytest.approx(1.05, rel=1e-9)
