"""Charts as pictures: matplotlib is loaded when the first one is asked for, so that a report needs none."""

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.report.charts._chart import Chart

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRAWING = "shaftprint.report.charts._matplotlib"


def draw(chart: Chart, *, size_cm: tuple[float, float] | None = None) -> "Figure":
    """Return a chart as a figure of matplotlib, which belongs to nobody else.

    ``chart``: what is drawn. ``size_cm``: width and height [cm]; as wide as a text and as high as on a page where they
    are not given.
    """
    figure: Figure = importlib.import_module(DRAWING).drawn(chart, size_cm)
    return figure


def save_chart(chart: Chart, path: str | Path) -> None:
    """Write a chart as SVG, PNG or PDF by the suffix; the same chart gives the same bytes.

    Letters are written as outlines, so that the picture does not depend on the reader's fonts.

    Parameters
    ----------
    chart
        What is drawn.
    path
        Where it goes; an earlier file there is replaced.
    """
    importlib.import_module(DRAWING).saved(chart, Path(path))
