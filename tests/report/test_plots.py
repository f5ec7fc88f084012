"""Descriptions of interactive figures: what is in them against numbers known otherwise, and what may be in a script."""

import base64
import json
import re
import subprocess
import sys

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import ReportError
from shaftprint.report import Curve
from shaftprint.report.figures import shorter_svg
from shaftprint.report.plots import (
    Plot,
    bode_plot,
    budget_plot,
    excitation_plot,
    nyquist_plot,
    packed,
    plotly_script,
    plotly_sheets,
    plotly_version,
    signal_to_noise_plot,
    validation_plot,
)


def trace(plot, name, axes="x"):
    (found,) = [t for t in plot.traces if re.sub("<[^>]*>", "", t["name"]) == name and t["xaxis"] == axes]
    return found


def decoded(packed):
    counts = np.frombuffer(base64.b64decode(packed["int16"]), dtype="<i2").astype(float)
    return np.where(counts == -32768.0, np.nan, packed["offset"] + packed["scale"] * counts)


def test_what_is_not_finite_is_a_gap_and_no_text_ends_a_script():
    layout = {"title": "</script><b>", "range": (1.0, np.float64(2.0))}
    plot = Plot(traces=[{"y": [1.0, float("nan"), float("inf")], "n": np.int64(3)}], layout=layout)
    text = plot.text()
    assert "<" not in text
    found = json.loads(text)
    assert found["data"] == [{"y": [1.0, None, None], "n": 3}]
    assert found["layout"] == {"title": "</script><b>", "range": [1.0, 2.0]}


def test_what_json_has_not_is_refused():
    with pytest.raises(TypeError, match="found complex"):
        Plot(traces=[{"y": [1j]}], layout={}).text()


def test_a_first_order_lag_falls_by_3_db_and_45_degrees():
    """OL1 is 1 / (tau s + 2 - k) like: at the default values its corner is where |H| is 3.01 dB below its DC value."""
    model = structure("OL1")
    plot = bode_plot([Curve.at(model, {})])
    magnitude, phase = trace(plot, "OL1"), trace(plot, "OL1", "x2")
    drop = np.array(magnitude["y"]) - 20.0 * np.log10(abs(model.response(model.vector({}), np.array([1e-9j]))[0, 0]))
    corner = int(np.argmin(np.abs(drop + 10.0 * np.log10(2.0))))
    assert phase["y"][corner] == pytest.approx(-45.0, abs=1.0)


def test_nyquist_has_the_circle_that_touches_the_curve(identification):
    """No point of the loop gain lies within the margin circle, and one lies on it."""
    plot = nyquist_plot(Curve.of(identification))
    gain = next(t for t in plot.traces if t["name"].startswith("loop gain"))
    circle = next(t for t in plot.traces if t["name"].startswith("nearest"))
    distance = np.hypot(np.array(gain["x"]) + 1.0, np.array(gain["y"]))
    radius = np.hypot(np.array(circle["x"]) + 1.0, np.array(circle["y"]))
    assert np.ptp(radius) < 1e-5
    assert distance.min() == pytest.approx(radius[0], rel=1e-3)


def test_shares_of_a_budget_add_up(fingerprint):
    plot = budget_plot(fingerprint.budget)
    assert np.sum([t["x"] for t in plot.traces], axis=0) == pytest.approx(100.0, abs=0.1)


def test_ratios_are_those_of_the_spectra(spectra):
    plot = signal_to_noise_plot(spectra, aliasing_limit_hz=9.87)
    assert trace(plot, "Ms")["y"] == pytest.approx(spectra.signal_to_noise.local_db[:, -1].tolist(), rel=1e-5)
    limit = next(t for t in plot.traces if "9.87 Hz" in t["name"])
    assert limit["x"] == pytest.approx([62.015, 62.015], abs=1e-2)


def test_a_test_is_drawn_as_it_was_measured(signals, campaign):
    plot = excitation_plot(signals, campaign.staircases)
    first = round((campaign.staircases[0].start_s - signals.start_s) * signals.rate_hz)
    speed = signals.engine_speed.speed_rev_s[first] / signals.working_point.engine_speed_rev_s - 1.0
    assert decoded(trace(plot, "response")["y"])[0] == pytest.approx(speed, abs=2e-5)


@pytest.mark.parametrize(
    "values", [[0.0, 1.0, -3.5, 2.25], [5.0, float("nan"), 6.0], [7.0, 7.0], [float("nan")], [1e-9, -1e9]]
)
def test_a_packed_signal_is_itself_within_a_sixty_thousandth_of_its_range(values):
    given = np.array(values)
    found = decoded(packed(given))
    assert np.array_equal(np.isnan(found), np.isnan(given))
    span = np.nanmax(given) - np.nanmin(given) if np.isfinite(given).any() else 0.0
    assert np.all(np.isnan(given) | (np.abs(found - given) <= span / 60_000.0))


def test_an_excerpt_that_is_not_there_is_refused():
    with pytest.raises(ValueError, match="at least one validation"):
        validation_plot([], "C1", "whole")
    with pytest.raises(ValueError, match="found neither"):
        bode_plot()


@pytest.mark.slow
def test_the_script_is_plotly_and_its_package_is_not_imported():
    code = (
        "import sys; from shaftprint.report.plots import plotly_script; plotly_script();"
        "print([name for name in sys.modules if name.split('.')[0] == 'plotly'])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
    script = plotly_script()
    assert re.fullmatch(r"\d+\.\d+\.\d+", plotly_version(script))
    assert all(re.fullmatch("[0-9a-f]{64}", name) for name in plotly_sheets(script))


def test_without_plotly_the_way_out_is_said(monkeypatch):
    monkeypatch.setattr("shaftprint.report.plots._script.find_spec", lambda name: None)
    with pytest.raises(ReportError, match=r"expected the package plotly .* `pip install"):
        plotly_script()


def test_a_script_without_version_or_sheets():
    assert plotly_version(b"nothing") == "unknown"
    assert plotly_sheets(b"nothing") == ()


def test_a_shorter_svg_says_the_same():
    """Lines after lines lose their letter, a line after a bend keeps it, digits go behind the second."""
    path = "M 1.23456 2 \nL 3 4.99999 \nL 5 6 \nQ 1 2 3 4 \nQ 5 6 7 8 \nL 9 9 \nz\n"
    group = '<g transform="translate(1.23456 2) scale(0.015625)"/>'
    svg = f'<!-- a word -->\n<svg>\n  <path id="a" d="{path}"/>\n  {group}\n</svg>\n'
    found = shorter_svg(svg)
    assert 'd="M 1.23 2 3 4.99 5 6\nQ 1 2 3 4 5 6 7 8\nL 9 9\nz\n"' in found
    assert "translate(1.23 2) scale(0.015625)" in found
    assert "a word" not in found
    assert shorter_svg('<path d="M 1 1.234567e-05"/>') == '<path d="M 1 1.234567e-05"/>'
