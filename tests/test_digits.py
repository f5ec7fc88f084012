import math

import pytest

from shaftprint.digits import interval, p_value_text, plain, plain_letters, rounded, stated, typographic, with_deviation


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
        (6.0, 230.0, "10 ± 230"),
        (0.4697, 0.0996, "0.47 ± 0.10"),
        (53.212, 1.0962, "53.2 ± 1.1"),
        (0.06976, 0.018, "0.070 ± 0.018"),
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


def test_an_interval_ends_where_the_value_ends():
    assert interval(-0.01292, 0.2791, 0.0745) == "−0.013 to 0.279"
    assert interval(1234.5, 2345.6, 283.0) == "1\u202f230 to 2\u202f350"


@pytest.mark.parametrize(
    ("p_value", "text", "on_terminal"),
    [
        (0.12, "0.12", "0.12"),
        (0.0012, "0.0012", "0.0012"),
        (4.71e-98, "4.7·10⁻⁹⁸", "4.7e-98"),
        (0.00099999, "1.0·10⁻³", "1.0e-3"),
        (0.0, "< 1.0·10⁻³⁰⁰", "< 1.0e-300"),
        (1.0, "1.0", "1.0"),
        (None, "–", "-"),
    ],
)
def test_small_p_values_are_powers_of_ten(p_value, text, on_terminal):
    assert p_value_text(p_value) == text
    assert plain_letters(text) == on_terminal


def test_small_machines_have_fine_units():
    assert stated(0.000310006, 0.000000053, "kg m2") == "3.10006 +/- 0.00053 kg cm2"
    assert stated(0.00134916, 0.00000097, "H") == "1.34916 +/- 0.00097 mH"
    assert stated(0.00002224, 0.00000033, "N m s/rad") == "0.02224 +/- 0.00033 mN m s/rad"
    assert stated(17.0, 0.34, "kg m2") == "17.00 +/- 0.34 kg m2"


def test_a_number_of_almost_nothing_is_a_power_of_ten():
    assert rounded(-6.7021e-13) == "−6.702·10⁻¹³"
    assert plain_letters(rounded(-6.7021e-13)) == "-6.702e-13"
    assert rounded(2.5e-6, 2) == "0.0000025"


def test_sentences_of_a_page_have_powers_of_ten():
    assert typographic("(p = 6.6e-05), 0.12 +/- 0.02, p < 1e-7, the file 3e-x") == (
        "(p = 6.6·10⁻⁵), 0.12 ± 0.02, p < 1·10⁻⁷, the file 3e-x"
    )


def test_short_times_are_stated_in_milliseconds():
    assert stated(-0.00013, 0.00024, "s") == "-0.13 +/- 0.24 ms"
    assert stated(0.122, 0.022, "s") == "0.122 +/- 0.022 s"
    assert stated(1183.63, 0.24, "rpm") == "1183.63 +/- 0.24 rpm"
