"""How the time of a test is divided, by hand."""

import pytest

from shaftprint.design.plan._timetable import Timetable
from shaftprint.errors import DesignError

# Between 1360 and 920 rpm a ramp of 30 rpm/s takes 14.67 s, and as long back; a hundredth of a second each is spare.
# With lead, settling and the rest after the last leg 64.35 s are in no window.
LEVELS = (1360.0, 920.0)
OVERHEAD_S = 10.0 + 2 * 10.0 + 2 * (440.0 / 30.0 + 0.01) + 5.0


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
    # 64.35 s and two windows of 4 times 11 s
    with pytest.raises(DesignError, match="expected at least 152 s, which hold 4 periods of 11 s in each leg"):
        Timetable().periods(OVERHEAD_S + 2 * 43.9, LEVELS)


def test_a_staircase_takes_its_time_from_the_windows():
    """Six levels of 10 s leave each of two legs 30 s less."""
    with_stairs = Timetable(stairs=(1.0, 0.0, -1.0, 0.0, 1.0, 0.0))
    count, period_s = with_stairs.periods(OVERHEAD_S + 2 * 132.0 + 60.0, LEVELS)
    assert count * period_s == pytest.approx(132.0)


def test_one_speed_needs_no_ramp():
    assert Timetable().overhead_s([1200.0]) == pytest.approx(10.0 + 10.0 + 5.0)
