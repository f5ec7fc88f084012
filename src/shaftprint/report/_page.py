"""A page of words, tables and charts, written with their data into a folder that needs no network.

The page's policy allows its own style sheet, scripts and pictures of its folder, and nothing else. ``file:`` stands
beside ``'self'`` because a page opened from a disk has no origin of its own; an empty style sheet is allowed because
plotly makes one and fills it rule by rule, and attributes of style because it sets them on what it draws.
"""

import base64
import hashlib
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType

from jinja2 import Template
from markupsafe import Markup

from shaftprint.errors import ReportError
from shaftprint.markup._environment import environment, shown_table, style_sheet, template_text
from shaftprint.plain_table import Table
from shaftprint.report._chart_files import ChartFiles, write_charts, write_scripts
from shaftprint.report._folder import PAGE, PDF, report_written_whole
from shaftprint.report.charts._script import plotly_script, plotly_sheets
from shaftprint.report.sections._cover import Cover
from shaftprint.report.sections._sections import Section

TEMPLATE, CHART_TEMPLATE = "report.html.j2", "chart.html.j2"
TEMPLATES = (TEMPLATE, CHART_TEMPLATE, "sketch.svg.j2")
CHART_STYLE = "charts.css"
SCRIPTS = ("report.js", "layout.js", "charts.js")
# Loaded when a PDF is asked for: it needs a library that not everybody has.
PAPER = "shaftprint.report.paper._write_pdf"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Page:
    """What a report says, before it is drawn."""

    title: str
    """Heading of the page."""
    subtitle: str
    """What was tested, in a line below it."""
    created: datetime
    """When the numbers were made, with time zone."""
    version: str
    """Version of shaftprint that made them."""
    sections: Sequence[Section]
    """What follows the first page, those that are folded last."""
    files: Table
    """Files that went into the report."""
    ending: str
    """Last line of the page."""
    cover: Cover | None = None
    """The first page; None for one that goes with another."""
    neighbours: Sequence[tuple[str, str]] = ()
    """Other pages of the same folder: file and title."""
    fingerprint_sha256: str | None = None
    """SHA-256 of the file of the fingerprint that the page shows; None for a page on several."""


def write_page(
    directory: str | Path,
    page: Page,
    *,
    pictures: bool = False,
    overwrite: bool = False,
    progress: Callable[[float], None] | None = None,
    further: Mapping[str, Page] = MappingProxyType({}),
    pdf: bool = False,
) -> Path:
    """Write a page with its charts, whole or not at all; return its path.

    ``directory``: where the page goes; made if it does not exist. Other files there are left alone. ``page``: what it
    says. ``pictures``: whether the charts are written as pictures too. ``overwrite``: whether an earlier report there
    may be replaced. ``progress``: is told the finished share, from 0 to 1. ``further``: pages beside it, by their
    files; the folder's names of figures are those of all pages. ``pdf``: whether what is not folded of the page is
    written as PDF too. Raises FileExistsError if there is a report already and ``overwrite`` is false; ReportError if
    plotly is not installed, or ReportLab is not and a PDF is asked for.
    """
    folder = Path(directory)
    library = plotly_script()
    if pdf:
        expect_reportlab()
    with report_written_whole(folder, overwrite=overwrite) as part:
        pages = {PAGE: page, **further}
        shown = [picture for one in pages.values() for section in one.sections for picture in section.pictures]
        charts = write_charts(shown, part, pictures=pictures, progress=progress)
        scripts = write_scripts(part, {name: _template(name) for name in SCRIPTS}, library)
        for name, one in pages.items():
            (part / name).write_text(_html(one, charts, scripts, plotly_sheets(library)), encoding="utf-8")
        if pdf:
            page_as_pdf(page, part / PDF)
    return folder / PAGE


def page_as_pdf(page: Page, path: Path) -> None:
    """Write what is not folded of a page as PDF.

    Raises ReportError if ReportLab is not installed.
    """
    expect_reportlab()
    importlib.import_module(PAPER).write_pdf(
        path,
        title=page.title,
        subtitle=f"{page.subtitle}, made {page.created:%Y-%m-%d %H:%M %Z}",
        cover=page.cover,
        sections=page.sections,
        ending=page.ending,
    )


def expect_reportlab() -> None:
    """Refuse where what writes PDF is not installed.

    Raises ReportError if ReportLab is not installed.
    """
    if find_spec("reportlab") is None:
        raise ReportError('PDF: expected the package reportlab, found none; pip install "shaftprint[pdf]".')


def _html(page: Page, charts: Mapping[str, ChartFiles], scripts: Sequence[str], empty_sheets: Sequence[str]) -> str:
    names = [picture.name for section in page.sections for picture in section.pictures]
    style = style_sheet() + _template(CHART_STYLE)
    logo = None if page.cover is None else page.cover.logo
    filled = environment({name: _template(name) for name in TEMPLATES})
    chart_template = filled.get_template(CHART_TEMPLATE)
    return filled.get_template(TEMPLATE).render(
        title=page.title,
        subtitle=page.subtitle,
        created=page.created,
        version=page.version,
        fingerprint_sha256=page.fingerprint_sha256,
        cover=page.cover,
        logo=None if logo is None else base64.b64encode(logo).decode(),
        sections=[section for section in page.sections if not section.folded],
        appendix=[section for section in page.sections if section.folded],
        neighbours=page.neighbours,
        files=page.files,
        ending=page.ending,
        first_chart=charts[names[0]] if names else None,
        scripts=scripts,
        empty_sheets=empty_sheets,
        shown=partial(shown_table, filled, folds=True),
        drawn=lambda picture: _shown(chart_template, picture=picture, chart=charts[picture.name]),
        # The style sheet is ours and holds nothing of the user's.
        style=Markup(style),  # noqa: S704
        policy=_policy(style, embedded=logo is not None),
    )


def _shown(template: Template, **content: object) -> Markup:
    # The template escapes what it is given.
    return Markup(template.render(**content))  # noqa: S704


def _policy(style: str, *, embedded: bool) -> str:
    """Return the page's policy: what it may load and run; ``embedded``: whether a picture stands in its text."""
    sheets = " ".join(f"'sha256-{_digest(sheet)}'" for sheet in (style, ""))
    return (
        f"default-src 'none'; img-src 'self' file:{' data:' * embedded}; script-src 'self' file:; "
        "style-src-attr 'unsafe-inline'; "
        f"style-src {sheets}; base-uri 'none'; form-action 'none'"
    )


def _digest(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _template(name: str) -> str:
    return template_text(__package__, name)
