"""What a reader sees before the charts are there, and in which order the page asks for its files."""

import re
import shutil

import pytest

from shaftprint.report._comparison import render_comparison

pytestmark = pytest.mark.slow


# Edges of boxes are rounded to dots.
JUMP_PX = 2.0
PLACES = """() => [...document.querySelectorAll('h2, figure, .plot, figcaption, footer')].map(element => {
  const box = element.getBoundingClientRect();
  return [box.top + window.scrollY, box.height, box.width];
})"""


@pytest.fixture(scope="module")
def report(tmp_path_factory, fingerprint):
    folder = tmp_path_factory.mktemp("first-sight") / "report"
    return render_comparison(folder, {"2025": fingerprint, "2026": fingerprint})


@pytest.fixture
def held(report, tmp_path):
    """A copy whose data wait until ``release()`` is called on the page."""
    shutil.copytree(report.parent, tmp_path / "copy")
    for name in ("differences", "responses"):
        file = tmp_path / "copy" / "plots" / f"{name}.js"
        data = file.read_text(encoding="utf-8")
        file.write_text(
            f"window.held = window.held || []; held.push(() => {{ {data} }});"
            "window.release = () => { while (held.length) held.shift()(); };",
            encoding="utf-8",
        )
    return tmp_path / "copy" / report.name


@pytest.mark.parametrize("width", [390, 1280])
def test_nothing_moves_when_a_chart_is_drawn(visit, held, width):
    with visit(held, viewport={"width": width, "height": 900}) as found:
        found.wait_for("(window.held || []).length === 2")
        before = found.page.evaluate(PLACES)
        found.page.evaluate("release()")
        for name in ("differences", "responses"):
            found.show(name)
        after = found.page.evaluate(PLACES)
        moves = [abs(a - b) for old, new in zip(before, after, strict=True) for a, b in zip(old, new, strict=True)]
        assert max(moves) <= JUMP_PX
        assert found.messages == []


def test_a_waiting_chart_can_be_reached_by_the_keyboard(visit, held):
    """Keys do nothing yet, and nothing goes wrong."""
    with visit(held) as found:
        found.wait_for("(window.held || []).length > 0")
        found.page.locator("#plot-differences").focus()
        for key in ("+", "ArrowLeft", "0"):
            found.page.keyboard.press(key)
        assert found.page.evaluate("document.activeElement.id") == "plot-differences"
        found.page.evaluate("release()")
        found.show("differences")
        before = found.axis("differences")
        found.page.keyboard.press("+")
        found.wait_for(f"document.getElementById('plot-differences')._fullLayout.xaxis.range[0] > {before[0]}")
        assert found.messages == []


def test_the_words_of_a_chart_are_read_aloud_once(visit, held):
    with visit(held) as found:
        found.wait_for("(window.held || []).length > 0")
        words = found.page.locator("#plot-differences").get_attribute("aria-label")
        assert found.page.get_by_role("group", name=words).count() == 1
        assert found.page.locator("#figure-differences .instead").is_hidden()


def test_plotly_has_what_reports_draw_and_no_more(visit, report):
    """By its own list of the kinds of traces that it can draw."""
    with visit(report) as found:
        found.show("differences")
        kinds = found.page.evaluate("Object.keys(Plotly.PlotSchema.get().traces)")
        assert sorted(kinds) == ["bar", "scatter"]


def test_the_page_is_light_or_dark_before_anything_is_painted(report):
    """Its own scripts are the only ones that the page waits for; plotly's and the data come beside and after it."""
    scripts = re.findall(r"<script ([^>]*)></script>", report.read_text(encoding="utf-8"))
    assert [("defer" in script, re.search(r'src="plots/(\w+)', script).group(1)) for script in scripts] == [
        (False, "report"),
        (False, "layout"),
        (False, "charts"),
        (True, "differences"),
        (True, "plotly"),
    ]
