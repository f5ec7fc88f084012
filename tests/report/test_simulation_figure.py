"""What the figure of a simulation shows."""

import numpy as np
import pytest
from tests.report.marks import mark, names

from shaftprint.forecast import SimulatedSignal
from shaftprint.report import simulation_chart
from shaftprint.report.charts._marks import Band
from shaftprint.report.charts._text import as_plain

TIME = np.linspace(0.0, 10.0, 5001)


def signal(title, unit, height, *, std=None, is_input=False):
    return SimulatedSignal(title=title, unit=unit, values=height * np.sin(TIME), std=std, is_input=is_input)


def test_an_input_stands_beside_the_output_of_its_unit():
    signals = (
        signal("set point", "rpm", 2.0, is_input=True),
        signal("engine speed", "rpm", 1.0),
        signal("M_s", "-", 3),
    )
    speed, torque = simulation_chart(TIME, signals, name="model").panels
    assert names(speed) == ["set point", "model"]
    assert names(torque) == ["model"]
    assert as_plain(speed.y.title) == "engine speed [rpm]"
    assert as_plain(torque.y.title) == "M_s [-]"
    assert np.max(speed.marks[0].y) == pytest.approx(2.0, abs=1e-4)
    assert np.max(torque.marks[0].y) == pytest.approx(3.0, abs=1e-4)


def test_an_input_of_another_unit_has_a_panel_of_its_own():
    signals = (signal("u", "V", 2.0, is_input=True), signal("y", "", 1.0))
    drive, answer = simulation_chart(TIME, signals, name="model").panels
    assert names(drive) == ["u"]
    assert as_plain(answer.y.title) == "y"


def test_band_holds_95_percent_of_a_normal_distribution():
    chart = simulation_chart(TIME, (signal("y", "-", 0.0, std=np.full(5001, 0.5)),), name="model")
    band = mark(chart.panels[0], "95 % band of model", Band)
    # 1.95996 standard deviations on either side
    assert band.upper.max() == pytest.approx(0.97998, abs=1e-4)
    assert band.lower.min() == pytest.approx(-0.97998, abs=1e-4)
    assert band.x.max() == pytest.approx(10.0)


def test_another_model_beside():
    (panel,) = simulation_chart(
        TIME, (signal("y", "-", 1.0),), name="one", beside={"two": (signal("y", "-", 4.0),)}
    ).panels
    assert names(panel) == ["one", "two"]
    assert np.max(panel.marks[1].y) == pytest.approx(4.0, abs=1e-4)


def test_no_output_is_refused():
    with pytest.raises(ValueError, match="expected at least one output"):
        simulation_chart(TIME, (signal("u", "V", 1.0, is_input=True),), name="model")
