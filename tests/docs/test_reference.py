"""The reference: every constant says what it is, rooms stand by task, long names may be broken, pages print whole."""

import importlib
import re
from pathlib import Path

import pytest
from generated_reference import directive, first_sentence, public_names, rooms, with_breaks
from pages import ROOT
from room_diagram import TASKS, listed_rooms, with_rooms

OWN = ROOT / "docs" / "_static" / "shaftprint.css"


@pytest.mark.parametrize("room", rooms())
def test_every_constant_of_a_room_says_what_it_is(room):
    module = importlib.import_module(f"shaftprint.{room}")
    constants = [name for name in public_names(module) if directive(getattr(module, name)) == "autodata"]
    # names of types say what they are
    told = {name: first_sentence(module, name) for name in constants}
    assert [name for name, text in told.items() if not text.endswith(".")] == []


def test_every_room_stands_under_one_task():
    text = with_rooms("<!-- rooms -->")
    linked = re.findall(r"\(generated/(\w+)\.rst\)", text)
    assert sorted(linked) == sorted(listed_rooms())
    assert {room for named in TASKS.values() for room in named} <= set(linked)


def test_a_long_name_may_be_broken_after_its_dots_and_a_link_stays():
    heading = '<h2>shaftprint.identify.comparison<a href="#shaftprint.identify">#</a></h2>'
    assert with_breaks(heading) == (
        '<h2>shaftprint.<wbr>identify.<wbr>comparison<a href="#shaftprint.identify">#</a></h2>'
    )


PAGE = """<!doctype html>
<html data-theme="light"><head><link rel="stylesheet" href="{theme}"><style>{own}</style></head>
<body><header class="bd-header">head</header><div class="bd-container"><div class="bd-container__inner bd-page-width">
<div class="bd-sidebar-primary bd-sidebar">side</div><main class="bd-main"><div class="bd-content">
<div class="bd-article-container"><article class="bd-article"><p>{long}</p><div class="highlight-sh"><div
class="highlight"><pre>{line}</pre></div></div><p>{long}</p><h2>The end</h2></article></div>
<div class="bd-sidebar-secondary">on this page</div></div></main></div></div></body></html>"""


@pytest.mark.slow
def test_a_page_prints_as_text_that_no_sheet_cuts(browser, tmp_path):
    """A command of one long line is wrapped, and nothing has an end of its own below the text."""
    packaged = Path(pytest.importorskip("pydata_sphinx_theme").__file__).parent
    theme = packaged / "theme" / "pydata_sphinx_theme" / "static" / "styles" / "pydata-sphinx-theme.css"
    place = tmp_path / "page.html"
    line = "shaftprint plan --vessel mine.toml " + "--wish t_d=20% " * 12
    place.write_text(
        PAGE.format(
            theme=theme.as_uri(),
            own=OWN.read_text(encoding="utf-8"),
            long="A sentence of a page. " * 900,
            line=line,
        ),
        encoding="utf-8",
    )
    page = browser.new_page(viewport={"width": 688, "height": 1000})
    page.goto(place.as_uri())
    page.emulate_media(media="print")
    cut = page.evaluate(
        "[...document.querySelectorAll('body, body *')].filter(e => e.checkVisibility()"
        " && (['auto', 'scroll', 'hidden'].includes(getComputedStyle(e).overflowY) || e.scrollWidth > e.clientWidth + 3"
        " || ['flex', 'grid'].includes(getComputedStyle(e).display)"
        " || ['sticky', 'fixed'].includes(getComputedStyle(e).position))"
        " && !getComputedStyle(e).display.startsWith('inline')).map(e => e.className || e.tagName)"
    )
    assert cut == []
    assert not page.locator(".bd-sidebar-secondary").is_visible()
    page.close()
