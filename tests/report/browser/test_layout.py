"""How three reports lie on a screen, a phone and on paper: nothing too wide, too small, too pale or over another.

The reports are those of the demo, of a recording whose fit is refused, and of a structure of one's own with long names.
"""

import re

import numpy as np
import pytest

from shaftprint.catalogue import ShipRole, structure
from shaftprint.models import Parameter, RationalBlock, Structure
from shaftprint.report import render_report
from shaftprint.survey import run

pytestmark = pytest.mark.slow

SMALLEST_TEXT_PX = 11.0
# WCAG 2.1, level AA, for text of any size
LEAST_CONTRAST = 4.5
# what is folded left out; a structure of one's own has long names
MOST_SHEETS = {"demo": 6, "refused": 7, "own": 8}
# Printing is tried at the width that A4 leaves between its margins, 182 mm.
MEDIA = [(1280, "light"), (390, "dark"), (688, "print"), (1280, "dark"), (390, "light")]
REPORTS = ("demo", "refused", "own")
# opening one with all its charts takes twelve seconds of a processor: each report and each medium has its turn often
OFTEN = {
    *(("demo", 1280, "light"), ("demo", 390, "dark"), ("demo", 688, "print")),
    *(("refused", 390, "dark"), ("own", 688, "print")),
}
OPEN_ALL = "document.querySelectorAll('details').forEach(part => { part.open = true; })"
CHARTS = "[...document.querySelectorAll('.plot')].filter(chart => chart.checkVisibility()).map(chart => chart.id)"
SEEN = """const seen = element => element.checkVisibility({visibilityProperty: true, opacityProperty: true})
    && !element.closest('.skip');
"""

TOO_WIDE = f"""() => {{ {SEEN}
  const most = document.documentElement.clientWidth + 1;
  return [...document.querySelectorAll('body *')].filter(element => seen(element) && !element.closest('svg'))
    .filter(element => {{
      const box = element.getBoundingClientRect();
      const scrolls = element.matches('.wide') && element.scrollWidth > element.clientWidth + 1;
      return box.width > 0 && (box.right > most || box.left < -1 || scrolls);
    }})
    .map(element => `${{element.tagName}} ${{element.className}} ${{element.textContent.trim().slice(0, 60)}}`);
}}"""

# Text nodes with the size and the colours that they have on the page; indices of symbols are smaller on purpose.
TEXTS = f"""() => {{ {SEEN}
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const told = [];
  while (texts.nextNode()) {{
    const parent = texts.currentNode.parentElement;
    const text = texts.currentNode.textContent.replaceAll('\\u200b', '').trim();
    if (!text || parent.closest('script, style') || !seen(parent)) continue;
    const style = getComputedStyle(parent), drawing = parent.closest('svg[viewBox]');
    const scale = drawing ? drawing.getBoundingClientRect().width / drawing.viewBox.baseVal.width : 1;
    let ground = parent, opacity = 1;
    for (let around = parent; around; around = around.parentElement) opacity *= getComputedStyle(around).opacity;
    while (ground && getComputedStyle(ground).backgroundColor === 'rgba(0, 0, 0, 0)') ground = ground.parentElement;
    // a number in a coloured field stands on the field
    const field = parent.closest('.bartext') && parent.closest('.point').querySelector('path');
    const behind = ground ? getComputedStyle(ground).backgroundColor : 'rgb(255, 255, 255)';
    told.push({{
      text: text.slice(0, 40),
      size: scale * parseFloat(style.fontSize),
      index: parent.closest('sub, tspan') !== null,
      opacity,
      ink: parent instanceof SVGElement ? style.fill : style.color,
      ground: field ? getComputedStyle(field).fill : behind,
    }});
  }}
  return told;
}}"""

# Words of a chart that stand over each other or go beyond its edge; the box of slanted words tells neither.
CROWDED = """() => [...document.querySelectorAll('.plot')].filter(chart => chart.checkVisibility()).flatMap(chart => {
  const edge = chart.getBoundingClientRect();
  const isSlanted = text => /rotate\\(/.test(text.getAttribute('transform'))
    && Number(text.getAttribute('transform').match(/rotate\\(([-\\d.]+)/)[1]) % 90 !== 0;
  const words = [...chart.querySelectorAll('text')]
    .filter(text => !isSlanted(text))
    .filter(text => text.textContent.trim() && text.checkVisibility({visibilityProperty: true, opacityProperty: true}))
    .map(text => [text.textContent, text.getBoundingClientRect()]).filter(([, box]) => box.width > 0);
  const beyond = words.filter(([, box]) => box.left < edge.left - 2 || box.right > edge.right + 2
    || box.top < edge.top - 2 || box.bottom > edge.bottom + 2).map(([text]) => [chart.id, 'beyond', text]);
  const pairs = words.flatMap(([first, a], place) => words.slice(place + 1)
    .filter(([, b]) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 2
      && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 4)
    .map(([second]) => [chart.id, first, second]));
  return [...beyond, ...pairs];
})"""

# Blocks that stand beside or below each other, as pairs that share ground; what lies inside another is no overlap.
OVERLAPS = f"""() => {{ {SEEN}
  const blocks = [...document.querySelectorAll(
    'header, nav, .verdict, dl, .sketch, .cards li, .wide, main h2, main p, summary, figure, figcaption, footer > p')]
    .filter(seen).map(element => [element, element.getBoundingClientRect()]);
  const pairs = [];
  for (const [i, [first, a]] of blocks.entries()) for (const [second, b] of blocks.slice(i + 1)) {{
    if (first.contains(second) || second.contains(first)) continue;
    const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    if (wide > 1 && high > 1) pairs.push([first, second].map(element => element.textContent.trim().slice(0, 40)));
  }}
  return pairs;
}}"""


def own_core():
    """Inertia and slope behind the gauge, under names as long as those of a user, one with its role."""
    downstream = ShipRole.INERTIA_DOWNSTREAM
    inertia = Parameter(
        "inertia_of_all_that_turns", "s", 0.01, 5.0, 1.0, "inertia time behind the gauge", role=downstream
    )
    slope = Parameter("slope", "-", 0.1, 5.0, 2.0, "slope of the propeller torque")
    block = RationalBlock(lambda inertia, slope: ([1.0], [inertia, slope]), (inertia, slope))
    return Structure(name="MY-OWN-CORE-OF-THE-LINE", title="what the gauge sees", input="M_s", outputs={"n": block})


@pytest.fixture(scope="module")
def pages(browser, demo, tmp_path_factory):
    """Pages by name: the demo's, that of a refused fit, and that of an own structure."""
    folder = demo[0]
    surveys = {"refused": structure("CL4"), "own": own_core()}
    made = {"demo": folder / "index.html"}
    for name, model in surveys.items():
        result = run(folder / "recording.nc", folder / "vessel.toml", folder / "campaign.toml", structures=(model,))
        assert name == "own" or not result.fingerprint.verdict.trustworthy
        made[name] = render_report(tmp_path_factory.mktemp("layout") / name, result)
    return made


@pytest.fixture(
    params=[
        pytest.param(case, marks=() if case in OFTEN else pytest.mark.long)
        for case in ((name, *media) for name in REPORTS for media in MEDIA)
    ],
    ids=str,
)
def opened(request, visit, pages):
    """A page of one of the reports with all its sections open and all its charts drawn, on a screen or on paper."""
    name, width, scheme = request.param
    looks = {} if scheme == "print" else {"color_scheme": scheme}
    with visit(pages[name], viewport={"width": width, "height": 900}, **looks) as found:
        found.page.evaluate(OPEN_ALL)
        for chart in found.page.evaluate(CHARTS):
            found.show(chart.removeprefix("plot-"))
        found.page.evaluate("window.scrollTo(0, 0)")
        if scheme == "print":
            found.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
            found.page.emulate_media(media="print")
        yield found


def channels(colour):
    return np.array([float(part) for part in re.findall(r"[\d.]+", colour)[:3]]) / 255.0


def brightness(colour):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour]
    return float(np.array(linear) @ [0.2126, 0.7152, 0.0722])


def contrast(text):
    """Return the contrast of a text by the WCAG's formula, (L1 + 0.05) / (L2 + 0.05)."""
    ground = channels(text["ground"])
    ink = ground + text["opacity"] * (channels(text["ink"]) - ground)
    dark, light = sorted((brightness(ink), brightness(ground)))
    return (light + 0.05) / (dark + 0.05)


def flaws(opened):
    """Return what is wrong with how a page lies, by kind; nothing where all is well."""
    texts = opened.page.evaluate(TEXTS)
    assert len(texts) > 100
    kinds = {
        "too wide": opened.page.evaluate(TOO_WIDE),
        "too small": sorted({(t["size"], t["text"]) for t in texts if t["size"] < SMALLEST_TEXT_PX and not t["index"]}),
        "too pale": sorted({(contrast(t), t["text"], t["ink"]) for t in texts if contrast(t) < LEAST_CONTRAST}),
        "over another": opened.page.evaluate(OVERLAPS),
        "crowded": opened.page.evaluate(CROWDED),
        "errors": [message for message in opened.messages if "error" in message],
    }
    return {kind: seen for kind, seen in kinds.items() if seen}


def test_nothing_is_too_wide_too_small_too_pale_or_over_another(opened):
    assert flaws(opened) == {}


@pytest.mark.parametrize("name", ["own", *(pytest.param(name, marks=pytest.mark.long) for name in ("demo", "refused"))])
def test_the_keyboard_reaches_every_chart(visit, pages, name):
    with visit(pages[name]) as found:
        found.page.evaluate(OPEN_ALL)
        charts = set(found.page.evaluate(CHARTS))
        reached, first = set(), None
        for _ in range(2000):
            found.page.keyboard.press("Tab")
            focused = found.page.evaluate("document.activeElement.id || document.activeElement.outerHTML.slice(0, 80)")
            if focused == first:
                break
            first = first or focused
            reached.add(focused)
        assert charts
        assert charts <= reached


@pytest.mark.parametrize("width", [1280, 390])
def test_the_contents_stay_in_view_and_open_what_they_lead_to(visit, pages, width):
    with visit(pages["demo"], viewport={"width": width, "height": 900}) as found:
        page = found.page
        for share in (0.0, 0.3, 0.6, 0.9):
            page.evaluate(f"window.scrollTo(0, {share} * document.documentElement.scrollHeight)")
            top, bottom = page.evaluate(
                "(b => [b.top, b.bottom])(document.querySelector('nav').getBoundingClientRect())"
            )
            assert -1 <= top < bottom <= 901, share
        menu = page.locator("nav .menu")
        assert menu.is_visible() == (width < 1000)
        if menu.is_visible():
            assert page.locator("#contents").is_hidden()
            menu.click()
        page.locator("nav a", has_text="Data quality").click()
        found.wait_for("document.getElementById('quality').closest('details').open")
        found.wait_for(
            "Math.abs(document.getElementById('quality').closest('details').getBoundingClientRect().top) < 80"
        )
        assert page.locator("#appendix > details[open]").count() == 1
        if width < 1000:
            assert page.locator("#contents").is_hidden()
        page.locator("nav .up").click()
        found.wait_for("window.scrollY < 100")


def test_a_link_from_elsewhere_opens_its_section(visit, pages):
    with visit(pages["demo"]) as found:
        found.page.goto(f"{pages['demo'].as_uri()}#search")
        found.wait_for("document.getElementById('search').closest('details').open")


@pytest.mark.parametrize("name", ["demo", "refused", "own"])
def test_paper_has_a_first_page_a_summary_and_what_is_open(visit, pages, name):
    with visit(pages[name]) as found:
        found.wait_for("document.readyState === 'complete'")
        folded = found.sheets()
        assert 3 <= folded <= MOST_SHEETS[name]
        # page one is one sheet: without what follows, and the break before it, nothing else is left
        found.page.evaluate(
            "document.querySelectorAll('main > :not(#found), footer').forEach(e => e.remove());"
            "document.getElementById('found').style.breakAfter = 'auto'"
        )
        assert found.sheets() == 1


def test_paper_has_the_findings_and_the_last_rows_of_a_table_together(visit, pages):
    with visit(pages["demo"]) as found:
        found.wait_for("document.readyState === 'complete'")
        findings = found.page.locator("#summary .findings")
        assert not findings.is_visible()
        found.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        found.page.emulate_media(media="print")
        assert findings.is_visible()
        rows = "[...document.querySelectorAll('section:has(> #numbers) tbody tr')]"
        kept = found.page.evaluate(f"{rows}.map(row => getComputedStyle(row).breakBefore)")
        assert kept[-3:] == ["avoid"] * 3
        assert kept[0] == "auto"
        found.page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        assert not findings.is_visible()


def test_open_sections_are_printed(visit, pages):
    with visit(pages["own"]) as found:
        folded = found.sheets()
        found.page.evaluate(OPEN_ALL)
        assert found.sheets() > folded
