"""Numbers of a second-order system, derived by hand (Ogata, Modern control engineering, section 5.3)."""

import numpy as np
import pytest

from shaftprint.validation.measures._step_numbers import STEP_NUMBERS, step_numbers

TIME = np.arange(-2.0, 12.0, 0.005)
PLACE = {name: place for place, name in enumerate(STEP_NUMBERS)}


def second_order(zeta, omega=9.0, start=0.0, height=1.0, time=TIME):
    damped = omega * np.sqrt(1.0 - zeta**2)
    later = np.maximum(time, 0.0)
    ringing = np.exp(-zeta * omega * later) * (
        np.cos(damped * later) + zeta / np.sqrt(1.0 - zeta**2) * np.sin(damped * later)
    )
    return start + height * np.where(time >= 0.0, 1.0 - ringing, 0.0)


def number(values, name, *, time=TIME, share=0.05):
    return step_numbers(np.atleast_2d(values), time, settled_share=share)[PLACE[name]]


@pytest.mark.parametrize("zeta", [0.2, 0.4, 0.6])
@pytest.mark.parametrize(("start", "height"), [(0.0, 1.0), (-0.2, 0.4), (0.3, -0.5)])
def test_overshoot_and_peak_time(zeta, start, height):
    values = second_order(zeta, start=start, height=height)
    overshoot = np.exp(-np.pi * zeta / np.sqrt(1.0 - zeta**2))
    assert number(values, "overshoot") == pytest.approx(100.0 * overshoot, abs=0.01)
    assert number(values, "peak") == pytest.approx(start + height * (1.0 + overshoot), abs=1e-4)
    assert number(values, "peak time") == pytest.approx(np.pi / (9.0 * np.sqrt(1.0 - zeta**2)), abs=1e-4)


def test_rise_time_of_a_lag():
    # 1 - exp(-t / T): from 10 to 90 % in T ln 9
    values = np.where(TIME >= 0.0, 1.0 - np.exp(-np.maximum(TIME, 0.0) / 0.5), 0.0)
    assert number(values, "rise time") == pytest.approx(0.5 * np.log(9.0), rel=1e-4)
    # settled within 5 % at T ln 20; no peak, as nothing goes beyond the end
    assert number(values, "settling time") == pytest.approx(0.5 * np.log(20.0), rel=1e-4)
    # the mean of the last third lacks exp(-16) of the height at most
    assert number(values, "overshoot") == pytest.approx(0.0, abs=100.0 * np.exp(-16.0))
    assert np.isnan(number(values, "peak time"))


def test_settling_time_of_a_ringing_response():
    # found on a grid of 0.01 ms: the last time that it is 5 % off
    fine = np.arange(0.0, 12.0, 1e-5)
    off = np.abs(second_order(0.3, time=fine) - 1.0) > 0.05
    last = fine[np.flatnonzero(off)[-1]]
    assert number(second_order(0.3), "settling time") == pytest.approx(last, abs=2e-3)


def test_what_does_not_settle_has_no_settling_time():
    ringing = np.where(TIME >= 0.0, 1.0 + 0.3 * np.sin(5.0 * TIME), 0.0)
    assert np.isnan(number(ringing, "settling time"))


def test_a_delay_moves_the_peak_and_nothing_else():
    late = np.interp(TIME - 0.1, TIME, second_order(0.4))
    assert number(late, "peak time") == pytest.approx(number(second_order(0.4), "peak time") + 0.1, abs=1e-4)
    assert number(late, "rise time") == pytest.approx(number(second_order(0.4), "rise time"), abs=1e-4)
    assert number(late, "overshoot") == pytest.approx(number(second_order(0.4), "overshoot"), abs=0.01)


def test_several_responses_at_once_are_each_alone():
    several = np.stack([second_order(0.2), second_order(0.6, height=-0.3)])
    found = step_numbers(several, TIME, settled_share=0.05)
    for row in range(2):
        assert found[:, row] == pytest.approx(step_numbers(several[row : row + 1], TIME, settled_share=0.05)[:, 0])
