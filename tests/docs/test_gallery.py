"""The gallery shows every chart: those of the package are drawn on it, or it says where they are drawn."""

import re

from pages import PAGES, python_of

from shaftprint import report

GALLERY = "docs/gallery.md"
CHARTS = {name for name in report.__all__ if name.endswith("_chart") and name != "save_chart"}


def test_every_chart_is_drawn_or_it_is_said_where():
    drawn = set(
        re.findall(r"^sp\.report\.plot\(\s*sp\.report\.(\w+)", "\n".join(python_of(GALLERY)), flags=re.MULTILINE)
    )
    elsewhere = set(re.findall(r"`(\w+_chart)`", PAGES[GALLERY].partition("## Drawn elsewhere")[2]))
    assert drawn | elsewhere == CHARTS
    assert not drawn & elsewhere
    # that of sisters needs a class of ships
    assert len(elsewhere) <= 7


def test_what_is_drawn_with_the_thesis_is_drawn_there():
    assert {"chirp_chart", "open_loop_chart"} <= set(re.findall(r"\w+_chart", PAGES["docs/thesis-figures.md"]))
