import tracemalloc

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from shaftprint.signals import spline_speed
from shaftprint.signals.pulses._speed import knot_slopes


def test_constant_speed_is_constant():
    time = np.sort(np.random.default_rng(0).uniform(0.0, 10.0, 200))
    speed = spline_speed(time, 19.7 * time, start_s=-1.0, step_s=0.005, count=2400)
    assert speed == pytest.approx(np.full(2400, 19.7), rel=1e-11)


def test_slopes_are_those_of_the_natural_spline_family():
    # independent solver; the ends differ, and their influence falls by 3.7 a knot
    rng = np.random.default_rng(1)
    time = np.cumsum(rng.uniform(0.04, 0.06, 400))
    angle = np.arange(400) + 0.05 * rng.standard_normal(400)
    grid = time[0] + 0.005 * np.arange(int((time[-1] - time[0]) / 0.005))
    ours = spline_speed(time, angle, start_s=time[0], step_s=0.005, count=grid.size)
    theirs = CubicSpline(time, angle)(grid, 1)
    inner = (grid > time[30]) & (grid < time[-31])
    assert ours[inner] == pytest.approx(theirs[inner], rel=1e-10)


def test_parabola_is_exact_up_to_its_ends():
    # theta = 3 t + t^2: both ends have the second derivative of their neighbour
    time = np.array([0.0, 0.3, 0.5, 1.1, 1.2, 2.0])
    speed = spline_speed(time, 3.0 * time + time**2, start_s=0.0, step_s=0.1, count=21)
    assert speed == pytest.approx(3.0 + 2.0 * np.arange(21) / 10.0, rel=1e-12)


@pytest.mark.parametrize(("frequency_hz", "error"), [(0.4, 1e-5), (1.6, 1e-3), (3.4, 2e-2)])
def test_waving_speed_is_neither_averaged_nor_late(frequency_hz, error):
    # one pulse a revolution at 19.73 rev/s
    time = np.arange(0.0, 40.0, 1e-4)
    omega = 2 * np.pi * frequency_hz
    angle = 19.73 * (time + 0.1 * np.sin(omega * time) / omega)
    knots = np.arange(1.0, np.floor(angle[-1]))
    pulses = np.interp(knots, angle, time)
    speed = spline_speed(pulses, knots, start_s=0.0, step_s=0.005, count=8000)
    grid = 0.005 * np.arange(8000)
    inside = (grid > 2.0) & (grid < 38.0)
    true = 19.73 * (1.0 + 0.1 * np.cos(omega * grid))
    assert np.abs(speed - true)[inside].max() < error * 19.73 * 0.1 * 10.0 * 0.5


def test_missing_knot_changes_little():
    time = np.arange(0.0, 20.0, 1e-4)
    angle = 19.73 * (time + 0.05 * np.sin(2 * np.pi * 0.3 * time) / (2 * np.pi * 0.3))
    knots = np.arange(1.0, np.floor(angle[-1]))
    pulses = np.interp(knots, angle, time)
    keep = np.delete(np.arange(knots.size), 150)
    whole = spline_speed(pulses, knots, start_s=0.0, step_s=0.005, count=4000)
    holed = spline_speed(pulses[keep], knots[keep], start_s=0.0, step_s=0.005, count=4000)
    assert np.abs(whole - holed).max() < 2e-3


@pytest.mark.parametrize("knots", [3, 4, 5, 12, 33])
def test_the_second_derivative_is_continuous_and_at_both_ends_that_of_the_next_knot(knots):
    rng = np.random.default_rng(2)
    time = np.cumsum(rng.uniform(0.04, 0.06, knots))
    angle = np.cumsum(rng.uniform(0.5, 1.5, knots))
    slope = knot_slopes(time, angle)
    width, chord = np.diff(time), np.diff(angle) / np.diff(time)
    begin = (6.0 * chord - 4.0 * slope[:-1] - 2.0 * slope[1:]) / width
    end = (-6.0 * chord + 2.0 * slope[:-1] + 4.0 * slope[1:]) / width
    size = np.abs(begin).max()
    assert begin[1:] == pytest.approx(end[:-1], abs=1e-11 * size)
    assert [begin[0], end[-1]] == pytest.approx([end[0], begin[-1]], abs=1e-11 * size)
    # beyond the ends the speed is held
    out = spline_speed(time, angle, start_s=0.0, step_s=1.0, count=int(time[-1]) + 3)
    assert [out[0], out[-1]] == [slope[0], slope[-1]]


@pytest.mark.slow
def test_a_long_grid_needs_hardly_more_memory_than_the_speed_itself():
    time = np.linspace(0.0, 1000.0, 2000)
    tracemalloc.start()
    speed = spline_speed(time, 2.0 * time, start_s=0.0, step_s=0.001, count=1_000_000)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert speed == pytest.approx(np.full(1_000_000, 2.0))
    assert peak < 1.5 * speed.nbytes
