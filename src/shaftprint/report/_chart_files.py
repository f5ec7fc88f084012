"""The files of a page's charts: their data, the scripts that draw them, and pictures where they are asked for."""

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from shaftprint.report._folder import FIGURES, PLOTS
from shaftprint.report.charts._pictures import save_chart
from shaftprint.report.charts._plotly import chart_script
from shaftprint.report.charts._quick_script import quick_script
from shaftprint.report.charts._script import plotly_version
from shaftprint.report.sections._sections import Picture

# On the page, and as a drawing whose lines stay sharp.
SUFFIXES = (".svg", ".pdf", ".png")


@dataclass(frozen=True, kw_only=True, slots=True)
class ChartFiles:
    """Where a chart's files are, as the page names them, and the room that it needs."""

    name: str
    """Name of the chart on the page."""
    source: str
    """Script with its data."""
    height_px: int
    """Height on a screen [px]."""
    narrow_height_px: int
    """Height on a phone [px]."""
    picture: str | None
    """Picture of it, for readers without scripts; None where none was asked for."""


def write_charts(
    shown: Sequence[Picture], part: Path, *, pictures: bool, progress: Callable[[float], None] | None
) -> dict[str, ChartFiles]:
    """Write the data of each chart, and pictures of it where asked for; return where they are, by name.

    ``shown``: charts in the order of the page. ``part``: folder that will be the report's. ``pictures``: whether
    pictures are written, too. ``progress``: is told the finished share, from 0 to 1.
    """
    files = {}
    for number, picture in enumerate(shown, start=1):
        files[picture.name] = _written(picture, part, pictures=pictures)
        if progress is not None:
            progress(number / len(shown))
    return files


def write_scripts(part: Path, own: Mapping[str, str], library: bytes) -> tuple[str, ...]:
    """Write the page's own scripts and plotly's; return where they are, plotly's last.

    ``part``: folder that will be the report's. ``own``: the page's own scripts by the name of the file. ``library``:
    plotly's script as it is in its package.
    """
    for name, text in own.items():
        (part / PLOTS / name).write_text(text, encoding="utf-8")
    address = f"{PLOTS}/plotly-{plotly_version(library)}.min.js"
    (part / address).write_bytes(quick_script(library))
    return (*(f"{PLOTS}/{name}" for name in own), address)


def _written(picture: Picture, part: Path, *, pictures: bool) -> ChartFiles:
    """Write a chart as a script that hands it to the page: a page from a disk may not read other files."""
    chart = picture.chart()
    source = f"{PLOTS}/{picture.name}.js"
    script = f"shaftprintChart({json.dumps(picture.name)},{chart_script(chart)});\n"
    (part / source).write_text(script, encoding="utf-8")
    if pictures:
        for suffix in SUFFIXES:
            save_chart(chart, part / FIGURES / f"{picture.name}{suffix}")
    return ChartFiles(
        name=picture.name,
        source=source,
        height_px=chart.height_px,
        narrow_height_px=chart.narrow_height_px,
        picture=f"{FIGURES}/{picture.name}{SUFFIXES[0]}" if pictures else None,
    )
