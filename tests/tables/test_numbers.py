import math

import pytest

from shaftprint.tables import interval, plain, rounded, with_deviation


@pytest.mark.parametrize(
    ("value", "std", "text"),
    [
        (0.31978, 0.00016, "0.31978 ± 0.00016"),
        (1183.774, 0.31, "1\u202f183.77 ± 0.31"),
        (54.006, 11.2, "54 ± 11"),
        (5.5681, 0.6648, "5.57 ± 0.66"),
        (-250.885, 0.059, "−250.885 ± 0.059"),
        (1234567.0, 890.0, "1\u202f234\u202f570 ± 890"),
        (2.0, math.inf, "2.000 (not known)"),
        (0.0, 0.0, "0 ± 0"),
        (0.319853, 0.000187, "0.31985 ± 0.00019"),
        (17.0123, 0.3412, "17.01 ± 0.34"),
        (1183.776, 0.0771, "1\u202f183.776 ± 0.077"),
        (5.52, 5.9, "5.5 ± 5.9"),
        (123456.0, 1234.0, "123\u202f500 ± 1\u202f200"),
        (52.3, 47.0, "52 ± 47"),
        (-0.0123, 0.098, "−0.012 ± 0.098"),
        (2.0, 0.0, "2.000 ± 0.000"),
        (0.02208, math.inf, "0.02208 (not known)"),
        (6.0, 230.0, "6.0 ± 230"),
        (-1234.6, 230.0, "−1\u202f230 ± 230"),
        (0.0, 230.0, "0 ± 230"),
        (math.nan, 230.0, "– (not known)"),
    ],
)
def test_two_digits_of_the_deviation(value, std, text):
    assert with_deviation(value, std) == text


def test_plain_numbers():
    assert plain(-0.001, 2) == "0.00"
    assert plain(math.inf, 2) == "∞"
    assert plain(-math.inf, 2) == "−∞"
    assert plain(math.nan, 2) == "–"
    assert rounded(0.0) == "0"
    assert rounded(123456.0) == "123\u202f456"
    assert rounded(0.0123456) == "0.01235"


def test_intervals():
    assert interval(4.884, 6.671, 0.66) == "4.88 to 6.67"
    assert interval(1.0, 2.0, math.inf) == "1.000 to 2.000"
    assert interval(math.nan, 2.0, 1.0) == "–"
