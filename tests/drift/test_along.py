"""Sizes, scores and probabilities along directions, against numbers worked out by hand and against drawn noise."""

import numpy as np
import pytest

from shaftprint.drift._along import p_value_of_largest, whitened


def test_size_along_a_direction_is_the_weighted_mean():
    """Two numbers that a cause moves alike, known to 1 and 2: the mean weighs 1 and 1/4, and is known to sqrt(4/5)."""
    white = whitened(np.array([1.0, 3.0]), np.diag([1.0, 4.0]), np.array([[1.0], [1.0]]))
    (size,), (std,) = white.sizes((0,))
    assert size == pytest.approx((1.0 + 3.0 / 4.0) / (1.0 + 1.0 / 4.0))
    assert std == pytest.approx(np.sqrt(0.8))
    assert white.scores()[0] == pytest.approx(size / std)


def test_correlated_numbers_tell_a_change_of_one_that_neither_tells_alone():
    """Deviations of 1 with a correlation of 0.99: given the other, a number is known to sqrt(1 - 0.99^2)."""
    covariance = np.array([[1.0, 0.99], [0.99, 1.0]])
    white = whitened(np.array([1.0, 0.0]), covariance, np.eye(2))
    size, std = white.sizes((0,))
    assert size[0] == pytest.approx(1.0)
    assert std[0] == pytest.approx(np.sqrt(1.0 - 0.99**2))
    assert white.scores()[0] == pytest.approx(1.0 / np.sqrt(1.0 - 0.99**2))
    assert white.cosines()[0, 1] == pytest.approx(-0.99)


def test_units_of_the_numbers_do_not_matter():
    covariance = np.array([[1.0, 0.6], [0.6, 4.0]])
    units = np.array([1e-6, 1e4])
    plain = whitened(np.array([1.0, 2.0]), covariance, np.eye(2))
    other = whitened(units * [1.0, 2.0], covariance * np.outer(units, units), np.diag(units))
    assert other.scores() == pytest.approx(plain.scores())
    assert other.rest_p_value() == pytest.approx(plain.rest_p_value())


@pytest.mark.parametrize("covariance", [np.ones((2, 2)), np.diag([1.0, 0.0]), np.array([[1.0, np.nan], [np.nan, 1.0]])])
def test_a_covariance_that_fixes_a_number_exactly_is_refused(covariance):
    with pytest.raises(np.linalg.LinAlgError):
        whitened(np.zeros(2), covariance, np.eye(2))


def test_what_a_chosen_direction_explains_is_left_to_none():
    directions = np.array([[1.0, 0.0, 2.0], [1.0, 1.0, 2.0], [0.0, 0.0, 0.0]])
    white = whitened(np.array([3.0, 3.0, 0.5]), np.eye(3), directions)
    scores = white.scores((0,))
    assert scores[1] == pytest.approx(0.0)
    # twice the chosen one cannot be told from it
    assert scores[2] == 0.0
    assert white.rest_p_value((0,)) == pytest.approx(np.exp(-0.5 * 0.5**2))


def test_probability_of_the_largest_of_independent_scores():
    """1 - (1 - p)^K: the tree of pairs takes off K - 1 of the K (K - 1) / 2 products, the rest is third order."""
    single = 0.01
    limit = 2.5758293035489
    assert p_value_of_largest(limit, np.eye(5)) == pytest.approx(5 * single - 4 * single**2, rel=1e-6)
    assert p_value_of_largest(limit, np.ones((5, 5))) == pytest.approx(single, rel=1e-4)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_probability_of_the_largest_is_that_of_drawn_scores(seed):
    rng = np.random.default_rng(seed)
    directions = rng.standard_normal((6, 8))
    directions /= np.linalg.norm(directions, axis=0)
    largest = np.abs(rng.standard_normal((200_000, 6)) @ directions).max(axis=1)
    limit = float(np.quantile(largest, 0.95))
    bound = p_value_of_largest(limit, directions.T @ directions)
    assert 0.049 <= bound <= 0.065
