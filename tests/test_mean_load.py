"""The torque at the mean speed of a leg."""

import numpy as np
import pytest

from shaftprint.normalisation import mean_load

PERIOD_S, PERIODS, RATE_HZ = 20.0, 6, 50.0
TIME_S = np.arange(int(PERIOD_S * PERIODS * RATE_HZ)) / RATE_HZ
LINES = (1, 7, 15, 31, 45)


def _lines(*phases):
    return [np.sin(2.0 * np.pi * k * TIME_S / PERIOD_S + phase) for k, phase in zip(LINES, phases, strict=True)]


SPEED = 1.0 + 0.15 * sum(_lines(0.3, 2.0, 4.1, 5.0, 1.2))
SQUARE = (SPEED / SPEED.mean()) ** 2


def _mean_load(torque):
    return mean_load(torque, SQUARE, duration_s=PERIOD_S * PERIODS)


def test_a_load_that_wanders_slowly_has_its_mean_whatever_the_speed_does():
    slow = 1.0 + 0.1 * _lines(0.3, 2.0, 4.1, 5.0, 1.2)[0]
    assert _mean_load(1700.0 * SQUARE) == pytest.approx(1700.0, rel=1e-12)
    assert _mean_load(1700.0 * SQUARE * slow) == pytest.approx(1700.0, rel=1e-9)


def test_noise_at_the_lines_is_not_in_the_torque_by_which_they_are_divided():
    """Noise of 20 N m in the sense of the speed; the plain mean of the torque over the square takes 2 % of it."""
    noise = 20.0 * _lines(0.3, 2.0, 4.1, 5.0, 1.2)[3]
    assert np.mean((1700.0 * SQUARE + noise) / SQUARE) < 1697.0
    # what is left is of the slow part of the noise over the square, a sixth of that of the plain mean
    assert _mean_load(1700.0 * SQUARE + noise) == pytest.approx(1700.0, abs=0.5)


def test_a_zero_of_the_gauge_is_in_it_by_its_share():
    assert _mean_load(1700.0 * SQUARE + 51.0) == pytest.approx(1700.0 + 51.0 * _mean_load(np.ones_like(SQUARE)))
    assert 1.0 < _mean_load(np.ones_like(SQUARE)) < np.mean(1.0 / SQUARE)
