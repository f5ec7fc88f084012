"""How the time of a test is divided, by hand."""

import pytest

from shaftprint.design import Timetable
from shaftprint.errors import DesignError

# Between 1360 and 920 rpm a ramp of 30 rpm/s takes 14.67 s; with lead and settling 44.67 s are in no window.
LEVELS = (1360.0, 920.0)
OVERHEAD_S = 10.0 + 2 * 10.0 + 440.0 / 30.0


@pytest.mark.parametrize(
    ("window_s", "periods"),
    [
        # four periods of 11.25 s: a first test
        (45.0, 4),
        (132.0, 4),
        (340.0, 10),
    ],
)
def test_whole_periods_fill_the_windows(window_s, periods):
    count, period_s = Timetable().periods(OVERHEAD_S + 2 * window_s, LEVELS)
    assert count == periods
    assert count * period_s == pytest.approx(window_s)


def test_four_periods_of_a_third_of_the_usual_length_are_the_least():
    # 44.67 s and two windows of 4 times 11 s
    with pytest.raises(DesignError, match="expected at least 133 s, which hold 4 periods of 11 s in each leg"):
        Timetable().periods(OVERHEAD_S + 2 * 43.9, LEVELS)
