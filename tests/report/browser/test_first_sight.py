"""What a reader sees before the charts are there: their static figures, in the same place."""

import re
import shutil

import pytest

from shaftprint.report import render_comparison

pytestmark = pytest.mark.slow


# Edges of boxes are rounded to dots.
JUMP_PX = 2.0
WHAT_IS_SEEN = """name => {
  const figure = document.getElementById(`figure-${name}`);
  const image = figure.querySelector('img'), plot = figure.querySelector('.plot');
  const seen = element => element !== null
    && element.checkVisibility({visibilityProperty: true, opacityProperty: true})
    && element.getBoundingClientRect().height > 100;
  return {twin: image.complete && image.naturalWidth > 0 && seen(image), chart: seen(plot.querySelector('.main-svg'))};
}"""
PLACES = """() => [...document.querySelectorAll('h2, figure, .plot, figcaption, footer')].map(element => {
  const box = element.getBoundingClientRect();
  return [box.top + window.scrollY, box.height, box.width];
})"""
TWIN = {"twin": True, "chart": False}
CHART = {"twin": False, "chart": True}


@pytest.fixture(scope="module")
def report(tmp_path_factory, fingerprint):
    folder = tmp_path_factory.mktemp("first-sight") / "report"
    return render_comparison(folder, {"2025": fingerprint, "2026": fingerprint})


@pytest.fixture
def copied(report, tmp_path):
    """A copy of the report, whose files a test may change."""
    shutil.copytree(report.parent, tmp_path / "copy")
    return tmp_path / "copy" / report.name


@pytest.fixture
def held(copied):
    """A copy whose data wait until ``release()`` is called on the page."""
    for name in ("differences", "responses"):
        file = copied.parent / "plots" / f"{name}.js"
        data = file.read_text(encoding="utf-8")
        file.write_text(
            f"window.held = window.held || []; held.push(() => {{ {data} }});"
            "window.release = () => { while (held.length) held.shift()(); };",
            encoding="utf-8",
        )
    return copied


def seen(found, name):
    return found.page.evaluate(WHAT_IS_SEEN, name)


def scroll_to(found, name):
    found.page.locator(f"#figure-{name}").evaluate("element => element.scrollIntoView({block: 'center'})")
    found.wait_for(f"document.querySelector('#figure-{name} img').complete")


@pytest.mark.parametrize("width", [390, 1280])
def test_the_static_figure_is_seen_until_the_chart_takes_its_place(visit, held, width):
    with visit(held, viewport={"width": width, "height": 900}) as found:
        scroll_to(found, "differences")
        found.wait_for("(window.held || []).length === 2")
        assert seen(found, "differences") == TWIN
        before = found.page.evaluate(PLACES)
        found.page.evaluate("release()")
        for name in ("differences", "responses"):
            found.show(name)
            assert seen(found, name) == CHART
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


def test_print_shows_the_static_figure_while_the_chart_waits_and_after(visit, held):
    with visit(held) as found:
        found.wait_for("(window.held || []).length > 0")
        found.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        found.wait_for("[...document.images].every(image => image.complete)")
        image = found.page.locator("#figure-differences img")
        natural = image.evaluate("image => image.naturalWidth / image.naturalHeight")
        for drawn in (False, True):
            if drawn:
                found.page.evaluate("release()")
                found.show("differences")
            found.page.emulate_media(media="print")
            assert seen(found, "differences") == TWIN
            assert found.page.locator("button:visible, .plot:visible").count() == 0
            shown = image.evaluate("image => image.clientWidth / image.clientHeight")
            assert shown == pytest.approx(natural, rel=0.01)
            found.page.emulate_media(media="screen")
        assert seen(found, "differences") == CHART


@pytest.mark.parametrize("missing", ["differences.js", "responses.js", "plotly*.js", "report.js"])
def test_what_is_missing_leaves_the_static_figures(visit, copied, missing):
    """Of one figure where its data are missing, of all where a script is."""
    for file in copied.parent.glob(f"plots/{missing}"):
        file.unlink()
    names = {"differences", "responses"}
    lost = {missing.removesuffix(".js")} & names or names
    with visit(copied) as found:
        for name in names - lost:
            found.show(name)
            assert seen(found, name) == CHART
        for name in lost:
            scroll_to(found, name)
            found.wait_for(f"!document.querySelector('#figure-{name} .plot').checkVisibility()")
            assert seen(found, name) == TWIN
            assert found.page.locator(f"#figure-{name} img:not([aria-hidden])").count() == 1
            assert found.page.locator(f"#figure-{name} button:visible").count() == 0


def test_without_scripts_the_static_figures_have_their_own_shape(visit, report):
    with visit(report, java_script_enabled=False) as found:
        for image in found.page.locator("figure img").all():
            image.evaluate("element => element.scrollIntoView()")
            assert image.is_visible()
            box, natural = image.bounding_box(), image.evaluate("image => image.naturalWidth / image.naturalHeight")
            padding = 20.0
            assert (box["width"] - padding) / (box["height"] - padding) == pytest.approx(natural, rel=0.02)
        assert found.page.locator(".plot:visible").count() == 0


def test_one_of_both_is_read_aloud(visit, held):
    """The chart carries the words of its figure; the picture beneath it is not named a second time."""
    with visit(held) as found:
        found.wait_for("(window.held || []).length > 0")
        words = found.page.locator("#plot-differences").get_attribute("aria-label")
        assert found.page.get_by_role("img", name=words).count() == 0
        assert found.page.get_by_role("group", name=words).count() == 1


def test_plotly_has_what_reports_draw_and_no_more(visit, report):
    """By its own list of the kinds of traces that it can draw."""
    with visit(report) as found:
        found.show("differences")
        kinds = found.page.evaluate("Object.keys(Plotly.PlotSchema.get().traces)")
        assert sorted(kinds) == ["bar", "scatter"]


def test_the_first_figures_do_not_wait_and_all_have_a_size(report):
    images = re.findall(r"<img [^>]*>", report.read_text(encoding="utf-8"))
    assert ["lazy" in image for image in images] == [False, True]
    assert all(re.search(r' width="\d+" height="\d+"', image) for image in images)


def test_the_page_is_light_or_dark_before_anything_is_painted(report):
    """Its own script is the only one that the page waits for; plotly's and the data come beside and after it."""
    scripts = re.findall(r"<script ([^>]*)></script>", report.read_text(encoding="utf-8"))
    assert [("defer" in script, re.search(r'src="plots/(\w+)', script).group(1)) for script in scripts] == [
        (False, "report"),
        (True, "differences"),
        (True, "plotly"),
    ]
