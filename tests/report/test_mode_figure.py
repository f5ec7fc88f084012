"""Shapes of torsional modes as they are drawn."""

import numpy as np
import pytest
from tests.report.marks import legend, mark

from shaftprint.report import mode_chart
from shaftprint.torsion import TorsionalLine, modes, torsional_line
from shaftprint.torsion._line import LineLink
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def chart():
    return mode_chart(modes(torsional_line(load_vessel("stan-tug-1205"))), shown=3)


def test_frequency_and_damping_stand_above_each_panel(chart):
    assert [panel.title for panel in chart.panels] == [
        "13.60 ± 0.96 Hz, damping ratio 0.067",
        "51.6 ± 3.7 Hz, damping ratio 0.046",
        "120.5 ± 7.2 Hz, damping ratio 0.193",
    ]


def test_bodies_stand_in_the_order_of_the_line(chart):
    panel = chart.panels[-1]
    order = ["Damper housing", *(f"Cylinder {n}" for n in range(1, 7)), "Rear crank", "Flywheel"]
    order += ["Elastic coupling CX45, secondary", "Clutch and transfer gear", "Output gear", "Flanges"]
    order += ["Propeller shaft", "Propeller, 3 blades"]
    assert list(panel.x.names) == order
    assert mark(panel, "line").x.tolist() == list(range(15))
    # branches stand beside what carries them
    assert mark(panel, "branch: Damper ring").x.tolist() == [0.5]
    assert mark(panel, "branch: Reverse clutch and transfer gear").x.tolist() == [10.5]


def test_first_mode_has_one_node_and_the_gauge_beyond_it(chart):
    """One node, at the coupling, between sides that swing against each other; the gauge is on the propeller shaft."""
    panel = chart.panels[0]
    shape = mark(panel, "line").y
    assert shape[-1] == pytest.approx(1.0)
    assert np.flatnonzero(np.diff(np.sign(shape))).tolist() == [8]
    assert mark(panel, "torque gauge").at == 12.5


def test_one_label_for_each_body_beside_the_line(chart):
    assert legend(chart) == [
        "torque gauge",
        "line",
        "branch: Reverse clutch and transfer gear",
        "branch: Damper ring",
    ]


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
    (panel,) = mode_chart(modes(line)).panels
    assert panel.title == "3.559 ± 0.000 Hz, damping ratio 0.000"
    assert mark(panel, "line").y == pytest.approx([1.0, -2.0 / 3.0])
