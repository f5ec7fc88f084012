"""Coefficients fitted through a disturbance that wanders, against disturbances that are known."""

import numpy as np
import pytest

from shaftprint.campaign import load_campaign
from shaftprint.errors import SignalError
from shaftprint.signals.levels._wander import fit_through_wander

TESTS = 200
# Expected are 190 of them, 183 or fewer in one of forty runs.
TOO_FEW = 183
STEP_S = 0.5
SIZE = 0.014


def wandering(correlation_s, duration_s, rng):
    """Return values of many tests by the recursion of the simulated tug, shape (tests, steps)."""
    keep = np.exp(-STEP_S / correlation_s)
    white = rng.standard_normal((round(duration_s / STEP_S), TESTS))
    found = np.empty_like(white)
    state = SIZE * rng.standard_normal(TESTS)
    for place, step in enumerate(white):
        state = keep * state + SIZE * np.sqrt(1.0 - keep**2) * step
        found[place] = state
    return found.T


@pytest.fixture(scope="module")
def sines():
    """Sines of the short campaign: ten windows of 100 down to 21 s in ten minutes."""
    sines = load_campaign("short").sines
    return np.array([s.settled_s for s in sines]), np.array([s.window_stop_s for s in sines])


@pytest.fixture(scope="module")
def blocks():
    """A quarter of an hour in blocks of twenty seconds."""
    begins = np.arange(0.0, 860.0, 20.0)
    return begins, begins + 20.0


def means_over(values, begins, ends):
    return np.array([values[round(b / STEP_S) : round(e / STEP_S)].mean() for b, e in zip(begins, ends, strict=True)])


def means_of(fits):
    return np.array([fit.value[0] for fit in fits]), np.array([fit.std[0] for fit in fits])


@pytest.mark.long
@pytest.mark.parametrize("windows", ["sines", "blocks"])
@pytest.mark.parametrize("correlation_s", [10.0, 30.0, 100.0])
def test_stated_deviation_of_a_mean_holds_the_truth_in_nineteen_of_twenty_tests(request, windows, correlation_s):
    begins, ends = request.getfixturevalue(windows)
    ones = np.ones((begins.size, 1))
    tests = wandering(correlation_s, float(ends.max()) + 1.0, np.random.default_rng(3))
    mean, std = means_of([fit_through_wander(1.0 + means_over(one, begins, ends), ones, begins, ends) for one in tests])
    assert np.count_nonzero(np.abs(mean - 1.0) < 1.96 * std) > TOO_FEW
    # neither far too wide: at most double what the means scatter
    assert np.median(std) < 2.0 * np.std(mean)


@pytest.mark.slow
def test_white_noise_beside_a_slow_wander_does_not_hide_it(blocks):
    """A wander of 1.4 % and 60 s under noise of 0.7 % in each block: the mean scatters with the wander."""
    begins, ends = blocks
    rng = np.random.default_rng(4)
    ones = np.ones((begins.size, 1))
    tests = wandering(60.0, 861.0, rng)
    noise = 0.007 * rng.standard_normal((TESTS, begins.size))
    mean, std = means_of(
        [
            fit_through_wander(means_over(one, begins, ends) + more, ones, begins, ends)
            for one, more in zip(tests, noise, strict=True)
        ]
    )
    assert np.count_nonzero(np.abs(mean) < 1.96 * std) > TOO_FEW


@pytest.mark.long
def test_slope_beside_the_mean_is_held_as_often(blocks):
    """``y = 2 + 3 x`` with ``x`` in three levels of a staircase, then at the middle one."""
    begins, ends = blocks
    x = np.where(np.arange(begins.size) < 9, np.arange(begins.size) // 3 - 1.0, 0.0)
    columns = np.column_stack([np.ones(x.size), x])
    hits = np.zeros(2)
    for one in wandering(20.0, 861.0, np.random.default_rng(6)):
        line = fit_through_wander(2.0 + 3.0 * x + means_over(one, begins, ends), columns, begins, ends)
        hits += np.abs(line.value - [2.0, 3.0]) < 1.96 * line.std
    assert np.all(hits > TOO_FEW)


def test_goes_with_what_is_measured_and_not_with_its_unit_or_the_clock(sines):
    begins, ends = sines
    values = 1.0 + 0.01 * np.random.default_rng(5).standard_normal(begins.size)
    columns = np.column_stack([np.ones(begins.size), np.linspace(-1.0, 2.0, begins.size)])
    line = fit_through_wander(values, columns, begins, ends)
    larger = fit_through_wander(1725.0 * values, columns * [1.0, 1e-6], begins, ends)
    assert larger.value == pytest.approx(1725.0 * line.value * [1.0, 1e6], rel=1e-9)
    assert larger.std == pytest.approx(1725.0 * line.std * [1.0, 1e6], rel=1e-9)
    later = fit_through_wander(values, columns, begins + 1e4, ends + 1e4)
    assert (*later.value, *later.std) == pytest.approx((*line.value, *line.std), rel=1e-6)


def test_of_what_stands_still_is_exact_and_a_column_of_nothing_is_zero(sines):
    begins, ends = sines
    columns = np.column_stack([np.ones(begins.size), np.zeros(begins.size)])
    line = fit_through_wander(np.full(begins.size, 1.03), columns, begins, ends)
    assert line.value == pytest.approx([1.03, 0.0])
    assert line.std == pytest.approx([0.0, 0.0], abs=1e-12)


def test_too_few_windows_are_refused():
    begins = np.arange(4.0)
    columns = np.column_stack([np.ones(4), [0.0, 1.0, 0.0, 1.0]])
    with pytest.raises(
        SignalError, match=r"at least 5 stretches of time to tell 2 numbers from .*, found 4; record longer"
    ):
        fit_through_wander(np.ones(4), columns, begins, begins + 1.0)
