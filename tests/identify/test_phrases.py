"""Numbers and names as they stand in sentences."""

import pytest

from shaftprint.identify.judgement._phrases import listed, number, probability, spans


@pytest.mark.parametrize(
    ("p", "text"),
    [(0.43, "p = 0.43"), (0.0312, "p = 0.031"), (0.00021, "p = 0.0002"), (3e-8, "p < 1e-7"), (0.0, "p < 1e-12")],
)
def test_probability(p, text):
    assert probability(p) == text


def test_listed():
    assert listed(["a"]) == "a"
    assert listed(["a", "b"]) == "a and b"
    assert listed(["a", "b", "c"]) == "a, b and c"


def test_spans_name_neighbours_by_their_ends():
    order = [f"S{i}" for i in range(1, 10)]
    assert spans(["S3"], order) == "S3"
    assert spans(["S4", "S3"], order) == "S3 and S4"
    assert spans(["S9", "S3", "S5", "S4", "S1"], order) == "S1, S3 to S5 and S9"


def test_number_has_its_unit_unless_it_has_none():
    assert number(0.12345, "s") == "0.1235 s"
    assert number(2.0, "-") == "2"
