from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure, thesis_families
from shaftprint.errors import StructureError
from shaftprint.models import loop_gain
from shaftprint.report import Curve, plot_correlation, plot_nyquist, plot_residuals, plot_sensitivity
from shaftprint.report.figures import line_chi_square, normalised_residuals, parameter_steps


def test_nyquist_margins_lie_where_they_are_defined(identification):
    figure = plot_nyquist(Curve.of(identification))
    axes = figure.axes[0]
    lines = {str(line.get_label()).split()[0]: line for line in axes.get_lines()}
    phase = complex(lines["phase"].get_xdata()[0], lines["phase"].get_ydata()[0])
    assert abs(phase) == pytest.approx(1.0, abs=1e-9)
    gain = lines["gain"].get_xdata()[0]
    assert -1.0 < gain < 0.0
    text = next(str(line.get_label()) for line in axes.get_lines() if "gain margin" in str(line.get_label()))
    assert f"gain margin {-1.0 / gain:.2f}" in text
    curve = lines["loop"]
    expected = loop_gain(identification.structure, identification.values, np.array([1j * 0.05]))[0]
    assert curve.get_xdata()[0] == pytest.approx(expected.real)
    assert axes.get_xlabel() == "real part of L [-]"


def test_nyquist_of_a_line_without_margins():
    """CL1 has infinite gain margin: there is nothing to mark."""
    figure = plot_nyquist(Curve.at(structure("CL1"), {"tau_n": 0.278, "K_p": 0.01, "K_i": 5.99}))
    labels = " ".join(str(line.get_label()) for line in figure.axes[0].get_lines())
    assert "gain margin" not in labels
    assert "stable" in labels


def test_an_unstable_line_is_called_so():
    """CL4 of the thesis with half a second more delay than its delay margin of 0.39 s leaves."""
    values = {"tau_n": 0.33, "K_p": 1.6, "K_i": 4.4, "t_d": 0.62, "omega_n": 9.77, "zeta": 0.4}
    labels = " ".join(
        str(line.get_label()) for line in plot_nyquist(Curve.at(structure("CL4"), values)).axes[0].get_lines()
    )
    assert "UNSTABLE" in labels


def test_a_line_without_feedback_has_no_nyquist_plot():
    with pytest.raises(StructureError, match="no feedback loop"):
        plot_nyquist(Curve.at(structure("OL1"), {}))


def test_correlation_is_written_in_its_field(identification):
    axes = plot_correlation(identification).axes[0]
    count = len(identification.structure.free)
    written = np.array([float(text.get_text().replace("−", "-")) for text in axes.texts]).reshape(count, count)
    np.testing.assert_allclose(written, identification.correlation, atol=0.0051)
    assert [label.get_text() for label in axes.get_xticklabels()][:2] == [r"$K_{\mathrm{p}}$", r"$K_{\mathrm{i}}$"]


def test_correlation_that_is_not_known_is_a_question_mark(identification):
    covariance = identification.covariance.copy()
    covariance[0, 0] = np.inf
    axes = plot_correlation(replace(identification, covariance=covariance)).axes[0]
    assert axes.texts[0].get_text() == "?"


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
    figure = plot_residuals(identification)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "95 % limit, 9.5 for 4 numbers" in labels
    top, bottom = figure.axes
    hollow = [line for line in bottom.get_lines() if line.get_markerfacecolor() == "white"]
    assert hollow[0].get_xdata().size == 2
    assert top.get_ylabel() == "residual over\nstandard deviation [-]"


def test_each_parameter_is_varied_between_its_bounds():
    model = structure("OL4")
    omega_n = next(p for p in model.parameters if p.name == "omega_n")
    np.testing.assert_allclose(parameter_steps(omega_n), [7.0, 8.5, 10.0, 11.5, 13.0])
    figure = plot_sensitivity(model, vary=["omega_n"])
    magnitude, phase = figure.axes
    for line, value in zip(magnitude.get_lines(), (7.0, 8.5, 10.0, 11.5, 13.0), strict=True):
        expected = model.response(model.vector({"omega_n": value}), 1j * line.get_xdata())[0]
        np.testing.assert_allclose(line.get_ydata(), 20.0 * np.log10(np.abs(expected)), atol=1e-9)
    texts = [text.get_text() for text in phase.get_legend().get_texts()]
    assert texts == ["7 rad/s", "8.5 rad/s", "10 rad/s", "11.5 rad/s", "13 rad/s"]


def test_lines_of_a_family_differ_in_dashes_and_lightness():
    lines = plot_sensitivity(structure("OL2"), vary=["K_p"]).axes[0].get_lines()
    lightness = [
        np.dot([0.299, 0.587, 0.114], [int(line.get_color()[i : i + 2], 16) for i in (1, 3, 5)]) for line in lines
    ]
    assert np.all(np.diff(lightness) > 15.0)
    assert len({str(line._dash_pattern) for line in lines}) == 5


def test_a_vanishing_response_is_said_to_vanish():
    texts = plot_sensitivity(structure("INITIAL"), vary=["v"]).axes[1].get_legend().get_texts()
    assert texts[0].get_text() == "0, no response"


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
        drawn = plot_sensitivity(family.structure, output=family.output, vary=["tau_n"]).axes[0].get_lines()
        for line in drawn:
            assert line.get_ydata()[0] == pytest.approx(20.0 * np.log10(limit), abs=0.01)


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
    figure = plot_sensitivity(family.structure, output="M_s", vary=family.vary, data=open_responses[0])
    assert [len(axes.containers) for axes in figure.axes] == [2, 2, 2, 2]
    points = 20.0 * np.log10(np.abs(open_responses[0].response[0, 0]))
    low, high = figure.axes[0].get_ylim()
    assert low < points.min()
    assert high > points.max()


def test_wrong_names_are_refused():
    model = structure("OL2")
    with pytest.raises(StructureError, match="OL2 has no output n; it has M_s"):
        plot_sensitivity(model, output="n")
    with pytest.raises(StructureError, match="out of K_p, K_i, found t_d"):
        plot_sensitivity(model, vary=["t_d"])
    with pytest.raises(StructureError, match="found none"):
        plot_sensitivity(model, vary=[])
