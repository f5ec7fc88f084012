"""How numbers are rounded: two digits of the standard deviation."""

import math

import pytest

from shaftprint.cli._numbers import plain, with_uncertainty


@pytest.mark.parametrize(
    ("value", "std", "text"),
    [
        (0.319853, 0.000187, "0.31985 +/- 0.00019"),
        (17.0123, 0.3412, "17.01 +/- 0.34"),
        (1183.776, 0.0771, "1183.776 +/- 0.077"),
        (5.52, 5.9, "5.5 +/- 5.9"),
        (123456.0, 1234.0, "123500 +/- 1200"),
        (52.3, 47.0, "52 +/- 47"),
        (-0.0123, 0.098, "-0.012 +/- 0.098"),
        (2.0, 0.0, "2 +/- 0"),
        (0.02208, math.inf, "0.02208 +/- unknown"),
        (6.0, 230.0, "6.0 +/- 230"),
        (-1234.6, 230.0, "-1230 +/- 230"),
        (0.0, 230.0, "0 +/- 230"),
        (math.nan, 230.0, "nan +/- unknown"),
    ],
)
def test_value_with_uncertainty(value, std, text):
    assert with_uncertainty(value, std) == text


def test_plain_number_has_four_digits():
    assert plain(0.0494312) == "0.04943"
    assert plain(1183.8) == "1184"
