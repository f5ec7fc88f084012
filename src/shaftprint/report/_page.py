"""A page of words, tables and pictures, written with its figures and plots into a folder that needs no network.

The page's policy allows its own style sheet, scripts and pictures of its folder, and nothing else. ``file:`` stands
beside ``'self'`` because a page opened from a disk has no origin of its own; an empty style sheet is allowed because
plotly makes one and fills it rule by rule, and attributes of style because it sets them on what it draws.
"""

import base64
import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from importlib.resources import files
from pathlib import Path

from jinja2 import DictLoader, Environment, StrictUndefined, Template
from markupsafe import Markup

from shaftprint.report._cover import Cover
from shaftprint.report._folder import FIGURES, PAGE, PLOTS, report_written_whole
from shaftprint.report._sections import Picture, Section
from shaftprint.report._style import save_figure
from shaftprint.report._table import Table, sentence_html
from shaftprint.report.plots import plotly_script, plotly_sheets, plotly_version

# Of a larger one a picture in dots is smaller, and still fine in print.
LARGEST_SVG_BYTES = 80_000
TEMPLATE = "report.html.j2"
TABLE_TEMPLATE = "table.html.j2"
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
    cover: Cover
    """The first screen."""
    sections: Sequence[Section]
    """What follows."""
    files: Table
    """Files that went into the report."""
    ending: str
    """Last line of the page."""


@dataclass(frozen=True, kw_only=True, slots=True)
class _Drawn:
    """Where an interactive figure is, as the page names it."""

    source: str
    height_px: int


def write_page(
    directory: str | Path,
    page: Page,
    *,
    interactive: bool,
    overwrite: bool,
    progress: Callable[[float], None] | None,
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

    Raises
    ------
    FileExistsError
        If there is a report already and ``overwrite`` is false.
    ReportError
        If figures are to be interactive and plotly is not installed.
    """
    place = Path(directory)
    library = plotly_script() if interactive else b""
    with report_written_whole(place, overwrite=overwrite) as part:
        pictures = [picture for section in page.sections for picture in section.pictures]
        sources, plots = {}, {}
        for number, picture in enumerate(pictures, start=1):
            sources[picture.name] = _drawn(picture, part)
            if interactive and picture.plot is not None:
                plots[picture.name] = _written_plot(picture, part)
            if progress is not None:
                progress(number / len(pictures))
        scripts = _scripts(part, library) if interactive else ()
        (part / PAGE).write_text(_html(page, sources, plots, scripts, plotly_sheets(library)), encoding="utf-8")
    return place / PAGE


def _drawn(picture: Picture, part: Path) -> str:
    """Draw and save a picture, as PNG where an SVG would be large; return its address on the page."""
    figure = picture.draw()
    path = part / FIGURES / f"{picture.name}.svg"
    save_figure(figure, path)
    if path.stat().st_size > LARGEST_SVG_BYTES:
        path.unlink()
        path = path.with_suffix(".png")
        save_figure(figure, path)
    return f"{FIGURES}/{path.name}"


def _written_plot(picture: Picture, part: Path) -> _Drawn:
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
    return _Drawn(source=address, height_px=plot.height_px)


def _scripts(part: Path, library: bytes) -> tuple[str, ...]:
    """Write plotly's script and the page's own into the folder of plots; return their addresses."""
    names = (f"plotly-{plotly_version(library)}.min.js", SCRIPT)
    for name, content in zip(names, (library, _template(SCRIPT).encode()), strict=True):
        (part / PLOTS / name).write_bytes(content)
    return tuple(f"{PLOTS}/{name}" for name in names)


def _html(
    page: Page,
    sources: Mapping[str, str],
    plots: Mapping[str, _Drawn],
    scripts: Sequence[str],
    empty_sheets: Sequence[str],
) -> str:
    style = _template(STYLE)
    environment = Environment(
        loader=DictLoader({name: _template(name) for name in (TEMPLATE, TABLE_TEMPLATE)}),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["symbols"] = sentence_html
    table_template = environment.get_template(TABLE_TEMPLATE)
    return environment.get_template(TEMPLATE).render(
        title=page.title,
        subtitle=page.subtitle,
        created=page.created,
        version=page.version,
        cover=page.cover,
        sections=page.sections,
        files=page.files,
        ending=page.ending,
        sources=sources,
        plots=plots,
        scripts=scripts,
        empty_sheets=empty_sheets,
        shown=lambda table: _shown(table_template, table),
        # The style sheet is ours and holds nothing of the user's.
        style=Markup(style),  # noqa: S704
        policy=_policy(style, scripted=bool(scripts)),
    )


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
