"""The report in a real browser, opened from the disk: what is drawn, moved, printed, and that nothing leaves."""

import itertools
import re
import shutil
import subprocess
import zlib
from dataclasses import replace

import numpy as np
import pytest
from tests.conftest import CHROMIUM

from shaftprint.report import _render as render_module
from shaftprint.report import render_report
from shaftprint.report.sections._engineer import budget_section
from shaftprint.report.sections._measurement import time_section
from shaftprint.report.sections._quality import quality_section
from shaftprint.report.sections._results import fit_section, stability_section, summary_section
from shaftprint.report.sections._uncertainty import uncertainty_section
from shaftprint.report.sections._validation import validation_section
from shaftprint.validation import ValidationSettings, validate

pytestmark = pytest.mark.slow


SECTIONS = (
    fit_section,
    budget_section,
    summary_section,
    stability_section,
    validation_section,
    quality_section,
    uncertainty_section,
    time_section,
)
FOLDED = ("time",)
PLOTS = (
    "fit",
    "residuals",
    "step",
    "nyquist",
    "validation_st1_staircase_210",
    "signal_to_noise",
    "budget",
    "profiles",
    "staircase",
)


@pytest.fixture(scope="module")
def report(browser, tmp_path_factory, survey, identification, signals, campaign):
    settings = ValidationSettings(rest_s=6.0, zoom_after_s=8.0)
    rng = np.random.default_rng(1)
    validation = validate(identification, signals, campaign, rng=rng, records=("St1",), settings=settings)

    def chosen(inputs):
        groups = [make(inputs) for make in SECTIONS]
        listed = [section for group in groups for section in (group if isinstance(group, list) else [group])]
        return [replace(section, folded=section.key in FOLDED) for section in listed]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(render_module, "page_sections", chosen)
        return render_report(
            tmp_path_factory.mktemp("browser") / "report",
            replace(survey, validations=(validation,)),
        )


@pytest.fixture
def opened(visit, report):
    with visit(report) as found:
        yield found


def test_every_plot_is_drawn_with_finite_curves_and_nothing_leaves(opened):
    for name in PLOTS:
        opened.show(name)
        shapes = opened.page.eval_on_selector_all(
            f"#plot-{name} .js-line, #plot-{name} .point path, #plot-{name} path.point",
            "paths => paths.map(path => path.getAttribute('d'))",
        )
        assert shapes, name
        assert not [shape for shape in shapes if not shape or re.search("NaN|undefined|Infinity", shape)], name
    assert opened.messages == []
    assert opened.requests
    assert [address for address in opened.requests if not address.startswith("file:///")] == []


def test_charts_have_the_room_that_they_take(opened):
    """Each is drawn once, as wide and as high as the page keeps room for it."""
    for name in PLOTS:
        place = opened.show(name)
        box = place.bounding_box()
        inner = opened.page.locator(f"#plot-{name} .main-svg").first.bounding_box()
        assert (inner["width"], inner["height"]) == pytest.approx((box["width"], box["height"]), abs=1.0), name


def test_a_folded_chart_is_drawn_when_its_section_is_opened(opened):
    opened.show("fit")
    state = "document.getElementById('plot-staircase').dataset.state"
    opened.page.locator("details summary").last.scroll_into_view_if_needed()
    opened.page.wait_for_timeout(300)
    assert opened.page.evaluate(state) != "drawn"
    opened.page.locator("details summary").last.click()
    opened.page.locator("#plot-staircase").scroll_into_view_if_needed()
    opened.wait_for(f"{state} === 'drawn'")


def test_no_letter_of_a_chart_is_smaller_than_eleven_px(opened):
    for name in PLOTS:
        opened.show(name)
    sizes = opened.page.eval_on_selector_all(
        ".plot text", "texts => texts.filter(t => t.textContent).map(t => parseFloat(getComputedStyle(t).fontSize))"
    )
    assert min(sizes) >= 11.0


# Texts of a chart that stand on each other or leave it; names that stand slanted overlap as boxes, not as letters.
OVERLAPS = """() => [...document.querySelectorAll('.plot[data-state=drawn]')].flatMap((place) => {
  const frame = place.getBoundingClientRect();
  const texts = [...place.querySelectorAll('text')].filter((text) => text.textContent.trim()
    && !/rotate\\((?!-?(90|0|180)\\b)/.test(text.getAttribute('transform') || ''));
  const boxes = texts.map((text) => [text.textContent, text.getBoundingClientRect()])
    .filter(([, box]) => box.width > 0);
  const outside = boxes.filter(([, box]) => box.left < frame.left - 1 || box.right > frame.right + 1
    || box.top < frame.top - 1 || box.bottom > frame.bottom + 1).map(([words]) => `${place.id}: ${words} leaves`);
  const pairs = boxes.flatMap(([words, a], index) => boxes.slice(index + 1).filter(([, b]) =>
    Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1
    && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 2)
    .map(([others]) => `${place.id}: ${words} on ${others}`));
  return [...outside, ...pairs];
})"""


@pytest.mark.parametrize("width", [390, 1280])
def test_no_words_of_a_chart_stand_on_others(visit, report, width):
    with visit(report, viewport={"width": width, "height": 900}) as found:
        names = found.page.eval_on_selector_all(".plot", "list => list.map(e => e.dataset.plot)")
        for name in names:
            found.show(name)
        assert len(names) >= len(PLOTS)
        assert found.page.evaluate(OVERLAPS) == []


def test_the_bode_diagram_has_model_band_data_and_bars(opened, identification):
    """Four panels: a line and a band in each, every used line as a point with an error bar, 14 of 16 used.

    Two more below them: band and residuals along and across the response, and where 95 % of these should be.
    """
    opened.show("fit")
    used = int(identification.response.used.sum())
    count = "selector => document.querySelectorAll('#plot-fit ' + selector).length"
    assert opened.page.evaluate(count, ".scatterlayer .lines .js-line") >= 4
    assert opened.page.evaluate(count, ".fills .js-fill") == 4 + 2 * 3
    assert (
        opened.page.evaluate(count, ".scatterlayer .points .point") == 4 * identification.response.used.size + 4 * used
    )
    assert opened.page.evaluate(count, ".errorbars .errorbar") >= 4 * used


def test_drawn_data_are_the_measured_ones(opened, identification):
    """20 log10 |H| of the response, by hand."""
    opened.show("fit")
    drawn = opened.page.evaluate(
        "document.getElementById('plot-fit').data.filter(t => t.mode === 'markers' && t.xaxis === 'x')[0].y"
    )
    response = identification.response
    expected = 20.0 * np.log10(np.abs(response.response[0, 0, response.used]))
    assert drawn == pytest.approx(expected.tolist(), rel=1e-5, abs=1e-9)


def test_dragging_zooms_all_panels_and_a_double_click_shows_all(opened):
    place = opened.show("fit")
    before = opened.axis("fit")
    box = place.locator(".drag.nsewdrag").first.bounding_box()
    mouse = opened.page.mouse
    mouse.move(box["x"] + 0.25 * box["width"], box["y"] + 0.2 * box["height"])
    mouse.down()
    mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.8 * box["height"], steps=6)
    mouse.up()
    opened.wait_for(f"document.getElementById('plot-fit')._fullLayout.xaxis.range[0] > {before[0] + 0.01}")
    width = before[1] - before[0]
    assert opened.axis("fit") == pytest.approx([before[0] + 0.25 * width, before[0] + 0.5 * width], abs=0.02 * width)
    assert opened.axis("fit", "xaxis6") == pytest.approx(opened.axis("fit"))
    mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    opened.wait_for(f"Math.abs(document.getElementById('plot-fit')._fullLayout.xaxis.range[0] - {before[0]}) < 1e-6")


def test_a_cursor_stands_at_one_frequency_in_all_charts_over_frequency(opened):
    """The middle of the first panel, 1 : 1 in its other row and column, and at the same place of the residuals."""
    opened.show("residuals")
    place = opened.show("fit")
    box = place.locator(".drag.nsewdrag").first.bounding_box()
    opened.page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    opened.wait_for("document.querySelectorAll('#plot-residuals .cursor').length === 2")
    assert opened.page.locator("#plot-fit .cursor").count() == 6
    low, high = opened.axis("fit")
    first, last = opened.axis("residuals")
    wanted = (low + 0.4 * (high - low) - first) / (last - first)
    share = opened.page.evaluate(
        "(p => (p.querySelector('.cursor').offsetLeft - p._fullLayout.xaxis._offset) / p._fullLayout.xaxis._length)"
        "(document.getElementById('plot-residuals'))"
    )
    assert share == pytest.approx(wanted, abs=0.01)
    opened.page.mouse.move(2, 2)
    opened.wait_for("document.querySelectorAll('.cursor').length === 0")


def test_the_keyboard_moves_and_zooms(opened):
    place = opened.show("validation_st1_staircase_210")
    name = "validation_st1_staircase_210"
    low, high = opened.axis(name)
    place.focus()
    opened.page.keyboard.press("+")
    opened.page.wait_for_timeout(200)
    inner = opened.axis(name)
    assert inner[1] - inner[0] == pytest.approx(0.6 * (high - low))
    assert sum(inner) == pytest.approx(low + high)
    opened.page.keyboard.press("ArrowRight")
    opened.page.wait_for_timeout(200)
    moved = opened.axis(name)
    assert moved[0] - inner[0] == pytest.approx(0.15 * (inner[1] - inner[0]))
    opened.page.keyboard.press("0")
    opened.page.wait_for_timeout(200)
    assert opened.axis(name) == pytest.approx([low, high])


def test_tab_goes_from_the_skip_link_through_the_page_in_its_order(opened):
    opened.wait_for("document.querySelectorAll('.bar').length > 0")
    where = (
        "[document.activeElement.tagName, document.activeElement.id || document.activeElement.textContent.trim(),"
        " document.activeElement.getBoundingClientRect().top + window.scrollY]"
    )
    seen = []
    for _ in range(60):
        opened.page.keyboard.press("Tab")
        seen.append(opened.page.evaluate(where))
    assert seen[0][1] == "Skip to the content"
    assert seen[1][1] == "look"
    names = [name for _, name, _ in seen]
    assert "plot-fit" in names
    reached = list(dict.fromkeys(name for name in names if name.startswith("plot-")))
    assert reached[:3] == ["plot-fit", "plot-validation_st1_step_208", "plot-budget"]


def test_the_first_screen_holds_the_verdict(opened, fingerprint):
    """Above the fold of a small notebook: headline, date and place, the sketch of the line, the first two rows."""
    for selector in (".verdict", ".about", ".cards li:nth-child(6)"):
        box = opened.page.locator(selector).bounding_box()
        assert box["y"] + box["height"] <= 900, selector
    words = opened.page.locator("#found").inner_text()
    assert "The test can be used" in words
    assert "Does the engine hold its speed without hunting?" in words
    assert "Inertia behind the gauge" in words


def contrast(opened, selector):
    """Return the contrast of text with the page by the WCAG's formula, (L1 + 0.05) / (L2 + 0.05)."""
    colours = opened.page.evaluate(
        f"[getComputedStyle(document.querySelector('{selector}')).color,"
        " getComputedStyle(document.body).backgroundColor]"
    )
    light = []
    for colour in colours:
        channels = np.array([float(part) for part in re.findall(r"[\d.]+", colour)[:3]]) / 255.0
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        light.append(float(linear @ [0.2126, 0.7152, 0.0722]))
    return (max(light) + 0.05) / (min(light) + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_both_looks_follow_the_screen_and_can_be_read(visit, report, scheme):
    with visit(report, color_scheme=scheme) as found:
        shade = found.page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert shade == {"light": "rgb(255, 255, 255)", "dark": "rgb(21, 25, 28)"}[scheme]
        for selector in ("p", "nav a", ".state-fine .state", ".state-look .state, .state-open .state, .state"):
            assert contrast(found, selector) >= 4.5, selector


def test_the_switch_changes_the_page_and_its_plots(opened):
    opened.show("fit")
    line = "getComputedStyle(document.querySelector('#plot-fit .js-line')).stroke"
    before = opened.page.evaluate(line)
    opened.page.locator("#look").click()
    opened.wait_for(f"{line} !== '{before}'")
    assert opened.page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(21, 25, 28)"
    assert opened.page.locator("#look").inner_text() == "Light look"
    assert opened.messages == []


def test_no_button_shares_a_chart(opened):
    """One row of buttons, the page's own, has no upload, and plotly's settings name no server."""
    place = opened.show("fit")
    place.hover()
    assert opened.page.locator(".modebar-btn").count() == 0
    titles = opened.page.eval_on_selector_all(
        "#figure-fit button", "buttons => buttons.map(b => b.getAttribute('aria-label'))"
    )
    assert titles == [
        "Zoom in",
        "Zoom out",
        "Move left",
        "Move right",
        "Show all again",
        "Save the chart as SVG",
    ]
    settings = opened.page.evaluate(
        "(c => [c.showSendToCloud, c.plotlyServerURL])(document.getElementById('plot-fit')._context)"
    )
    assert settings == [False, ""]
    assert opened.page.locator("a[href^=http]").count() == 0


def test_a_chart_can_be_saved_without_a_network(opened):
    opened.show("step")
    with opened.page.expect_download() as saved:
        opened.page.locator("#figure-step button").last.click()
    assert saved.value.suggested_filename == "step.svg"
    assert "<svg" in saved.value.path().read_text(encoding="utf-8")[:300]


def test_far_charts_wait_until_they_are_near(opened):
    opened.wait_for("document.getElementById('plot-fit').dataset.state === 'drawn'")
    assert opened.page.evaluate("document.querySelectorAll('[data-state=drawn]').length") < len(PLOTS)


@pytest.mark.parametrize("scheme", [pytest.param("light", marks=pytest.mark.long), "dark"])
def test_print_has_every_chart_in_light_colours_and_no_buttons(visit, report, tmp_path, scheme):
    """Charts that were never near the screen too: all of them are drawn before the page is printed."""
    with visit(report, color_scheme=scheme) as found:
        found.wait_for("document.getElementById('plot-fit').dataset.state === 'drawn'")
        found.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        drawn = found.page.eval_on_selector_all(".plot[data-state=drawn]", "list => list.map(e => e.dataset.plot)")
        assert drawn == found.page.eval_on_selector_all(
            "section > figure .plot", "list => list.map(e => e.dataset.plot)"
        )
        assert set(PLOTS) - set(drawn) == {"staircase"}
        found.page.emulate_media(media="print", color_scheme="light")
        visible = "list => list.filter(e => e.getBoundingClientRect().height > 0).length"
        assert found.page.eval_on_selector_all("button, nav, .instead", visible) == 0
        assert found.page.eval_on_selector_all(".plot", visible) == len(drawn) >= len(PLOTS) - 1
        ink = "getComputedStyle(document.querySelector('#plot-fit .js-line')).stroke"
        assert found.page.evaluate(ink) == "rgb(0, 63, 107)"
        pdf = found.page.pdf(format="A4")
        (tmp_path / "report.pdf").write_bytes(pdf)
        assert pdf.startswith(b"%PDF")
        assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 5


@pytest.mark.usefixtures("browser")
def test_a_print_without_a_reader_has_every_chart(report, tmp_path):
    """Printed as soon as the page is loaded, it has the lines of a print before which it had seconds to rest."""

    def printed(*options):
        file = tmp_path / f"{len(options)}.pdf"
        words = ["--headless", "--no-sandbox", "--disable-gpu", *options, f"--print-to-pdf={file}", report.as_uri()]
        subprocess.run([CHROMIUM, *words], check=True, capture_output=True, timeout=120, cwd=tmp_path)
        streams = re.findall(rb"FlateDecode[^>]*>>\s*stream\r?\n(.*?)endstream", file.read_bytes(), re.DOTALL)
        pages = [zlib.decompressobj().decompress(stream) for stream in streams]
        return sum(len(re.findall(rb"(?m)[ \n][mlc]$", page)) for page in pages)

    at_once, rested = printed(), printed("--virtual-time-budget=20000")
    assert rested > 1000
    assert at_once == rested


def test_the_printed_report_is_small_and_its_bars_keep_their_textures(visit, report):
    """Patterns became bitmaps as large as the bars: 5 to 14 MB for a report."""
    with visit(report) as found:
        found.show("budget")
        patterned = "list => list.filter(e => e.style.fill.startsWith('url')).length"
        assert found.page.eval_on_selector_all("#plot-budget .pattern_filled", patterned) > 0
        pdf = found.page.pdf(format="A4")
        found.wait_for("document.querySelectorAll('#plot-budget .texture').length === 0")
        assert len(pdf) < 2e6
        assert len(re.findall(rb"/FontFile2", pdf)) > 0, "resources of the file are readable"
        assert re.findall(rb"/Subtype\s*/Image|/PatternType", pdf) == []
        found.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        textures = found.page.evaluate(
            "[...document.querySelectorAll('#plot-budget .legendpoints')]"
            ".map(e => e.querySelector('.texture g g')?.innerHTML ?? '')"
        )
        assert len(set(textures)) == len(textures) > 3
        assert found.messages == []


def test_on_a_phone_bars_keep_half_of_the_width_beside_their_names(visit, report):
    """``governor proportional action`` in one line left them a third."""
    with visit(report, viewport={"width": 390, "height": 844}) as found:
        found.show("budget")
        wide = found.page.evaluate("document.getElementById('plot-budget')._fullLayout.xaxis._length")
        assert wide > 0.48 * 390 - 32


def test_words_of_a_wide_table_are_no_stripe_on_paper(visit, report):
    with visit(report) as found:
        found.page.set_viewport_size({"width": 688, "height": 900})
        found.page.emulate_media(media="print")
        cells = "table:has(thead th:nth-child(8)) tbody tr:first-child > td:last-child:not(.number)"
        widths = found.page.eval_on_selector_all(cells, "list => list.map(e => e.getBoundingClientRect().width)")
        assert widths
        assert min(widths) > 120.0
        right = "list => list.map(e => e.getBoundingClientRect().right)"
        assert max(found.page.eval_on_selector_all("table:has(thead th:nth-child(8))", right)) < 690.0


def test_a_chart_is_no_wider_than_the_paper(visit, report):
    with visit(report) as found:
        found.show("fit")
        found.page.set_viewport_size({"width": 700, "height": 900})
        found.page.emulate_media(media="print")
        sizes = found.page.evaluate(
            "(box => [box.right, document.body.getBoundingClientRect().right])"
            "(document.querySelector('#plot-fit .main-svg').getBoundingClientRect())"
        )
        assert sizes[0] <= sizes[1] + 1.0


def test_without_scripts_words_stand_in_place_of_charts(visit, report):
    with visit(report, java_script_enabled=False) as found:
        assert found.page.locator("#look").is_hidden()
        words = found.page.locator("#figure-fit .instead")
        words.evaluate("element => element.scrollIntoView()")
        assert words.is_visible()
        assert "--figures" in words.inner_text()
        assert found.page.locator(".plot:visible").count() == 0
        assert found.page.locator("#found h2").is_visible()


@pytest.mark.parametrize("missing", ["fit.js", "plotly*.js", "charts.js"])
def test_where_a_file_is_missing_words_stand_in_place_of_the_chart(visit, report, tmp_path, missing):
    copy = tmp_path / "copy"
    shutil.copytree(report.parent, copy)
    for file in (copy / "plots").glob(missing):
        file.unlink()
    with visit(copy / report.name) as found:
        found.wait_for("document.querySelector('#figure-fit .instead').getBoundingClientRect().height > 0")
        assert found.page.locator("#figure-fit .plot").is_hidden()
        assert found.page.locator("#figure-fit button:visible").count() == 0


def test_headings_tables_and_images_have_names(opened):
    found = opened.page.evaluate(
        "({h1: document.querySelectorAll('h1').length,"
        " levels: [...document.querySelectorAll('h1,h2,h3')].map(h => Number(h.tagName[1])),"
        " unnamed: [...document.querySelectorAll('img:not([alt]), button:not([aria-label]):not(#look),"
        " table:not(:has(caption)), .plot:not([aria-label])')].length,"
        " lang: document.documentElement.lang})"
    )
    assert found["h1"] == 1
    assert found["lang"] == "en"
    assert found["unnamed"] == 0
    assert max(after - before for before, after in itertools.pairwise(found["levels"])) <= 1


@pytest.mark.parametrize("width", [390, 1700])
def test_narrow_and_wide_screens_need_no_scrolling_sideways(visit, report, width):
    with visit(report, viewport={"width": width, "height": 900}) as found:
        found.wait_for("document.getElementById('plot-fit').dataset.state === 'drawn'")
        assert found.page.evaluate("document.documentElement.scrollWidth") <= width


def test_on_a_phone_all_panels_stand_below_each_other(visit, report):
    with visit(report, viewport={"width": 390, "height": 900}) as found:
        found.show("fit")
        tops = found.page.eval_on_selector_all(
            "#plot-fit .nsewdrag",
            "panels => panels.map(p => [p.getBoundingClientRect().top, p.getBoundingClientRect().left])",
        )
        assert len(tops) == 6
        assert len({round(top) for top, _ in tops}) == 6
        assert max(left for _, left in tops) - min(left for _, left in tops) < 2.0
