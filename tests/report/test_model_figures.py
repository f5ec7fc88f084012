from dataclasses import replace

import numpy as np
import pytest
from tests.report.marks import legend, mark, marks

from shaftprint.catalogue import structure, thesis_families
from shaftprint.errors import StructureError
from shaftprint.models._nyquist import loop_gain
from shaftprint.report import Curve, correlation_chart, nyquist_chart, residual_chart, sensitivity_chart
from shaftprint.report.charts._marks import Fields, Points
from shaftprint.report.charts._text import as_plain
from shaftprint.report.figures._residuals import line_chi_square, normalised_residuals
from shaftprint.report.figures._sensitivity import parameter_steps


def test_nyquist_margins_lie_where_they_are_defined(identification):
    (panel,) = nyquist_chart(Curve.of(identification)).panels
    phase = mark(panel, "phase margin")
    assert np.hypot(phase.x[0], phase.y[0]) == pytest.approx(1.0, abs=1e-9)
    gain = mark(panel, "gain margin")
    assert -1.0 < gain.x[0] < 0.0
    assert as_plain(gain.name).startswith(f"gain margin {-1.0 / gain.x[0]:.2f}")
    drawn = mark(panel, "loop gain")
    place = int(np.nanargmin(np.abs(drawn.y + 1.0)))
    omega = float(drawn.words[place].split()[0])
    expected = loop_gain(identification.structure, identification.values, np.array([1j * omega]))[0]
    assert complex(drawn.x[place], drawn.y[place]) == pytest.approx(expected, abs=2e-2)
    assert panel.x.title == "real part of L [-]"


def test_nyquist_has_the_circle_that_touches_the_curve(identification):
    """No point of the loop gain lies within the margin circle, and one lies on it."""
    (panel,) = nyquist_chart(Curve.of(identification)).panels
    gain, circle = mark(panel, "loop gain"), mark(panel, "nearest")
    radius = np.hypot(circle.x + 1.0, circle.y)
    assert np.ptp(radius) < 1e-9
    assert np.nanmin(np.hypot(gain.x + 1.0, gain.y)) == pytest.approx(radius[0], rel=1e-3)


def test_nyquist_of_a_line_without_margins():
    """CL1 has infinite gain margin: there is nothing to mark."""
    chart = nyquist_chart(Curve.at(structure("CL1"), {"tau_n": 0.278, "K_p": 0.01, "K_i": 5.99}))
    assert "gain margin" not in " ".join(legend(chart))
    assert "stable" in " ".join(legend(chart))


def test_an_unstable_line_is_called_so():
    """CL4 of the thesis with half a second more delay than its delay margin of 0.39 s leaves."""
    values = {"tau_n": 0.33, "K_p": 1.6, "K_i": 4.4, "t_d": 0.62, "omega_n": 9.77, "zeta": 0.4}
    assert "UNSTABLE" in " ".join(legend(nyquist_chart(Curve.at(structure("CL4"), values))))


def test_a_line_without_feedback_has_no_nyquist_plot():
    with pytest.raises(StructureError, match="no feedback loop"):
        nyquist_chart(Curve.at(structure("OL1"), {}))


def test_correlation_is_written_in_its_field_and_coloured_by_its_sign(identification):
    (panel,) = correlation_chart(identification).panels
    (fields,) = panel.marks
    written = np.array([[float(word.replace("−", "-")) for word in row] for row in fields.words])
    np.testing.assert_allclose(written, identification.correlation, atol=0.0051)
    np.testing.assert_allclose(fields.values, identification.correlation)
    assert fields.values.min() < -0.5
    assert list(panel.x.names)[:2] == ["K_p", "K_i"]


def test_correlation_that_is_not_known_is_a_question_mark(identification):
    covariance = identification.covariance.copy()
    covariance[0, 0] = np.inf
    (panel,) = correlation_chart(replace(identification, covariance=covariance)).panels
    assert mark(panel, "", Fields).words[0][0] == "?"


def test_residuals_of_the_truth_are_standard_normal(identification):
    """Data were made with noise of the stated covariance, so residuals have variance near one and chi-square near 4."""
    fitted = identification.fitted
    assert normalised_residuals(identification)[:, fitted].std() == pytest.approx(1.0, abs=0.25)
    assert line_chi_square(identification)[fitted].mean() == pytest.approx(4.0, abs=1.6)


def test_residuals_hold_the_load_of_each_window(identification):
    """With another load the propeller's slope is k_q load: the residual moves as a changed k_q would move it."""
    loaded = replace(identification.response, load=np.full(16, 1.1))
    (part,) = identification.experiments
    moved = normalised_residuals(replace(identification, parts=(replace(part, response=loaded),)))
    values = identification.values.copy()
    values[identification.structure.names.index("k_q")] *= 1.1
    np.testing.assert_allclose(moved, normalised_residuals(replace(identification, values=values)), rtol=1e-9)


def test_residual_figure_states_the_limit_of_chi_square(identification):
    """The 95 % point of chi-square with four degrees of freedom is 9.488 (published table)."""
    chart = residual_chart(identification)
    assert "95 % limit, 9.5 for 4 numbers" in legend(chart)
    top, bottom = chart.panels
    assert [points.x.size for points in marks(bottom, "", Points) if not points.filled] == [2]
    assert top.y.title == "residual over its std [-]"


def test_each_parameter_is_varied_between_its_bounds():
    model = structure("OL4")
    omega_n = next(p for p in model.parameters if p.name == "omega_n")
    np.testing.assert_allclose(parameter_steps(omega_n), [7.0, 8.5, 10.0, 11.5, 13.0])
    magnitude, phase = sensitivity_chart(model, vary=["omega_n"]).panels
    for line, value in zip(magnitude.marks, (7.0, 8.5, 10.0, 11.5, 13.0), strict=True):
        expected = model.response(model.vector({"omega_n": value}), 1j * line.x)[0]
        np.testing.assert_allclose(line.y, 20.0 * np.log10(np.abs(expected)), atol=1e-9)
    assert as_plain(phase.title) == "omega_n = 7, 8.5, 10, 11.5, 13 rad/s"
    assert len({line.shade for line in magnitude.marks}) == 5


def test_a_vanishing_response_is_not_drawn():
    magnitude, phase = sensitivity_chart(structure("INITIAL"), vary=["v"]).panels
    for panel in (magnitude, phase):
        assert [bool(np.isfinite(line.y).any()) for line in panel.marks] == [False, True, True, True, True]


def test_the_thesis_families_have_its_parameters_and_bounds():
    families = {family.figure: family for family in thesis_families()}
    assert list(families) == ["4.2", "4.3", "4.4", "4.5", "4.6", "4.7", "4.8", "B.1-B.2", "B.3-B.4", "D.1"]
    lag = {p.name: (p.lower, p.value, p.upper) for p in families["4.8"].structure.parameters}
    assert lag["omega_n"] == (6.0, 10.0, 18.0)
    assert lag["zeta"] == (0.0, 0.5, 1.0)
    assert (lag["K_p"][1], lag["K_i"][1]) == (3.0, 4.0)
    assert families["4.5"].structure.vector({}).tolist() == [5.0, 3.0]
    assert families["B.1-B.2"].output == "E_n"


def test_low_frequency_limits_of_table_2_4():
    """n -> 1, E_n -> (2 - g) / (v K_i), M_s -> 2 for the initial values of eq. 2.35 (g -0.5, v 1, K_i 3)."""
    families = {family.figure: family for family in thesis_families()}
    for figure, limit in (("4.2", 1.0), ("B.1-B.2", 2.5 / 3.0), ("B.3-B.4", 2.0)):
        family = families[figure]
        drawn = sensitivity_chart(family.structure, output=family.output, vary=["tau_n"]).panels[0].marks
        for line in drawn:
            assert line.y[0] == pytest.approx(20.0 * np.log10(limit), abs=0.01)


def test_simplified_closed_loop_of_appendix_d():
    """Eq. D.1: (K_p s + K_i) / tau / (s^2 + (K_p + 2) / tau s + K_i / tau)."""
    family = next(family for family in thesis_families() if family.figure == "D.1")
    tau, gain, integral = 1.2, 10.0, 3.0
    s = 1j * np.geomspace(0.01, 100.0, 20)
    expected = (gain * s + integral) / tau / (s**2 + (gain + 2.0) / tau * s + integral / tau)
    found = family.structure.response(family.structure.vector({}), s)[0]
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_open_loop_of_eq_4_4():
    family = next(family for family in thesis_families() if family.figure == "4.3")
    tau, gain, integral, rack = 1.2, 10.0, 3.0, 1.0
    s = 1j * np.geomspace(0.01, 100.0, 20)
    expected = (rack * gain / tau * s + rack * integral / tau) / (s**2 + 2.0 / tau * s)
    np.testing.assert_allclose(family.structure.response(family.structure.vector({}), s)[0], expected, rtol=1e-12)


def test_data_are_drawn_into_every_row(open_responses):
    family = next(family for family in thesis_families() if family.figure == "4.5")
    chart = sensitivity_chart(family.structure, output="M_s", vary=family.vary, data=open_responses[0])
    assert [len(marks(panel, "data", Points)) for panel in chart.panels] == [1, 1, 1, 1]
    used = open_responses[0].used
    points = 20.0 * np.log10(np.abs(open_responses[0].response[0, 0, used]))
    np.testing.assert_allclose(mark(chart.panels[0], "data").y, points)
    low, high = chart.panels[0].y.span
    assert low < points.min()
    assert high > points.max()


def test_wrong_names_are_refused():
    model = structure("OL2")
    with pytest.raises(StructureError, match="OL2 has no output n; it has M_s"):
        sensitivity_chart(model, output="n")
    with pytest.raises(StructureError, match="out of K_p, K_i, found t_d"):
        sensitivity_chart(model, vary=["t_d"])
    with pytest.raises(StructureError, match="found none"):
        sensitivity_chart(model, vary=[])
