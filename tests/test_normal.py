"""Quantiles of the normal distribution against published tables."""

import pytest

from shaftprint.normal import NORMAL_95, deviations


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
