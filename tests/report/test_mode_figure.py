"""Shapes of torsional modes as they are drawn."""

import numpy as np
import pytest

from shaftprint.report import plot_modes
from shaftprint.torsion import LineLink, TorsionalLine, modes, torsional_line
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def found():
    return modes(torsional_line(load_vessel("stan-tug-1205")))


@pytest.fixture(scope="module")
def figure(found):
    return plot_modes(found, shown=3)


def curve(axes, label="line"):
    return next(line for line in axes.lines if line.get_label() == label)


def test_frequency_and_damping_stand_above_each_panel(found, figure):
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == [
        "(a) 13.60 ± 0.96 Hz, damping ratio 0.067",
        "(b) 51.6 ± 3.7 Hz, damping ratio 0.046",
        "(c) 120.5 ± 7.2 Hz, damping ratio 0.193",
    ]


def test_bodies_stand_in_the_order_of_the_line(figure):
    axes = figure.axes[-1]
    names = dict(zip((tick.get_text() for tick in axes.get_xticklabels()), axes.get_xticks(), strict=True))
    order = ["Damper housing", *(f"Cylinder {n}" for n in range(1, 7)), "Rear crank", "Flywheel"]
    order += ["Elastic coupling CX45, secondary", "Clutch and transfer gear", "Output gear", "Flanges"]
    order += ["Propeller shaft", "Propeller, 3 blades"]
    assert [names[name] for name in order] == list(range(15))
    # branches stand beside what carries them
    assert names["Damper ring"] == names["Damper housing"] + 0.5
    assert names["Reverse clutch and transfer gear"] == names["Clutch and transfer gear"] + 0.5


def test_first_mode_has_one_node_and_the_gauge_beyond_it(figure):
    """One node, at the coupling, between sides that swing against each other; the gauge is on the propeller shaft."""
    axes = figure.axes[0]
    shape = np.asarray(curve(axes).get_ydata())
    assert shape[-1] == pytest.approx(1.0)
    assert np.flatnonzero(np.diff(np.sign(shape))).tolist() == [8]
    assert curve(axes, "torque gauge").get_xdata()[0] == 12.5


def test_one_label_for_each_kind(figure):
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["torque gauge", "line", "branch"]


def test_a_line_of_two_masses_has_one_panel():
    line = TorsionalLine(
        bodies=("engine", "propeller"),
        inertia_kg_m2=np.array([2.0, 3.0]),
        links=(LineLink(between=(0, 1), stiffness_nm_rad=600.0),),
        gauge=0,
        load_nm_s_rad=np.zeros(2),
        inertia_std_kg_m2=np.zeros(2),
        body_of={"engine": 0, "propeller": 1},
    )
    (axes,) = plot_modes(modes(line)).axes
    assert axes.get_title(loc="left") == "3.559 ± 0.000 Hz, damping ratio 0.000"
    assert np.asarray(curve(axes).get_ydata()) == pytest.approx([1.0, -2.0 / 3.0])
