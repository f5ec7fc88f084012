"""The report in a real browser, opened from the disk: what is drawn, moved, printed, and that nothing leaves."""

import itertools
import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from shaftprint.report import _render as render_module
from shaftprint.report import render_report, sections
from shaftprint.validation import ValidationSettings, validate

pytestmark = pytest.mark.slow


SECTIONS = ("fit", "stability", "validation", "quality", "uncertainty", "time")
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
    made = [getattr(sections, f"{name}_section") for name in SECTIONS]

    def chosen(inputs):
        groups = [make(inputs) for make in made]
        return [section for group in groups for section in (group if isinstance(group, list) else [group])]

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


def test_charts_are_drawn_once(opened):
    """plotly draws a chart again when its labels need more room than its margins have."""
    for name in PLOTS:
        opened.show(name)
        given, taken = opened.page.evaluate(
            f"(full => [full.margin.l, full._size.l])(document.getElementById('plot-{name}')._fullLayout)"
        )
        assert taken == given, name


def test_the_bode_diagram_has_model_band_data_and_bars(opened, identification):
    """Four panels: a line and a band in each, every used line as a point with an error bar, 14 of 16 used."""
    opened.show("fit")
    count = "selector => document.querySelectorAll('#plot-fit ' + selector).length"
    assert opened.page.evaluate(count, ".scatterlayer .lines .js-line") >= 4
    assert opened.page.evaluate(count, ".fills .js-fill") == 4
    used = int(identification.response.used.sum())
    assert opened.page.evaluate(count, ".scatterlayer .points .point") == 4 * identification.response.used.size
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
    assert opened.axis("fit", "xaxis4") == pytest.approx(opened.axis("fit"))
    mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    opened.wait_for(f"Math.abs(document.getElementById('plot-fit')._fullLayout.xaxis.range[0] - {before[0]}) < 1e-6")


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
    opened.wait_for("document.querySelectorAll('figure.has-plot').length > 0")
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
    assert names[names.index("plot-fit") - 1] == "Show all"
    reached = list(dict.fromkeys(name for name in names if name.startswith("plot-")))
    assert reached[:3] == ["plot-fit", "plot-residuals", "plot-validation_st1_step_208"]


def test_the_first_screen_holds_the_verdict(opened, fingerprint):
    """Above the fold of a small notebook: headline, date and place, the sketch of the line, the first two rows."""
    for selector in (".verdict", ".about", ".cards li:nth-child(6)"):
        box = opened.page.locator(selector).bounding_box()
        assert box["y"] + box["height"] <= 900, selector
    words = opened.page.locator("#found").inner_text()
    assert "The test can be used" in words
    assert "Does the engine hold its speed without hunting?" in words
    assert "Inertia behind the torque gauge" in words


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
    """plotly's menu has no upload, and its settings name no server."""
    place = opened.show("fit")
    place.hover()
    titles = opened.page.eval_on_selector_all(
        ".modebar-btn", "buttons => buttons.map(b => b.getAttribute('data-title') || b.getAttribute('aria-label'))"
    )
    assert "Zoom" in " ".join(titles)
    assert not [title for title in titles if re.search("share|cloud|upload|edit", title, re.IGNORECASE)]
    settings = opened.page.evaluate(
        "(c => [c.showSendToCloud, c.plotlyServerURL])(document.getElementById('plot-fit')._context)"
    )
    assert settings == [False, ""]
    assert opened.page.locator("a[href^=http]").count() == 0


def test_a_chart_can_be_saved_without_a_network(opened):
    place = opened.show("step")
    place.hover()
    with opened.page.expect_download() as saved:
        place.locator(".modebar-btn").first.click()
    assert saved.value.suggested_filename == "step.svg"
    assert "<svg" in saved.value.path().read_text(encoding="utf-8")[:300]


def test_far_plots_wait_until_they_are_near(opened):
    opened.wait_for("document.getElementById('plot-fit').dataset.state === 'drawn'")
    drawn = opened.page.evaluate("document.querySelectorAll('[data-state=drawn]').length")
    assert drawn < len(PLOTS)
    assert not any("staircase.js" in address for address in opened.requests)


def test_print_has_the_static_figures_and_no_buttons(opened, tmp_path):
    opened.wait_for("[...document.images].every(picture => picture.complete && picture.naturalWidth > 0)")
    opened.page.emulate_media(media="print", color_scheme="light")
    visible = "list => list.filter(e => e.getBoundingClientRect().height > 0).length"
    assert opened.page.eval_on_selector_all(".plot, button, nav", visible) == 0
    images = opened.page.locator("img").count()
    assert opened.page.eval_on_selector_all("img", visible) == images >= len(PLOTS)
    pdf = opened.page.pdf(format="A4")
    (tmp_path / "report.pdf").write_bytes(pdf)
    assert pdf.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", pdf)) >= 5


def test_without_scripts_the_figures_and_words_are_there(visit, report):
    with visit(report, java_script_enabled=False) as found:
        assert found.page.locator("#look").is_hidden()
        for image in itertools.islice(found.page.locator("img").all(), 4):
            image.evaluate("element => element.scrollIntoView()")
            assert image.is_visible()
            assert image.bounding_box()["height"] > 100
        assert found.page.locator(".plot:visible").count() == 0
        assert found.page.locator("#found h2").is_visible()


def test_a_missing_file_of_data_leaves_the_static_figure(visit, report, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(report.parent, copy)
    (copy / "plots" / "fit.js").unlink()
    with visit(copy / report.name) as found:
        found.wait_for("!document.getElementById('figure-fit').classList.contains('has-plot')")
        assert found.page.locator("#figure-fit img").is_visible()


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


def test_on_a_narrow_screen_numbers_stand_beside_the_panel_to_their_left(visit, report):
    with visit(report, viewport={"width": 390, "height": 900}) as found:
        found.show("fit")
        apart = found.page.evaluate(
            "(() => { const chart = document.getElementById('plot-fit');"
            " const right = [...chart.querySelectorAll('.ytick text, .y2tick text, .y3tick text, .y4tick text')]"
            " .map(number => number.getBoundingClientRect())"
            " .filter(box => box.left > chart.getBoundingClientRect().left + 150);"
            " const panel = chart._fullLayout.xaxis; const start = chart.getBoundingClientRect().left;"
            " const end = start + panel._offset + panel._length;"
            " return [right.length, Math.min(...right.map(box => box.left - end))]; })()"
        )
        assert apart[0] >= 4
        assert apart[1] >= 0.0
