"""What the figure of a simulation shows."""

import numpy as np
import pytest

from shaftprint.report import SimulatedSignal, plot_simulation

TIME = np.linspace(0.0, 10.0, 5001)


def signal(title, unit, height, *, std=None, is_input=False):
    return SimulatedSignal(title=title, unit=unit, values=height * np.sin(TIME), std=std, is_input=is_input)


def test_an_input_stands_beside_the_output_of_its_unit():
    signals = (
        signal("set point", "rpm", 2.0, is_input=True),
        signal("engine speed", "rpm", 1.0),
        signal("M_s", "-", 3),
    )
    speed, torque = plot_simulation(TIME, signals, name="model").axes
    assert [line.get_label() for line in speed.lines] == ["set point", "model"]
    assert [line.get_label() for line in torque.lines] == ["model"]
    assert speed.get_ylabel() == "engine speed [rpm]"
    assert torque.get_ylabel() == r"$M_{\mathrm{s}}$ [-]"
    assert np.max(speed.lines[0].get_ydata()) == pytest.approx(2.0, abs=1e-4)
    assert np.max(torque.lines[0].get_ydata()) == pytest.approx(3.0, abs=1e-4)


def test_an_input_of_another_unit_has_a_panel_of_its_own():
    signals = (signal("u", "V", 2.0, is_input=True), signal("y", "", 1.0))
    drive, answer = plot_simulation(TIME, signals, name="model").axes
    assert [line.get_label() for line in drive.lines] == ["$u$"]
    assert answer.get_ylabel() == "$y$"


def test_band_holds_95_percent_of_a_normal_distribution():
    (axes,) = plot_simulation(TIME, (signal("y", "-", 0.0, std=np.full(5001, 0.5)),), name="model").axes
    (band,) = axes.collections
    assert band.get_label() == "95 % band of model"
    corners = band.get_paths()[0].vertices
    # 1.95996 standard deviations on either side
    assert corners[:, 1].max() == pytest.approx(0.97998, abs=1e-4)
    assert corners[:, 1].min() == pytest.approx(-0.97998, abs=1e-4)
    assert corners[:, 0].max() == pytest.approx(10.0)


def test_another_model_beside():
    (axes,) = plot_simulation(TIME, (signal("y", "-", 1.0),), name="one", beside={"two": (signal("y", "-", 4.0),)}).axes
    assert [line.get_label() for line in axes.lines] == ["one", "two"]
    assert np.max(axes.lines[1].get_ydata()) == pytest.approx(4.0, abs=1e-4)


def test_no_output_is_refused():
    with pytest.raises(ValueError, match="expected at least one output"):
        plot_simulation(TIME, (signal("u", "V", 1.0, is_input=True),), name="model")
