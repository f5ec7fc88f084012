"""How many periods are missing, by hand: one number a leg, information one a period."""

import numpy as np
import pytest

from shaftprint.design.standing._periods import PeriodInformation, missing_periods


def information(first, second, *, wish_one, wish_two, before=1e-12):
    """Two parameters, each told of by one leg alone."""
    return PeriodInformation(
        of_period=(np.diag([first, 0.0]), np.diag([0.0, second])),
        before=before * np.eye(2),
        targets={"one": wish_one, "two": wish_two},
        slopes={"one": np.array([1.0, 0.0]) / wish_one, "two": np.array([0.0, 1.0]) / wish_two},
    )


@pytest.mark.parametrize(
    ("wish_one", "wish_two", "expected"),
    # std after p periods of information i is 1 / sqrt(p i): p = 1 / (i wish^2), rounded up, at least two
    [(0.5, 0.5, (4, 2)), (0.3, 10.0, (12, 2)), (2.0, 0.1, (2, 25)), (0.1, 0.1, (100, 25))],
)
def test_each_leg_gets_what_its_number_needs(wish_one, wish_two, expected):
    assert missing_periods(information(1.0, 4.0, wish_one=wish_one, wish_two=wish_two), fewest=2) == expected


def test_what_is_there_already_counts():
    """Three of four periods' information: one is missing, two are sailed."""
    assert missing_periods(information(1.0, 1.0, wish_one=0.5, wish_two=1.0, before=3.0), fewest=2) == (2, 0)
    assert missing_periods(information(1.0, 1.0, wish_one=0.5, wish_two=1.0, before=4.1), fewest=2) == (0, 0)


def test_what_needs_more_than_a_day_is_not_reached():
    assert missing_periods(information(1.0, 1.0, wish_one=1e-3, wish_two=1.0), fewest=2) is None
