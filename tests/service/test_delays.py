"""What is known of delays before any log: lever, speed and torque share a clock, and nothing comes before the lever."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.errors import ServiceError
from shaftprint.service._delays import above, expect_one_clock
from shaftprint.service._model import FREE


@pytest.mark.parametrize(("t_d", "t_sp", "is_refused"), [(0.05, -0.13, True), (0.0, -0.02, False), (0.07, 0.7, True)])
def test_a_speed_that_comes_before_the_lever_is_on_another_clock(t_d, t_sp, is_refused):
    """A lever logged 0.2 s late was fitted with a delay of -78 +/- 9 ms, and trusted."""
    theta = np.zeros(len(FREE))
    theta[FREE.index("t_d")], theta[FREE.index("t_sp")] = t_d, t_sp
    covariance = np.zeros((len(FREE), len(FREE)))
    # each is open, their sum is known
    covariance[np.ix_(*[[FREE.index("t_d"), FREE.index("t_sp")]] * 2)] = [[0.04**2, -0.00159], [-0.00159, 0.04**2]]
    fit = SimpleNamespace(theta=theta, covariance=covariance)
    if is_refused:
        with pytest.raises(ServiceError, match="do not share one clock"):
            expect_one_clock(fit, FREE, Path("day.csv"))
    else:
        expect_one_clock(fit, FREE, Path("day.csv"))


@pytest.mark.parametrize("mean", [-0.6, 0.1, 2.5])
def test_numbers_above_a_bound_are_those_of_the_draws_above_it(mean):
    """Three numbers that go together, a million draws of them, and those in which the second is not below 0.2."""
    rng = np.random.default_rng(3)
    theta = np.array([4.0, mean, 0.3])
    root = np.array([[0.5, 0.0, 0.0], [-0.6, 0.5, 0.0], [0.1, 0.2, 0.3]])
    covariance = root @ root.T
    draws = theta + rng.standard_normal((1_000_000, 3)) @ root.T
    kept = draws[draws[:, 1] >= 0.2]
    found, spread, turn = above(theta, covariance, 1, 0.2)
    assert found == pytest.approx(kept.mean(axis=0), abs=0.006)
    assert spread == pytest.approx(np.cov(kept.T), abs=0.006)
    # what all go with moves the mean as it moves that of the draws
    more = np.array([0.02, 0.05, -0.01])
    moved, *_ = above(theta + more, covariance, 1, 0.2)
    assert moved - found == pytest.approx(turn @ more, abs=1e-3)


def test_a_bound_that_the_log_contradicts_moves_nothing():
    theta, covariance = np.array([1.0, -0.5]), np.array([[0.04, 0.01], [0.01, 0.01]])
    found, spread, turn = above(theta, covariance, 1, 0.0)
    assert np.array_equal(found, theta)
    assert np.array_equal(spread, covariance)
    assert np.array_equal(turn, np.eye(2))
