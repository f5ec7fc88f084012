from dataclasses import replace

import numpy as np
import pytest
from tests.report.marks import legend, mark, marks

from shaftprint.catalogue import structure
from shaftprint.report import Curve, bode_chart, fit_chart
from shaftprint.report.charts._marks import Band, Line, Points, Words
from shaftprint.report.charts._text import as_plain
from shaftprint.report.figures._residuals import normalised_residuals
from shaftprint.report.figures._traces import measured_phase_deg, trace_of


def test_drawn_model_is_the_structure_s_response(identification, response):
    chart = bode_chart([Curve.of(identification)], data=response)
    for column, output in ((0, 0), (1, 1)):
        line = mark(chart.panels[column], "GAUGE-CLOSED", Line)
        expected = identification.structure.response(identification.values, 1j * line.x)[output]
        np.testing.assert_allclose(line.y, 20.0 * np.log10(np.abs(expected)), atol=1e-9)
        phase = mark(chart.panels[2 + column], "GAUGE-CLOSED", Line).y
        turns = ((phase - np.degrees(np.angle(expected))) / 360.0)[np.isfinite(phase)]
        np.testing.assert_allclose(turns, np.round(turns), atol=1e-9)


def test_a_phase_of_many_turns_is_drawn_within_one_and_one_of_few_as_it_is(identification, response, open_responses):
    """The closed loop turns by more than three turns, the core propulsion ``n / M_s`` by less than half of one."""
    for panel in bode_chart([Curve.of(identification)], data=response).panels[2:]:
        for drawn in panel.marks:
            if isinstance(drawn, Line | Points):
                known = drawn.y[np.isfinite(drawn.y)]
                assert known.min() > -270.0
                assert known.max() <= 90.0
        (line,) = [m for m in panel.marks if isinstance(m, Line)]
        # where it jumps by a turn it has a gap
        steps = np.diff(line.y)
        assert np.nanmax(np.abs(steps)) < 180.0
        assert panel.y.step == 90.0
    core = open_responses[1]
    model = Curve.at(structure("OL1"), {})
    (line,) = marks(bode_chart([model], data=core).panels[1], "OL1", Line)
    assert np.isfinite(line.y).all()


def test_a_phase_of_a_turn_and_a_half_has_no_jump():
    model = structure("GAUGE-CLOSED")
    chart = bode_chart([Curve.at(model, {})], outputs=("n",), span_rad_s=(0.1, 25.0))
    line = mark(chart.panels[1], "GAUGE-CLOSED")
    phase = line.y[line.x <= 25.0]
    assert 450.0 < np.ptp(phase) < 540.0
    assert np.abs(np.diff(phase)).max() < 90.0


def test_a_first_order_lag_falls_by_3_db_and_45_degrees():
    """OL1 is 1 / (tau s + 2 - k) like: at the default values its corner is where |H| is 3.01 dB below its DC value."""
    model = structure("OL1")
    magnitude, phase = (mark(p, "OL1") for p in bode_chart([Curve.at(model, {})]).panels)
    drop = magnitude.y - 20.0 * np.log10(abs(model.response(model.vector({}), np.array([1e-9j]))[0, 0]))
    corner = int(np.argmin(np.abs(drop + 10.0 * np.log10(2.0))))
    assert phase.y[corner] == pytest.approx(-45.0, abs=1.0)


def test_band_is_drawn_at_the_edges_of_the_propagated_covariance(fits, open_responses):
    curve = Curve.of(fits["OL1"])
    panel = bode_chart([curve], data=open_responses[1]).panels[0]
    band, line = mark(panel, "OL1", Band), mark(panel, "OL1", Line)
    omega, middle = line.x[::3], line.y[::3]
    slope = -1j * omega / (1j * omega * curve.values[curve.structure.names.index("tau_n")] + 2.0)
    half = 1.959964 * np.sqrt(curve.covariance[0, 0]) * np.abs(slope.real) * 20.0 / np.log(10.0)
    np.testing.assert_allclose(band.x, omega)
    np.testing.assert_allclose(band.upper, middle + half, atol=1e-8)
    np.testing.assert_allclose(band.lower, middle - half, atol=1e-8)


def test_used_lines_are_filled_and_the_others_hollow(response):
    panel = bode_chart(data=response, aliasing_limit_hz=9.87).panels[0]
    filled, hollow = marks(panel, "data", Points)
    assert (filled.filled, hollow.filled) == (True, False)
    np.testing.assert_allclose(filled.x, response.omega_rad_s[:14])
    np.testing.assert_allclose(hollow.x, response.omega_rad_s[14:])
    assert mark(panel, "aliasing").at == pytest.approx(2.0 * np.pi * 9.87)


def test_labels_carry_units_and_the_legend_states_the_coverage(identification, response):
    chart = bode_chart([Curve.of(identification)], data=response, aliasing_limit_hz=9.87)
    assert chart.panels[0].y.title == "magnitude [dB]"
    assert chart.panels[2].y.title == "phase [deg]"
    assert chart.panels[2].x.title == "frequency [rad/s]"
    assert as_plain(chart.panels[0].title) == "engine speed n / n_set"
    assert legend(chart) == [
        "GAUGE-CLOSED, 95 % band",
        "GAUGE-CLOSED",
        "data, 95 % interval",
        "data, line not used",
        "aliasing limit of the speed, 9.87 Hz",
        "data, weaker than noise",
    ]


def test_error_bars_have_the_length_of_the_interval(response):
    points = marks(bode_chart(data=response).panels[0], "data", Points)[0]
    std = np.sqrt(response.covariance[:14, 0, 0])
    upper = 20.0 * np.log10(np.abs(response.response[0, 0, :14]) + 2.063899 * std)
    np.testing.assert_allclose(points.y + points.bars[1], upper, atol=1e-5)


def test_the_panel_below_a_fit_shows_its_residuals_in_deviations_of_the_data(identification):
    """Of equal deviations of real and imaginary part, both ways to divide a residual have the same sum of squares."""
    chart = fit_chart(identification)
    assert len(chart.panels) == 6
    fitted, count = identification.fitted, len(identification.fit_percent)
    normalised = normalised_residuals(identification)[:, fitted]
    for channel, panel in enumerate(chart.panels[4:]):
        along, across = marks(panel, "residual", Points)
        expected = normalised[channel] ** 2 + normalised[count + channel] ** 2
        np.testing.assert_allclose(along.y**2 + across.y**2, expected, rtol=1e-9)
        assert panel.y.span[1] > np.abs(np.concatenate([along.y, across.y])).max()


def test_the_band_below_a_fit_is_that_of_the_model_in_deviations_of_the_data(fits):
    """OL1 has one parameter: its band is |dH/dtau| 1.96 std(tau), along and across the model, over the data's."""
    fit = fits["OL1"]
    panel = fit_chart(fit).panels[2]
    omega = fit.response.omega_rad_s[fit.fitted]
    tau = fit.values[fit.structure.names.index("tau_n")]
    slope = -1j * omega / (1j * omega * tau + 2.0)
    half = 1.959964 * np.sqrt(fit.covariance[0, 0]) * np.abs(slope.real)
    model = fit.structure.response(fit.values, 1j * omega)[0]
    size = np.abs(model)
    unit = (model / size).view(np.float64).reshape(-1, 2)
    std = np.sqrt(np.einsum("li,lij,lj->l", unit, fit.response.covariance[fit.fitted], unit))
    band = mark(panel, "model band, magnitude", Band)
    np.testing.assert_allclose(band.upper, half * size / std, rtol=1e-6)


def test_a_line_of_noise_alone_does_not_stand_at_plus_one_below_a_fit(identification):
    """Where noise is twenty times the response its residual points anywhere; along itself it would always be +1."""
    data, rng = identification.response, np.random.default_rng(3)
    noise = 20.0 * np.abs(data.response).max()
    values = noise * (rng.standard_normal(data.response.shape) + 1j * rng.standard_normal(data.response.shape))
    covariance = np.broadcast_to(noise**2 * np.eye(data.covariance.shape[1]), data.covariance.shape)
    noisy = replace(identification.experiments[0], response=replace(data, response=values, covariance=covariance))
    drowned = replace(identification, parts=(noisy,))
    for panel in fit_chart(drowned).panels[4:]:
        along = marks(panel, "residual, magnitude", Points)[0].y
        assert (along < -0.1).sum() >= 3
        assert (along > 0.1).sum() >= 3


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
    chart = bode_chart([Curve.of(fits["OL5"])], data=open_responses[0], zoom_rad_s=(1.0, 10.0))
    assert chart.panels[1].x.span == (1.0, 10.0)
    whole, zoomed = (mark(chart.panels[place], "OL5", Line) for place in (0, 1))
    at = np.geomspace(1.0, 10.0, 50)
    one, two = (np.interp(at, line.x, line.y) for line in (whole, zoomed))
    np.testing.assert_allclose(one, two, atol=1e-9)
    assert chart.linked == "columns"


def test_a_model_that_leaves_the_data_does_not_squeeze_them(fits, response):
    low, high = bode_chart([Curve.of(fits["CL3"])], data=response).panels[0].y.span
    points = 20.0 * np.log10(np.abs(response.response[0, 0]))
    assert low > points.min() - 30.0
    assert low < points.min()
    assert high > points.max()


def test_several_ways_to_measure_stand_side_by_side(response):
    chart = bode_chart(data={"fit": response, "bin": response, "peak": response})
    shown = marks(chart.panels[0], "", Points)[::2]
    assert [points.x[0] / response.omega_rad_s[0] for points in shown] == pytest.approx([1 / 1.12, 1.0, 1.12])
    assert len({points.shade for points in shown}) == 3
    assert "bin, 95 % interval" in legend(chart)


def test_a_model_without_covariance_has_no_band():
    chart = bode_chart([Curve.at(structure("CL4"), {"K_p": 1.6}, "thesis")])
    assert legend(chart) == ["thesis"]
    assert not marks(chart.panels[0], "", Band)


def test_unknown_parameters_are_said_in_the_legend(fits, response):
    """v and K_p, K_i of the benchmark cannot be told apart from each other."""
    assert legend(bode_chart([Curve.of(fits["BENCHMARK"])], data=response))[0] == "BENCHMARK, no band"


def test_integral_output_has_its_unit():
    chart = bode_chart([Curve.at(structure("INITIAL"), {})], outputs=["E_n"])
    assert chart.panels[0].y.title == "magnitude [dB re 1 s]"


def test_nothing_to_draw_is_refused():
    with pytest.raises(ValueError, match="needs a model or data"):
        bode_chart()


def test_lines_that_may_be_noise_alone_are_pale_and_have_no_interval(identification):
    """Ten times the deviations: an interval that reaches no response at all would fill the diagram."""
    (part,) = identification.experiments
    noisy = replace(part.response, covariance=100.0 * part.response.covariance)
    chart = bode_chart([Curve.of(identification)], data=noisy)
    (pale,) = marks(chart.panels[0], "data, weaker than noise", Points)
    (seen,) = marks(chart.panels[0], "data, 95 % interval", Points)
    assert pale.bars is None
    assert pale.shade == "soft"
    assert np.isfinite(seen.y - seen.bars[0]).all()
    assert seen.bars[0].max() < 200.0
    assert pale.x.size + seen.x.size == noisy.used.sum()


def with_one_line_away(response, factor, place=5):
    """The response with one line ``factor`` times as large."""
    values = response.response.copy()
    values[:, :, place] *= factor
    return replace(response, response=values)


@pytest.mark.parametrize("modelled", [True, False])
@pytest.mark.parametrize(("factor", "word"), [(1e4, "1 point above"), (1e-9, "1 point below")])
def test_one_stray_line_does_not_stretch_the_axis_and_is_told(identification, response, modelled, factor, word):
    """A line 80 dB above, or 180 dB below, would leave the resonance a fifth of the height."""
    curves = [Curve.of(identification)] if modelled else []
    before = bode_chart(curves, data=response).panels[0]
    panel = bode_chart(curves, data=with_one_line_away(response, factor)).panels[0]
    assert np.ptp(panel.y.span) < np.ptp(before.y.span) + 16.0
    assert [m.text for m in panel.marks if isinstance(m, Words)] == [word]
    (edge,) = marks(panel, "beyond the axis", Points)
    assert edge.x == pytest.approx(response.omega_rad_s[5:6])
    assert panel.y.span[0] < edge.y[0] < panel.y.span[1]
    assert [m for m in before.marks if isinstance(m, Words)] == []


def test_points_that_a_wrong_model_does_not_meet_are_all_on_the_axis(identification, response):
    """Where more than a few are far from the model they are what there is to see."""
    values = 1e3 * response.response
    covariance = 1e6 * response.covariance
    panel = bode_chart(
        [Curve.of(identification)], data=replace(response, response=values, covariance=covariance)
    ).panels[0]
    points = marks(panel, "data, 95 %", Points)[0]
    assert points.y.min() > panel.y.span[0]
    assert points.y.max() < panel.y.span[1]


def test_the_last_line_of_a_steep_response_is_no_stray_one(response):
    """40 dB a decade, without a model to tell."""
    omega = response.omega_rad_s
    fall = np.broadcast_to(1.0 / (1.0 + (omega / omega[2]) ** 3), response.response.shape).astype(complex)
    small = 1e-12 * np.broadcast_to(np.eye(response.covariance.shape[1]), response.covariance.shape)
    panel = bode_chart(data=replace(response, response=fall, covariance=small)).panels[0]
    assert [m for m in panel.marks if isinstance(m, Words)] == []
