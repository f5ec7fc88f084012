"""A page of words, tables and pictures, written with its figures and plots into a folder that needs no network.

The page's policy allows its own style sheet, scripts and pictures of its folder, and nothing else. ``file:`` stands
beside ``'self'`` because a page opened from a disk has no origin of its own; an empty style sheet is allowed because
plotly makes one and fills it rule by rule, and attributes of style because it sets them on what it draws.
"""

import base64
import hashlib
import importlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from types import MappingProxyType

from jinja2 import DictLoader, Environment, StrictUndefined, Template
from markupsafe import Markup

from shaftprint.errors import ReportError
from shaftprint.escape import html_value
from shaftprint.report._folder import FIGURES, PAGE, PDF, PLOTS, report_written_whole
from shaftprint.report.figures import save_figure
from shaftprint.report.notation import cell_html, sentence_html
from shaftprint.report.plots import plotly_script, plotly_sheets, plotly_version, quick_script
from shaftprint.report.sections import Cover, Picture, Section
from shaftprint.tables import Table

# Of a larger one a picture in dots is smaller, and still fine in print.
LARGEST_SVG_BYTES = 80_000
CSS_PX_AN_INCH = 96.0
TEMPLATE = "report.html.j2"
# Loaded when a PDF is asked for: it needs a library that not everybody has.
PAPER = "shaftprint.report.paper"
TABLE_TEMPLATE = "table.html.j2"
SKETCH_TEMPLATE = "sketch.svg.j2"
STYLE = "report.css"
SCRIPT = "report.js"


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


@dataclass(frozen=True, kw_only=True, slots=True)
class _Still:
    """Where a static figure is, as the page names it, and its size."""

    source: str
    width_px: int
    height_px: int


@dataclass(frozen=True, kw_only=True, slots=True)
class _Chart:
    """Where the data of an interactive figure are, as the page names them, and its height."""

    source: str
    height_px: int


@dataclass(frozen=True, kw_only=True, slots=True)
class _Scripts:
    """Where the page's own script and plotly's are, as the page names them."""

    page: str
    library: str


def write_page(
    directory: str | Path,
    page: Page,
    *,
    interactive: bool,
    overwrite: bool,
    progress: Callable[[float], None] | None,
    further: Mapping[str, Page] = MappingProxyType({}),
    pdf: bool = False,
) -> Path:
    """Write a page with its figures, whole or not at all; return its path.

    Parameters
    ----------
    directory
        Where the page goes; made if it does not exist. Other files there are left alone.
    page
        What it says.
    interactive
        Whether the figures that can be interactive are; otherwise the page runs no script.
    overwrite
        Whether an earlier report there may be replaced.
    progress
        Is told the finished share, from 0 to 1.
    further
        Pages beside it, by their files; the folder's names of figures are those of all pages.
    pdf
        Whether what is not folded of the page is written as PDF too.

    Raises
    ------
    FileExistsError
        If there is a report already and ``overwrite`` is false.
    ReportError
        If figures are to be interactive and plotly is not installed, or ReportLab is not and a PDF is asked for.
    """
    folder = Path(directory)
    library = plotly_script() if interactive else b""
    if pdf:
        expect_reportlab()
    with report_written_whole(folder, overwrite=overwrite) as part:
        pages = {PAGE: page, **further}
        pictures = [picture for one in pages.values() for section in one.sections for picture in section.pictures]
        stills, plots = {}, {}
        for number, picture in enumerate(pictures, start=1):
            stills[picture.name] = _written_still(picture, part)
            if interactive and picture.plot is not None:
                plots[picture.name] = _written_plot(picture, part)
            if progress is not None:
                progress(number / len(pictures))
        scripts = _written_scripts(part, library) if interactive else None
        for name, one in pages.items():
            text = _html(one, stills, plots, scripts, plotly_sheets(library))
            (part / name).write_text(text, encoding="utf-8")
        if pdf:
            page_as_pdf(page, part / PDF)
    return folder / PAGE


def page_as_pdf(page: Page, path: Path) -> None:
    """Write what is not folded of a page as PDF.

    Raises
    ------
    ReportError
        If ReportLab is not installed.
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

    Raises
    ------
    ReportError
        If ReportLab is not installed.
    """
    if find_spec("reportlab") is None:
        raise ReportError('PDF: expected the package reportlab, found none; pip install "shaftprint[pdf]".')


def _written_still(picture: Picture, part: Path) -> _Still:
    """Draw and save a picture, as PNG where an SVG would be large."""
    figure = picture.draw()
    path = part / FIGURES / f"{picture.name}.svg"
    save_figure(figure, path)
    if path.stat().st_size > LARGEST_SVG_BYTES:
        path.unlink()
        path = path.with_suffix(".png")
        save_figure(figure, path)
    width, height = (round(CSS_PX_AN_INCH * length) for length in figure.get_size_inches())
    return _Still(source=f"{FIGURES}/{path.name}", width_px=width, height_px=height)


def _written_plot(picture: Picture, part: Path) -> _Chart:
    """Write an interactive figure as a script that hands it to the page: a page from a disk may not read other files.

    Raises
    ------
    ValueError
        If the picture has no interactive figure.
    """
    if picture.plot is None:
        raise ValueError(f"picture {picture.name}: expected an interactive figure, found none.")
    plot = picture.plot()
    address = f"{PLOTS}/{picture.name}.js"
    (part / address).write_text(f"shaftprintPlot({json.dumps(picture.name)},{plot.text()});\n", encoding="utf-8")
    return _Chart(source=address, height_px=plot.height_px)


def _written_scripts(part: Path, library: bytes) -> _Scripts:
    """Write plotly's script and the page's own into the folder of plots."""
    scripts = _Scripts(page=f"{PLOTS}/{SCRIPT}", library=f"{PLOTS}/plotly-{plotly_version(library)}.min.js")
    (part / scripts.page).write_text(_template(SCRIPT), encoding="utf-8")
    (part / scripts.library).write_bytes(quick_script(library))
    return scripts


def _html(
    page: Page,
    stills: Mapping[str, _Still],
    plots: Mapping[str, _Chart],
    scripts: _Scripts | None,
    empty_sheets: Sequence[str],
) -> str:
    names = [picture.name for section in page.sections for picture in section.pictures]
    first_plot = next((name for name in names if name in plots), None)
    style = _template(STYLE)
    environment = _environment()
    table_template = environment.get_template(TABLE_TEMPLATE)
    return environment.get_template(TEMPLATE).render(
        title=page.title,
        subtitle=page.subtitle,
        created=page.created,
        version=page.version,
        fingerprint_sha256=page.fingerprint_sha256,
        cover=page.cover,
        sections=[section for section in page.sections if not section.folded],
        appendix=[section for section in page.sections if section.folded],
        neighbours=page.neighbours,
        files=page.files,
        ending=page.ending,
        stills=stills,
        plots=plots,
        first_plot=first_plot,
        # What a reader sees first is not to wait for a place near the screen.
        at_once={next(iter(names), None), first_plot},
        scripts=scripts,
        empty_sheets=empty_sheets,
        shown=lambda table: _shown(table_template, table),
        # The style sheet is ours and holds nothing of the user's.
        style=Markup(style),  # noqa: S704
        policy=_policy(style, scripted=scripts is not None),
    )


def _environment() -> Environment:
    """Return what fills the templates in: whatever it writes is escaped here, and nowhere else."""
    environment = Environment(
        loader=DictLoader({name: _template(name) for name in (TEMPLATE, TABLE_TEMPLATE, SKETCH_TEMPLATE)}),
        autoescape=True,
        finalize=html_value,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["symbols"] = sentence_html
    environment.filters["cell"] = cell_html
    return environment


def _shown(template: Template, table: Table) -> Markup:
    # The template escapes what the table holds.
    return Markup(template.render(table=table))  # noqa: S704


def _policy(style: str, *, scripted: bool) -> str:
    """Return the page's policy: what it may load and run."""
    allowed = [style, ""] if scripted else [style]
    sheets = " ".join(f"'sha256-{_digest(sheet)}'" for sheet in allowed)
    scripts = "script-src 'self' file:; style-src-attr 'unsafe-inline'; " if scripted else ""
    return f"default-src 'none'; img-src 'self' file:; {scripts}style-src {sheets}; base-uri 'none'; form-action 'none'"


def _digest(text: str) -> str:
    return base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def _template(name: str) -> str:
    return (files(__package__) / "templates" / name).read_text(encoding="utf-8")
