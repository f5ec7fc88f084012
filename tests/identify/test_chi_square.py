"""The tail of chi-square against scipy, closed forms and printed tables."""

import math

import pytest
import scipy.stats

from shaftprint.identify.likelihood import chi_square_tail


@pytest.mark.parametrize("freedom", [0.5, 1, 2, 3, 7.3, 40, 400, 20000])
@pytest.mark.parametrize("share", [1e-6, 0.2, 0.9, 1.0, 1.1, 2.0, 5.0])
def test_tail_agrees_with_scipy(freedom, share):
    value = share * freedom
    expected = scipy.stats.chi2.sf(value, freedom)
    assert chi_square_tail(value, freedom) == pytest.approx(expected, rel=1e-9, abs=1e-300)


def test_two_degrees_of_freedom_are_an_exponential():
    assert chi_square_tail(60.0, 2.0) == pytest.approx(math.exp(-30.0), rel=1e-12)


@pytest.mark.parametrize(("value", "freedom", "p"), [(3.841, 1, 0.05), (5.991, 2, 0.05), (23.209, 10, 0.01)])
def test_printed_percentage_points(value, freedom, p):
    """Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.8."""
    assert chi_square_tail(value, freedom) == pytest.approx(p, rel=1e-3)


def test_ends():
    assert chi_square_tail(0.0, 3.0) == 1.0
    assert chi_square_tail(-1.0, 3.0) == 1.0
    assert chi_square_tail(math.inf, 3.0) == 0.0
    assert chi_square_tail(1e5, 3.0) == 0.0


def test_without_a_degree_of_freedom_it_is_zero():
    """A sum of no squares."""
    assert chi_square_tail(0.0, 0.0) == 1.0
    assert chi_square_tail(1e-9, 0.0) == 0.0
