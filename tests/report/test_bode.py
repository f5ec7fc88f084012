from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.report import Curve, plot_bode, plot_closed_loop_response, plot_governor_fits, plot_line_selection
from shaftprint.report.figures import measured_phase_deg, trace_of


def line_of(axes, label):
    return next(line for line in axes.get_lines() if line.get_label().startswith(label))


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def markers(axes, face):
    """Return the x values of all points whose markers have this face."""
    found = [line for line in axes.get_lines() if line.get_marker() == "o" and line.get_markerfacecolor() == face]
    return np.concatenate([line.get_xdata() for line in found]) if found else np.empty(0)


def test_drawn_model_is_the_structure_s_response(identification, response):
    figure = plot_bode([Curve.of(identification)], data=response)
    for column, output in ((0, 0), (1, 1)):
        line = line_of(figure.axes[column], "GAUGE-CLOSED")
        expected = identification.structure.response(identification.values, 1j * line.get_xdata())[output]
        np.testing.assert_allclose(line.get_ydata(), 20.0 * np.log10(np.abs(expected)), atol=1e-9)
        phase = line_of(figure.axes[2 + column], "GAUGE-CLOSED").get_ydata()
        turns = (phase - np.degrees(np.angle(expected))) / 360.0
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)
        assert np.abs(np.diff(phase)).max() < 60.0


def test_band_is_drawn_at_the_edges_of_the_propagated_covariance(fits, open_responses):
    curve = Curve.of(fits["OL1"])
    figure = plot_bode([curve], data=open_responses[1])
    vertices = figure.axes[0].collections[0].get_paths()[0].vertices
    line = line_of(figure.axes[0], "OL1")
    omega, middle = line.get_xdata()[::3], line.get_ydata()[::3]
    slope = -1j * omega / (1j * omega * curve.values[curve.structure.names.index("tau_n")] + 2.0)
    half = 1.959964 * np.sqrt(curve.covariance[0, 0]) * np.abs(slope.real) * 20.0 / np.log(10.0)
    for at, expected in zip(omega, middle + half, strict=True):
        edge = vertices[np.isclose(vertices[:, 0], at, rtol=1e-12), 1].max()
        assert edge == pytest.approx(expected, abs=1e-8)


def test_used_lines_are_filled_and_the_others_hollow(response):
    axes = plot_closed_loop_response(response, aliasing_limit_hz=9.87).axes[0]
    np.testing.assert_allclose(markers(axes, "#000000"), response.omega_rad_s[:14])
    np.testing.assert_allclose(markers(axes, "white"), response.omega_rad_s[14:])
    (limit,) = [line for line in axes.get_lines() if str(line.get_label()).startswith("aliasing")]
    assert limit.get_xdata()[0] == pytest.approx(2.0 * np.pi * 9.87)


def test_labels_carry_units_and_the_legend_states_the_coverage(identification, response):
    figure = plot_bode([Curve.of(identification)], data=response, aliasing_limit_hz=9.87)
    assert figure.axes[0].get_ylabel() == "magnitude [dB]"
    assert figure.axes[2].get_ylabel() == "phase [deg]"
    assert figure.axes[2].get_xlabel() == "frequency [rad/s]"
    assert figure.axes[0].get_title(loc="left").startswith("(a) $n$ / $n_{\\mathrm{set}}$")
    assert legend_of(figure) == [
        "GAUGE-CLOSED, 95 % band",
        "data, 95 % interval",
        "data, line not used",
        "aliasing limit of the speed, 9.87 Hz",
    ]


def test_error_bars_have_the_length_of_the_interval(response):
    axes = plot_closed_loop_response(response).axes[0]
    segments = np.array(axes.containers[0].lines[2][0].get_segments())
    std = np.sqrt(response.covariance[:14, 0, 0])
    upper = 20.0 * np.log10(np.abs(response.response[0, 0, :14]) + 2.063899 * std)
    np.testing.assert_allclose(segments[:, 1, 1], upper, atol=1e-5)


def test_phase_of_data_follows_the_closest_model(identification, response):
    """The measured phases lie on the model's branch, far below -180 degrees."""
    curve = Curve.of(identification)
    trace = trace_of(curve, "n", np.geomspace(0.02, 300.0, 600))
    phase = measured_phase_deg(response, 0, [trace])
    expected = np.interp(np.log(response.omega_rad_s), np.log(trace.omega_rad_s), trace.phase_deg)
    assert np.abs(phase - expected).max() <= 180.0
    assert np.abs(phase - expected)[:12].max() < 10.0
    assert phase[12] < -300.0


def test_phase_of_data_alone_lags_from_line_to_line(response):
    """Thesis figure 3.7 has two points at +90 degrees that belong at -270 (thesis section 3.4.1)."""
    phase = measured_phase_deg(response, 0)
    used = phase[:14]
    assert np.diff(used).max() < 90.0
    assert -300.0 < used[11] < -240.0


def test_lines_that_are_not_used_do_not_turn_those_that_are(response):
    noisy = response.response.copy()
    noisy[0, 0, 3] *= np.exp(2.5j)
    used = response.used.copy()
    used[3] = False
    changed = measured_phase_deg(replace(response, response=noisy, used=used), 0)
    kept = np.arange(16) != 3
    np.testing.assert_allclose(changed[kept], measured_phase_deg(response, 0)[kept])


def test_zoom_shows_the_same_model_between_its_limits(fits, open_responses):
    figure = plot_governor_fits(open_responses[0], [Curve.of(fits["OL5"])])
    assert figure.axes[1].get_xlim() == (1.0, 10.0)
    whole, zoomed = (line_of(figure.axes[place], "OL5") for place in (0, 1))
    at = np.geomspace(1.0, 10.0, 50)
    one, two = (np.interp(at, line.get_xdata(), line.get_ydata()) for line in (whole, zoomed))
    np.testing.assert_allclose(one, two, atol=1e-9)


def test_a_model_that_leaves_the_data_does_not_squeeze_them(fits, response):
    figure = plot_bode([Curve.of(fits["CL3"])], data=response)
    low, high = figure.axes[0].get_ylim()
    points = 20.0 * np.log10(np.abs(response.response[0, 0]))
    assert low > points.min() - 30.0
    assert low < points.min()
    assert high > points.max()


def test_several_ways_to_measure_stand_side_by_side(response):
    figure = plot_line_selection({"fit": response, "bin": response, "peak": response})
    first = figure.axes[0]
    ratios = [c.lines[0].get_xdata()[0] / response.omega_rad_s[0] for c in first.containers[::2]]
    assert ratios == pytest.approx([1 / 1.12, 1.0, 1.12])
    assert "bin, 95 % interval" in legend_of(figure)


def test_a_model_without_covariance_has_no_band():
    model = structure("CL4")
    curve = Curve.at(model, {"K_p": 1.6}, "thesis")
    figure = plot_bode([curve])
    assert legend_of(figure) == ["thesis"]
    assert not figure.axes[0].collections


def test_unknown_parameters_are_said_in_the_legend(fits, response):
    """v and K_p, K_i of the benchmark cannot be told apart from each other."""
    figure = plot_bode([Curve.of(fits["BENCHMARK"])], data=response)
    assert legend_of(figure)[0] == "BENCHMARK, no band"


def test_integral_output_has_its_unit():
    figure = plot_bode([Curve.at(structure("INITIAL"), {})], outputs=["E_n"])
    assert figure.axes[0].get_ylabel() == "magnitude [dB re 1 s]"


def test_nothing_to_draw_is_refused():
    with pytest.raises(ValueError, match="needs a model or data"):
        plot_bode()
