"""The tail of the F distribution against scipy, closed forms and printed tables."""

import math

import pytest
import scipy.stats

from shaftprint.identify.likelihood import f_tail


@pytest.mark.parametrize("denominator", [1.5, 7.0, 10.7, 100.0, 5e4])
@pytest.mark.parametrize("numerator", [1, 2, 4, 6, 30])
@pytest.mark.parametrize("value", [1e-3, 0.3, 1.0, 1.5, 5.0, 80.0])
def test_tail_agrees_with_scipy(value, numerator, denominator):
    expected = scipy.stats.f.sf(value, numerator, denominator)
    assert f_tail(value, numerator, denominator) == pytest.approx(expected, rel=1e-9, abs=1e-300)


def test_infinite_denominator_is_a_chi_square():
    assert f_tail(2.3719, 4.0, math.inf) == pytest.approx(scipy.stats.chi2.sf(4 * 2.3719, 4), rel=1e-12)


def test_two_over_two_degrees_of_freedom_by_hand():
    """``P(F > x) = 1 / (1 + x)``: the quotient of two exponential variables."""
    for value in (0.1, 1.0, 7.0, 1e6):
        assert f_tail(value, 2.0, 2.0) == pytest.approx(1.0 / (1.0 + value), rel=1e-12)


@pytest.mark.parametrize(("value", "numerator", "denominator"), [(3.48, 4, 10), (2.60, 6, 20), (19.0, 2, 2)])
def test_printed_5_percent_points(value, numerator, denominator):
    """Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.9."""
    assert f_tail(value, numerator, denominator) == pytest.approx(0.05, rel=0.01)


def test_ends():
    assert f_tail(0.0, 4.0, 10.0) == 1.0
    assert f_tail(-1.0, 4.0, 10.0) == 1.0
    assert f_tail(1e12, 4.0, 10.0) < 1e-50
