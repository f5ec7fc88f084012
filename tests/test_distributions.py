"""Tails and quantiles against scipy, closed forms and printed tables."""

import math

import numpy as np
import pytest
import scipy.special
import scipy.stats

from shaftprint.distributions import NORMAL_95, chi_square_quantile, chi_square_tail, deviations, f_tail, normal_cdf

# ---- normal and Student's t ----


@pytest.mark.parametrize(
    ("coverage", "expected"),
    [(0.5, 0.674490), (0.6826895, 1.0), (0.90, 1.644854), (0.95, 1.959964), (0.99, 2.575829), (0.9999, 3.890592)],
)
def test_deviations_that_hold_a_share(coverage, expected):
    assert deviations(coverage) == pytest.approx(expected, abs=1e-6)


def test_the_constant_is_the_same():
    assert deviations(0.95) == pytest.approx(NORMAL_95, abs=1e-12)


@pytest.mark.parametrize("coverage", [0.0, 1.0, 95.0, -0.1])
def test_a_coverage_is_a_share(coverage):
    with pytest.raises(ValueError, match=f"coverage: expected a share between 0 and 1, found {coverage}"):
        deviations(coverage)


def test_normal_cdf_agrees_with_scipy():
    values = np.linspace(-20.0, 9.0, 400).reshape(4, 100)
    np.testing.assert_allclose(normal_cdf(values), scipy.special.ndtr(values), rtol=1e-13)
    assert float(normal_cdf(-1.0)) == pytest.approx(scipy.special.ndtr(-1.0), rel=1e-14)


@pytest.mark.parametrize("freedom", [1.0, 1.5, 3.0, 12.0, 47.0, 5000.0])
@pytest.mark.parametrize("coverage", [0.5, 0.6827, 0.95, 0.999])
def test_deviations_of_students_t_agree_with_scipy(coverage, freedom):
    expected = scipy.special.stdtrit(freedom, 0.5 + 0.5 * coverage)
    assert deviations(coverage, freedom) == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize(("freedom", "expected"), [(1, 12.706), (2, 4.303), (10, 2.228), (30, 2.042)])
def test_printed_percentage_points_of_students_t(freedom, expected):
    """Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.10."""
    assert deviations(0.95, freedom) == pytest.approx(expected, abs=5e-4)


# ---- chi-square ----


@pytest.mark.parametrize("freedom", [0.5, 1, 2, 3, 7.3, 40, 400, 20000])
@pytest.mark.parametrize("share", [1e-6, 0.2, 0.9, 1.0, 1.1, 2.0, 5.0])
def test_chi_square_tail_agrees_with_scipy(freedom, share):
    value = share * freedom
    expected = scipy.stats.chi2.sf(value, freedom)
    assert chi_square_tail(value, freedom) == pytest.approx(expected, rel=1e-9, abs=1e-300)


def test_two_degrees_of_freedom_are_an_exponential():
    assert chi_square_tail(60.0, 2.0) == pytest.approx(math.exp(-30.0), rel=1e-12)


@pytest.mark.parametrize(("value", "freedom", "p"), [(3.841, 1, 0.05), (5.991, 2, 0.05), (23.209, 10, 0.01)])
def test_printed_percentage_points_of_chi_square(value, freedom, p):
    """Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.8."""
    assert chi_square_tail(value, freedom) == pytest.approx(p, rel=1e-3)


def test_ends_of_chi_square():
    assert chi_square_tail(0.0, 3.0) == 1.0
    assert chi_square_tail(-1.0, 3.0) == 1.0
    assert chi_square_tail(math.inf, 3.0) == 0.0
    assert chi_square_tail(1e5, 3.0) == 0.0


def test_without_a_degree_of_freedom_it_is_zero():
    """A sum of no squares."""
    assert chi_square_tail(0.0, 0.0) == 1.0
    assert chi_square_tail(1e-9, 0.0) == 0.0


@pytest.mark.parametrize("freedom", [1, 2, 4, 40, 400])
@pytest.mark.parametrize("coverage", [0.05, 0.5, 0.95, 0.99])
def test_chi_square_quantile_agrees_with_scipy(coverage, freedom):
    expected = scipy.special.chdtri(freedom, 1.0 - coverage)
    assert chi_square_quantile(coverage, freedom) == pytest.approx(expected, rel=1e-10)


# ---- F ----


@pytest.mark.parametrize("denominator", [1.5, 7.0, 10.7, 100.0, 5e4])
@pytest.mark.parametrize("numerator", [1, 2, 4, 6, 30])
@pytest.mark.parametrize("value", [1e-3, 0.3, 1.0, 1.5, 5.0, 80.0])
def test_f_tail_agrees_with_scipy(value, numerator, denominator):
    expected = scipy.stats.f.sf(value, numerator, denominator)
    assert f_tail(value, numerator, denominator) == pytest.approx(expected, rel=1e-9, abs=1e-300)


def test_infinite_denominator_is_a_chi_square():
    assert f_tail(2.3719, 4.0, math.inf) == pytest.approx(scipy.stats.chi2.sf(4 * 2.3719, 4), rel=1e-12)


def test_two_over_two_degrees_of_freedom_by_hand():
    """``P(F > x) = 1 / (1 + x)``: the quotient of two exponential variables."""
    for value in (0.1, 1.0, 7.0, 1e6):
        assert f_tail(value, 2.0, 2.0) == pytest.approx(1.0 / (1.0 + value), rel=1e-12)


@pytest.mark.parametrize(("value", "numerator", "denominator"), [(3.48, 4, 10), (2.60, 6, 20), (19.0, 2, 2)])
def test_printed_5_percent_points_of_f(value, numerator, denominator):
    """Abramowitz and Stegun, Handbook of Mathematical Functions, table 26.9."""
    assert f_tail(value, numerator, denominator) == pytest.approx(0.05, rel=0.01)


def test_ends_of_f():
    assert f_tail(0.0, 4.0, 10.0) == 1.0
    assert f_tail(-1.0, 4.0, 10.0) == 1.0
    assert f_tail(1e12, 4.0, 10.0) < 1e-50
