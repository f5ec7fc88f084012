"""The picture of limits: every sample over speed, the level with its band, and the seconds that move most."""

from types import SimpleNamespace

import numpy as np
import pytest
from tests.report.marks import legend, mark

from shaftprint.catalogue import AHEAD_S
from shaftprint.identify import Estimate
from shaftprint.report import limit_chart

RATE_HZ = 12.5


def limits(*, level):
    """A sine of the speed with a burst at 60 s, a flat full-load curve, prediction and measurement 0.01 apart."""
    time = np.arange(0.0, 100.0, 1.0 / RATE_HZ)
    speed = 0.1 * np.sin(2.0 * np.pi * 0.05 * (time + AHEAD_S))
    predicted = np.where(np.abs(time - 60.0) < 3.0, np.sin(2.0 * np.pi * 2.0 * time), 0.1)
    record = SimpleNamespace(
        time_s=time, rate_hz=RATE_HZ, used=time > 5.0, inputs={"n": speed, "c": 0.0 * time},
        outputs={"y": predicted + 0.01 * np.cos(40.0 * time)},
    )  # fmt: skip
    number = Estimate(limit="torque limit", name="m_max", unit="-", value=1.9, std=0.05, interval_95=(1.8, 2.0))
    part = SimpleNamespace(record=record, predicted=predicted)
    return SimpleNamespace(predicted=part, numbers=(number,) if level else ())


@pytest.mark.parametrize("level", [True, False])
def test_a_torque_limit_is_shown_where_one_acts(level):
    chart = limit_chart(limits(level=level))
    assert ("torque limit, 95 %" in legend(chart)) == level
    assert {"measured", "predicted", "predicted, 95 % of the noise"} <= set(legend(chart))


def test_the_seconds_that_move_most_are_shown():
    begin, end = mark(limit_chart(limits(level=False)).panels[1], "measured").x[[0, -1]]
    assert begin < 57.5
    assert end > 62.5
    assert end - begin == pytest.approx(12.0, abs=0.1)


def test_speed_is_that_of_the_same_instant_as_the_torque():
    """The record has the speed early: over speed, the cloud must be where ``n`` is 0.1 sin(0.1 pi t)."""
    measured = mark(limit_chart(limits(level=False)).panels[0], "measured")
    time = np.arange(0.0, 100.0, 1.0 / RATE_HZ)
    expected = 1.0 + 0.1 * np.sin(2.0 * np.pi * 0.05 * time[time > 5.0])
    np.testing.assert_allclose(measured.x, expected, atol=1e-4)
