"""A chart on its two ways: as data of the page, and as a picture of matplotlib."""

import base64
import json
import re
import subprocess
import sys

import numpy as np
import pytest
from matplotlib import rcParams

from shaftprint.errors import ReportError
from shaftprint.report import save_chart
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Bars, Fields, Line, Points, Straight, Words
from shaftprint.report.charts._packed import packed
from shaftprint.report.charts._pictures import draw
from shaftprint.report.charts._plotly import chart_json, chart_script
from shaftprint.report.charts._script import plotly_script, plotly_sheets, plotly_version
from shaftprint.report.charts._text import quantity
from shaftprint.tables import Symbol

X = np.array([1.0, 10.0, 100.0])
EVERY = Chart(
    panels=(
        Panel(
            title="all kinds",
            marks=(
                Band(x=X, lower=X - 1.0, upper=X + 1.0, name="band", shade=1),
                Line(x=X, y=X, name="line", shade=1),
                Points(x=X, y=X, name="points", bars=(0.5 * X, 2.0 * X), filled=False, words=("a", "b", "c")),
                Straight(at=10.0, axis="x", name="limit"),
                Words(x=10.0, y=5.0, text=Symbol("t_d")),
            ),
            x=Scale(title="frequency [rad/s]", log=True, span=(1.0, 100.0)),
            y=Scale(title=quantity("M_s", "N m")),
        ),
        Panel(
            marks=(Bars(places=np.arange(3.0), lengths=X, starts=np.zeros(3), name="bars", shade=7, upright=False),),
            y=Scale(names=(Symbol("K_p"), "b", "c"), span=(2.5, -0.5)),
        ),
        Panel(marks=(Fields(values=np.array([[1.0, -0.9], [np.nan, 0.1]]), words=(("1", "2"), ("?", "4"))),)),
    ),
    linked="none",
)


def decoded(packed):
    counts = np.frombuffer(base64.b64decode(packed["int16"]), dtype="<i2").astype(float)
    return np.where(counts == -32768.0, np.nan, packed["offset"] + packed["scale"] * counts)


def line_chart(x, y, name="line", **scale):
    return Chart(panels=(Panel(marks=(Line(x=x, y=y, name=name),), x=Scale(**scale)),))


# ---- on the page ----


def test_marks_are_traces_of_their_panel():
    content = json.loads(chart_script(EVERY))
    band, line, points, bars, fields = content["data"]
    assert (band["x"], band["y"]) == ([1.0, 10.0, 100.0, 100.0, 10.0, 1.0], [2.0, 11.0, 101.0, 99.0, 9.0, 0.0])
    assert (line["x"], line["line"]["color"], line["line"]["dash"]) == ([1.0, 10.0, 100.0], "@1", "dash")
    assert (points["error_y"]["arrayminus"], points["error_y"]["array"]) == ([0.5, 5.0, 50.0], [2.0, 20.0, 200.0])
    assert (points["marker"]["color"], points["text"]) == ("@paper", ["a", "b", "c"])
    assert (bars["x"], bars["xaxis"], bars["marker"]["pattern"]["shape"]) == ([1.0, 10.0, 100.0], "x2", "+")
    assert fields["marker"]["color"] == ["@=1.000", "@=-0.900", "@paper", "@=0.100"]
    assert fields["insidetextfont"]["color"] == ["@on=1.000", "@on=-0.900", "@ink", "@on=0.100"]
    (limit,), (words,) = content["shapes"], content["words"]
    # plotly takes words on a logarithmic axis by their logarithm, lines by their value
    assert (limit["x0"], limit["yref"], words["x"], words["text"]) == (10.0, "y domain", 1.0, "<i>t</i><sub>d</sub>")
    assert content["panels"][0]["x"]["span"] == [0.0, 2.0]
    assert content["panels"][0]["y"]["title"] == "<i>M</i><sub>s</sub> [N·m]"
    assert content["panels"][1]["y"]["names"][0] == "<i>K</i><sub>p</sub>"


def test_lines_whose_colour_comes_again_have_other_dashes():
    """Eight numbers of a plan are told apart though there are six colours."""
    chart = Chart(panels=[Panel(marks=[Line(x=X, y=X, name=f"line {k}", shade=k) for k in range(8)])])
    looks = [(trace["line"]["color"], trace["line"]["dash"]) for trace in json.loads(chart_script(chart))["data"]]
    assert len(set(looks)) == 8


def test_bars_are_told_apart_without_their_colours():
    """Twelve sources of a budget on a printer without colours: no two have one texture on one ground."""
    bars = [Bars(places=X, lengths=X, starts=0.0 * X, name=f"source {k}", shade=k) for k in range(12)]
    chart = Chart(panels=[Panel(marks=bars)])
    patterns = [trace["marker"]["pattern"] for trace in json.loads(chart_script(chart))["data"]]
    assert len({(pattern["shape"], pattern["bgcolor"] == "@paper") for pattern in patterns}) == 12
    drawn = [group.patches[0] for group in draw(chart).axes[0].containers]
    assert len({(bar.get_hatch(), bar.get_facecolor()[:3] == (1.0, 1.0, 1.0)) for bar in drawn}) == 12


def test_a_name_stands_in_the_legend_once():
    chart = Chart(panels=[Panel(marks=(Line(x=X, y=X, name="model"),))] * 2)
    assert [trace["showlegend"] for trace in chart_json(chart)["data"]] == [True, False]
    assert chart_json(chart)["legend"] == [5]


def test_what_is_not_finite_is_a_gap_and_no_text_ends_a_script():
    text = chart_script(line_chart(X, np.array([1.0, np.nan, np.inf]), name="</script><b>"))
    assert "<" not in text
    (trace,) = json.loads(text)["data"]
    assert trace["y"] == [1.0, None, None]
    assert trace["name"] == "&lt;/script&gt;&lt;b&gt;"


def test_a_band_with_a_gap_is_two_bands():
    band = Band(x=np.arange(5.0), lower=np.zeros(5), upper=np.array([1.0, 1.0, np.nan, 2.0, 2.0]))
    (trace,) = chart_json(Chart(panels=(Panel(marks=(band,)),)))["data"]
    assert trace["x"] == [0.0, 1.0, 1.0, 0.0, None, 3.0, 4.0, 4.0, 3.0]


def test_a_long_line_is_packed_and_an_even_one_twice_as_small():
    even, uneven = np.linspace(5.0, 25.0, 1001), np.geomspace(5.0, 25.0, 1001)
    y = np.sin(even)
    (trace,) = chart_json(line_chart(even, y))["data"]
    assert (trace["x0"], trace["dx"]) == (5.0, pytest.approx(0.02))
    np.testing.assert_allclose(decoded(trace["y"]), y, atol=2e-5)
    (trace,) = chart_json(line_chart(uneven, y))["data"]
    np.testing.assert_allclose(decoded(trace["x"]), uneven, atol=2e-4)
    # a logarithmic axis would show the steps of a packed frequency
    (trace,) = chart_json(line_chart(uneven, y, log=True))["data"]
    assert trace["x"] == pytest.approx(uneven.tolist(), rel=1e-5)


@pytest.mark.parametrize(
    "values", [[0.0, 1.0, -3.5, 2.25], [5.0, float("nan"), 6.0], [7.0, 7.0], [float("nan")], [1e-9, -1e9]]
)
def test_a_packed_signal_is_itself_within_a_sixty_thousandth_of_its_range(values):
    given = np.array(values)
    found = decoded(packed(given))
    assert np.array_equal(np.isnan(found), np.isnan(given))
    span = np.nanmax(given) - np.nanmin(given) if np.isfinite(given).any() else 0.0
    assert np.all(np.isnan(given) | (np.abs(found - given) <= span / 60_000.0))


def test_a_chart_without_panels_is_refused():
    with pytest.raises(ValueError, match="expected panels in columns, found 0 in 1"):
        Chart(panels=())


def test_a_phone_has_room_for_every_panel_below_the_other():
    chart = Chart(panels=[Panel(marks=(Line(x=X, y=X, name="model"),))] * 4, columns=2, heights_px=(200, 100))
    assert 300 < chart.height_px < 500
    # four panels, 600 px together, each with at most a hundred for its title, numbers and title of the axis
    assert 600 < chart.narrow_height_px - 22 <= 1000


# ---- plotly's script ----


@pytest.mark.slow
def test_the_script_is_plotly_and_its_package_is_not_imported():
    code = (
        "import sys; from shaftprint.report.charts._script import plotly_script; plotly_script();"
        "print([name for name in sys.modules if name.split('.')[0] == 'plotly'])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"
    script = plotly_script()
    assert re.fullmatch(r"\d+\.\d+\.\d+", plotly_version(script))
    assert all(re.fullmatch("[0-9a-f]{64}", name) for name in plotly_sheets(script))


def test_without_plotly_the_way_out_is_said(monkeypatch):
    monkeypatch.setattr("shaftprint.report.charts._script.find_spec", lambda name: None)
    with pytest.raises(ReportError, match=r"expected the package plotly .* `pip install"):
        plotly_script()


def test_a_script_without_version_or_sheets():
    assert plotly_version(b"nothing") == "unknown"
    assert plotly_sheets(b"nothing") == ()


# ---- as a picture ----


def test_a_picture_shows_the_same():
    first, second, third = draw(EVERY).axes[:3]
    line, points = first.get_lines()[0], first.containers[0]
    np.testing.assert_allclose(line.get_ydata(), X)
    segments = np.array(points.lines[2][0].get_segments())
    np.testing.assert_allclose(segments[:, :, 1], np.stack([0.5 * X, 3.0 * X], axis=-1))
    assert first.get_xlim() == (1.0, 100.0)
    assert first.get_ylabel() == r"$M_{\mathrm{s}}$ [N·m]"
    assert first.get_title(loc="left") == "all kinds"
    assert [bar.get_width() for bar in second.patches] == X.tolist()
    assert second.patches[0].get_hatch() == "++++"
    assert [label.get_text() for label in second.get_yticklabels()] == [r"$K_{\mathrm{p}}$", "b", "c"]
    assert [text.get_text() for text in third.texts] == ["1", "2", "?", "4"]


def test_a_picture_has_one_legend_inside_and_no_small_letters():
    names = [f"a rather long name of line {i}" for i in range(8)]
    chart = Chart(panels=(Panel(marks=[Line(x=X, y=X, name=name) for name in names], y=Scale(title="y")),))
    before = dict(rcParams)
    figure = draw(chart)
    figure.draw_without_rendering()
    (legend,) = figure.legends
    extent = legend.get_window_extent()
    assert [text.get_text() for text in legend.get_texts()] == names
    assert 0.0 <= extent.x0 < extent.x1 <= figure.bbox.width
    assert extent.y1 <= figure.axes[0].get_tightbbox().y0 + 1.0
    assert figure.get_size_inches()[0] * 2.54 == pytest.approx(16.0)
    texts = [figure.axes[0].yaxis.label, *figure.axes[0].get_yticklabels(), *legend.get_texts()]
    assert min(text.get_fontsize() for text in texts) >= 8.0
    # matplotlib is left as it was
    assert dict(rcParams) == before


@pytest.mark.slow
@pytest.mark.parametrize("suffix", [".svg", ".png", ".pdf"])
def test_the_same_chart_gives_the_same_file(tmp_path, suffix):
    for name in ("one", "two"):
        save_chart(EVERY, tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()
