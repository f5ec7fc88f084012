"""A rack in messages of a bus, in a leg of known content: all lines at once, at the times of the messages."""

from dataclasses import replace

import numpy as np
import pytest
import scipy
from tests.made_signals import with_channels
from tests.measured_outputs import measured
from tests.spectra.legs_by_speed import estimate_legs
from tests.spectra.test_legs import CAMPAIGN, HARMONICS, PERIOD_S, made_leg, speed_over_set_point

from shaftprint.signals import MessageSignal

GAIN, MEAN = 3.0, 0.42


def with_rack(signals, rng, *, step=0.0, late_s=0.0, noise=0.0, first_s=0.0, lost=0.01):
    """``X = 0.42 (1 + 3 (u - n))`` every 20 ms with 15 % of jitter; late messages hold values of their cycle."""
    grid_s = np.arange(signals.samples) / signals.rate_hz
    moved, speed = (signals.channels[name] for name in ("n_set", "n_e"))
    error = scipy.interpolate.CubicSpline(grid_s, (moved.values - speed.values) / moved.reference)
    due_s = np.arange(first_s + 0.007, grid_s[-1] - 0.1, 0.02)
    jitter_s = 0.003 * np.sqrt(3.0) * rng.uniform(-1.0, 1.0, due_s.size)
    kept = rng.random(due_s.size) >= lost
    time_s, taken_s = (due_s + jitter_s)[kept], (due_s + (0.0 if late_s else jitter_s))[kept]
    values = MEAN * (1.0 + GAIN * error(taken_s)) + noise * rng.standard_normal(taken_s.size)
    if step:
        values = step * np.rint(values / step)
    rack = MessageSignal(
        name="X", channel="X", values=values, reference=0.5, rate_hz=50.0, start_s=float(time_s[0]), times=time_s,
        resolution=step, cycle_s=0.02,
    )  # fmt: skip
    return with_channels(signals, X=rack)


def expected(response):
    return GAIN * (1.0 - speed_over_set_point(response.omega_rad_s))


@pytest.mark.parametrize("clock_ratio", [0.0, -3e-4])
def test_the_rack_of_each_line_is_that_of_set_point_and_speed(clock_ratio):
    signals = with_rack(made_leg(clock_ratio=clock_ratio), np.random.default_rng(1))
    response = estimate_legs(signals, CAMPAIGN)["M1"].response
    assert response.outputs == ("n", "M_s", "X")
    assert measured(response).all()
    # the mean of the leg, not the working point that the signal came with
    assert signals.about("M1").channels["X"].reference == pytest.approx(MEAN, rel=1e-3)
    share = MEAN / signals.about("M1").channels["X"].reference
    assert np.abs(response.response[2, 0] - share * expected(response)).max() < 2e-4


def test_late_messages_are_taken_at_their_cycle():
    """Values of the cycle at stamps that tremble by 3 ms: 2.6 Hz would be 0.12 % too small, and noisy."""
    rng = np.random.default_rng(2)
    signals = with_rack(made_leg(), rng, late_s=0.003)
    response = estimate_legs(signals, CAMPAIGN)["M1"].response
    share = MEAN / signals.about("M1").channels["X"].reference
    fastest = abs(response.response[2, 0, -1] / (share * expected(response)[-1]) - 1.0)
    assert fastest < 2e-4


def test_messages_that_miss_a_part_of_the_leg_leave_the_rack_out():
    signals = with_rack(made_leg(), np.random.default_rng(3), first_s=30.0)
    assert estimate_legs(signals, CAMPAIGN)["M1"].response.outputs == ("n", "M_s")


def test_lines_that_messages_are_too_seldom_for_are_not_measured():
    signals = with_rack(made_leg(), np.random.default_rng(4))
    rack = signals.channels["X"]
    # every tenth message: 5 Hz, of which 2.25 Hz is told from its alias
    seldom = replace(
        rack, values=rack.values[::10], times=rack.times[::10], start_s=float(rack.times[0]), rate_hz=5.0, cycle_s=0.2
    )
    spectra = estimate_legs(with_channels(signals, X=seldom), CAMPAIGN)["M1"]
    fast = np.array(HARMONICS) / PERIOD_S > 2.25
    assert np.array_equal(measured(spectra.response)[2], ~fast)
    assert "X is not measured" in spectra.remarks["M1/21"]


@pytest.mark.slow
@pytest.mark.parametrize(("step", "noise"), [(0.0042, 0.0), (0.0042, 0.004), (0.0, 0.004)])
def test_the_stated_covariance_of_the_rack_holds_the_scatter(step, noise):
    """With steps of 1 % of the rack, with noise that spreads them and without, and with noise alone."""
    rng = np.random.default_rng(5)
    distances = []
    for _ in range(40):
        signals = with_rack(made_leg(noise=0.02, rng=rng), rng, step=step, noise=noise)
        response = estimate_legs(signals, CAMPAIGN)["M1"].response
        # the rack follows the speed that there was, noise and all, which is that of the made signals
        share = MEAN / signals.about("M1").channels["X"].reference
        error = response.response[2, 0] - share * expected(response)
        variance = response.covariance[:, 2, 2] + response.covariance[:, 5, 5]
        distances.append(np.abs(error) ** 2 / variance)
    assert 0.5 < np.mean(distances) < 1.25
