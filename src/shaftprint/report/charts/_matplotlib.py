"""A chart as a picture for papers: matplotlib, which takes seconds to load and to draw. ``_pictures`` loads this file.

Line colours go from dark to light in the order of use and every line has its own dashes, so a grey print keeps them
apart. The hues are those of Okabe and Ito (Color Universal Design, 2008), which colour-blind readers tell apart.
"""

from pathlib import Path
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MultipleLocator

from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import (
    COLOURS,
    Band,
    Bars,
    Fields,
    Line,
    Mark,
    Points,
    Shade,
    Straight,
    Words,
    dash_of,
    marker_of,
    texture_of,
)
from shaftprint.report.charts._text import Text, as_mathtext, as_plain

WIDTH_CM = 16.0
CM_PER_INCH = 2.54
CM_PER_PX = 0.0165
FONT_PT = 8.0
PNG_DPI = 170
LETTER_CM = 0.15
# Names that need more beside each other stand slanted.
NAMES_CM = 14.0
MOST_COLUMNS = 4
LEGEND_SHARE = 0.98
BAND_ALPHA = 0.28
LINE_PT = 0.6
FEW_DECADES = 30.0
LABELLED = (2.0, 5.0)
DARK = 0.6
GRID = "#d9d9d9"

PAINTS = ("#003f6b", "#b03a00", "#007a5a", "#b0508c", "#3f98d0", "#d99000")
NAMED = {"data": "#000000", "ink": "#000000", "soft": "#b9b9b9", "reference": "#7a7a7a", "early": "#e08a4a"}
# How often a texture is repeated in an inch.
DENSE = 4
MARKERS = {
    "circle": "o",
    "square": "s",
    "triangle-up": "^",
    "diamond": "D",
    "triangle-down": "v",
    "cross": "P",
    "x": "x",
    "plus": "+",
}
DASHES: dict[str, Any] = {
    "solid": "-",
    "dash": (0.0, (5.0, 1.5)),
    "dashdot": (0.0, (5.0, 1.5, 1.0, 1.5)),
    "dot": (0.0, (1.0, 1.5)),
    "longdash": (0.0, (8.0, 2.0)),
    "longdashdot": (0.0, (8.0, 2.0, 1.0, 2.0)),
}
SETTINGS: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": FONT_PT,
    "axes.labelsize": FONT_PT,
    "axes.titlesize": FONT_PT,
    "xtick.labelsize": FONT_PT,
    "ytick.labelsize": FONT_PT,
    "legend.fontsize": FONT_PT,
    "figure.facecolor": "white",
    "axes.facecolor": "white",
    "axes.edgecolor": "black",
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlelocation": "left",
    "axes.unicode_minus": True,
    "grid.color": GRID,
    "grid.linewidth": 0.5,
    "legend.frameon": False,
    "legend.handlelength": 3.2,
    "mathtext.fontset": "dejavusans",
    "svg.fonttype": "path",
    "svg.hashsalt": "shaftprint",
}


def drawn(chart: Chart, size_cm: tuple[float, float] | None = None) -> Figure:
    """Return a chart as a figure; see ``draw``."""
    rows = [chart.row_px(row) for row in range(chart.rows)]
    with mpl.rc_context(SETTINGS):
        usual_cm = CM_PER_PX * chart.height_px
        width_cm, height_cm = size_cm or (WIDTH_CM, usual_cm)
        figure = Figure(figsize=(width_cm / CM_PER_INCH, height_cm / CM_PER_INCH), layout="constrained")
        FigureCanvasAgg(figure)
        share: dict[str, Literal["all", "col", "none"]] = {"all": "all", "columns": "col", "none": "none"}
        grid = figure.subplots(
            chart.rows, chart.columns, squeeze=False, sharex=share[chart.linked], height_ratios=rows
        ).ravel()
        for axes, panel in zip(grid, chart.panels, strict=False):
            _draw_panel(axes, panel)
            if chart.square:
                axes.set_aspect("equal")
        for axes in grid[len(chart.panels) :]:
            axes.set_visible(False)
        for place, panel in enumerate(chart.panels):
            below = place + chart.columns < len(chart.panels)
            if not (below and chart.linked != "none"):
                grid[place].set_xlabel(as_mathtext(panel.x.title))
            panel_cm = CM_PER_PX * rows[place // chart.columns] * height_cm / usual_cm
            grid[place].set_ylabel(_in_lines(panel.y.title, panel_cm))
        figure.align_ylabels()
        _draw_legend(figure, list(grid[: len(chart.panels)]))
    return figure


def saved(chart: Chart, target: Path) -> None:
    """Write a chart by the suffix; see ``save_chart``."""
    nobody = {".svg": {"Date": None, "Creator": None}, ".png": {"Software": None}}.get(
        target.suffix, {"CreationDate": None}
    )
    with mpl.rc_context(SETTINGS):
        drawn(chart).savefig(target, format=target.suffix[1:], dpi=PNG_DPI, metadata=nobody)


def _draw_panel(axes: Axes, panel: Panel) -> None:
    for mark in panel.marks:
        _draw_mark(axes, mark)
    if as_plain(panel.title):
        axes.set_title(as_mathtext(panel.title))
    for axis, scale in ((axes.xaxis, panel.x), (axes.yaxis, panel.y)):
        _scale(axis, scale)
    if panel.x.span is not None:
        axes.set_xlim(*panel.x.span)
    if panel.y.span is not None:
        axes.set_ylim(*panel.y.span)


def _in_lines(title: Text, height_cm: float) -> str:
    """Return the title of an upright axis in two lines where it is longer than the axis."""
    text = as_mathtext(title)
    spaces = [place for place, letter in enumerate(text) if letter == " " and text[:place].count("$") % 2 == 0]
    if LETTER_CM * len(as_plain(title)) < height_cm or not spaces:
        return text
    middle = min(spaces, key=lambda place: abs(place - len(text) // 2))
    return f"{text[:middle]}\n{text[middle + 1 :]}"


def _scale(axis: Axis, scale: Scale) -> None:
    if scale.names:
        axis.set_ticks(np.arange(len(scale.names)), [as_mathtext(name) for name in scale.names])
        axis.grid(visible=False)
        longest = max(len(as_plain(name)) for name in scale.names)
        if axis.axis_name == "x" and LETTER_CM * longest * len(scale.names) > NAMES_CM:  # type: ignore[attr-defined]
            for label in axis.get_ticklabels():
                label.set(rotation=40.0, ha="right", rotation_mode="anchor")
    elif scale.log:
        (axis.axes.set_xscale if axis.axis_name == "x" else axis.axes.set_yscale)("log")  # type: ignore[attr-defined]
        axis.set_major_locator(LogLocator(base=10.0))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(LogLocator(base=10.0, subs=LABELLED))
        axis.set_minor_formatter(FuncFormatter(lambda value, _: _minor_label(axis, value)))
    elif scale.step is not None:
        axis.set_major_locator(MultipleLocator(scale.step))


def _minor_label(axis: Axis, value: float) -> str:
    """Return a label at 2 and 5 of a decade on an axis that shows little more than one decade."""
    low, high = axis.get_view_interval()
    mantissa = round(value / 10.0 ** np.floor(np.log10(value)), 6)
    return f"{value:g}" if high < FEW_DECADES * low and mantissa in LABELLED else ""


def _draw_mark(axes: Axes, mark: Mark) -> None:
    label = as_mathtext(getattr(mark, "name", "")) or "_none"
    match mark:
        case Line():
            marker = MARKERS[mark.marker] if mark.marker else ""
            axes.plot(
                mark.x, mark.y, color=_paint(mark.shade), linestyle=DASHES[mark.dash or dash_of(mark.shade)],
                linewidth=LINE_PT * mark.width, marker=marker, markersize=2.5, label=label,
            )  # fmt: skip
        case Band():
            axes.fill_between(
                mark.x, mark.lower, mark.upper, color=_paint(mark.shade), alpha=BAND_ALPHA, linewidth=0.0, label=label
            )
        case Points():
            _draw_points(axes, mark, label)
        case Bars():
            _draw_bars(axes, mark, label)
        case Fields():
            _draw_fields(axes, mark)
        case Straight():
            line = axes.axvline if mark.axis == "x" else axes.axhline
            line(mark.at, color=_paint(mark.shade), linewidth=0.9, linestyle=DASHES[mark.dash], label=label)
        case Words():
            side = {"right": ("left", 4.0), "left": ("right", -4.0), "above": ("center", 0.0)}[mark.anchor]
            axes.annotate(
                as_mathtext(mark.text), (mark.x, mark.y), xytext=(side[1], 0.0), textcoords="offset points",
                ha=side[0], va="bottom" if mark.anchor == "above" else "center",
            )  # fmt: skip


def _draw_points(axes: Axes, mark: Points, label: str) -> None:
    paint = _paint(mark.shade)
    bars = None if mark.bars is None else np.stack(mark.bars)
    axes.errorbar(
        mark.x, mark.y,
        xerr=bars if mark.bars_along == "x" else None, yerr=bars if mark.bars_along == "y" else None,
        linestyle="none", marker=MARKERS[mark.marker or marker_of(mark.shade)], markersize=LINE_PT * mark.size,
        color=paint, markerfacecolor=paint if mark.filled else "white", markeredgewidth=0.8, elinewidth=0.8,
        capsize=1.8, capthick=0.8, zorder=3.0, label=label,
    )  # fmt: skip


def _draw_bars(axes: Axes, mark: Bars, label: str) -> None:
    texture, is_pale = texture_of(mark.shade)
    ground, lines = ("white", _paint(mark.shade)) if is_pale else (_paint(mark.shade), "white")
    looks: dict[str, Any] = {"color": ground, "hatch": DENSE * texture, "edgecolor": lines, "linewidth": 0.4}
    if mark.upright:
        axes.bar(mark.places, mark.lengths, bottom=mark.starts, width=mark.width, label=label, **looks)
    else:
        axes.barh(mark.places, mark.lengths, left=mark.starts, height=mark.width, label=label, **looks)


def _draw_fields(axes: Axes, mark: Fields) -> None:
    axes.grid(visible=False)
    image = axes.imshow(np.ma.masked_invalid(mark.values), cmap="RdBu_r", vmin=-1.0, vmax=1.0, aspect="auto")
    for row, words in enumerate(mark.words):
        for column, word in enumerate(words):
            dark = abs(mark.values[row, column]) > DARK
            axes.text(column, row, word, ha="center", va="center", fontsize=6.5, color="white" if dark else "black")
    axes.figure.colorbar(image, ax=axes, pad=0.02)


def _draw_legend(figure: Figure, panels: list[Axes]) -> None:
    """Put one legend for all panels below them, each name once, in as many columns as fit the figure."""
    entries: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            entries.setdefault(label, handle)
    for columns in range(min(MOST_COLUMNS, len(entries)), 0, -1):
        legend = figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=columns)
        if columns == 1 or legend.get_window_extent().width <= LEGEND_SHARE * figure.bbox.width:
            return
        legend.remove()


def _paint(shade: Shade) -> str:
    return PAINTS[shade % COLOURS] if isinstance(shade, int) else NAMED[shade]
