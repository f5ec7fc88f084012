"""One look for all figures: size, fonts, lines that differ in grey as well as in colour, legends beside the data.

Line colours go from dark to light in the order of use and every line has its own dashes, so a grey print keeps them
apart. The hues are those of Okabe and Ito (Color Universal Design, 2008), which colour-blind readers tell apart.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, TypeAlias

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator
from PIL import Image

WIDTH_CM = 16.0
CM_PER_INCH = 2.54
FONT_PT = 8.0
PNG_DPI = 170
# A line, its band and their mixtures; a third of the size of a picture in true colours.
PNG_COLOURS = 64
MOST_COLUMNS = 4
LEGEND_SHARE = 0.98
FEW_DECADES = 30.0
LABELLED = (2.0, 5.0)
GRID = "#d9d9d9"
REFERENCE = "#7a7a7a"
DATA = "#000000"

Dashes: TypeAlias = str | tuple[float, tuple[float, ...]]
# What stands for an entry of a legend: an artist, or several drawn over each other.
Handle: TypeAlias = Artist | tuple[Artist, ...]

_SETTINGS: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": FONT_PT,
    "axes.labelsize": FONT_PT,
    "axes.titlesize": FONT_PT,
    "xtick.labelsize": FONT_PT,
    "ytick.labelsize": FONT_PT,
    "legend.fontsize": FONT_PT,
    "figure.titlesize": FONT_PT,
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
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.handlelength": 3.2,
    "mathtext.fontset": "dejavusans",
    "path.simplify": True,
    "path.simplify_threshold": 0.2,
}
_COORDINATES = re.compile(r' (?:d|x|y)="[^"]*"|translate\([^)]*\)')
# A hundredth of a point, which nobody sees.
_IDLE_DIGITS = re.compile(r"(\.\d\d)\d+(?![\de])")
# Points after a point to move or draw to are drawn to without a letter; so are bends after a bend.
_POLYLINE = re.compile(r"[ML] [-+\d.e]+ [-+\d.e]+(?:\s*\nL [-+\d.e]+ [-+\d.e]+)+")
_BENDS = re.compile(r"Q(?: [-+\d.e]+){4}(?:\s*\nQ(?: [-+\d.e]+){4})+")
_REPEATED = re.compile(r"\s*\n[LQ] ")
_COMMENT = re.compile(r"<!--.*?-->\s*", re.DOTALL)
_INDENT = re.compile(r"\s*\n\s*")


@dataclass(frozen=True, slots=True)
class LineLook:
    """How one line of several is drawn."""

    colour: str
    """Colour; the list below goes from dark to light."""
    dashes: Dashes
    """Dash pattern."""
    marker: str
    """Marker, where points are drawn."""


LOOKS = (
    LineLook("#003f6b", "-", "o"),
    LineLook("#b03a00", (0.0, (5.0, 1.5)), "s"),
    LineLook("#007a5a", (0.0, (5.0, 1.5, 1.0, 1.5)), "^"),
    LineLook("#b0508c", (0.0, (2.0, 1.0)), "D"),
    LineLook("#3f98d0", (0.0, (8.0, 2.0, 1.0, 2.0, 1.0, 2.0)), "v"),
    LineLook("#d99000", (0.0, (1.0, 1.2)), "P"),
)


@contextmanager
def house_style() -> Iterator[None]:
    """Draw in the house style; matplotlib's own settings are as before afterwards."""
    with mpl.rc_context(_SETTINGS):
        yield


def new_figure(height_cm: float, *, width_cm: float = WIDTH_CM) -> Figure:
    """Return an empty figure whose parts make room for each other; call it inside ``house_style``."""
    figure = Figure(figsize=(width_cm / CM_PER_INCH, height_cm / CM_PER_INCH), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def look(place: int) -> LineLook:
    """Return the look of the line at a place of a list; they repeat after six."""
    return LOOKS[place % len(LOOKS)]


def ramp(count: int) -> tuple[str, ...]:
    """Return colours whose lightness grows evenly: dark blue to light ochre, safe for colour-blind readers."""
    colours = mpl.colormaps["cividis"](np.linspace(0.0, 0.82, count))
    return tuple(mpl.colors.to_hex(colour) for colour in colours)


RAMP_DASHES: tuple[Dashes, ...] = (
    "-",
    (0.0, (6.0, 1.5)),
    (0.0, (4.0, 1.2, 1.0, 1.2)),
    (0.0, (2.0, 1.0)),
    (0.0, (1.0, 1.0)),
)


def letter_panels(panels: Sequence[Axes], titles: Sequence[str]) -> None:
    """Put "(a)", "(b)" ... and a title above each panel; no letter where there is one panel only."""
    for index, (axes, title) in enumerate(zip(panels, titles, strict=True)):
        letter = f"({chr(ord('a') + index)}) " if len(panels) > 1 else ""
        axes.set_title(letter + title)


def legend_entries(panels: Sequence[Axes]) -> dict[str, Handle]:
    """Return what a legend of several panels must explain: each label once, in the order of drawing."""
    entries: dict[str, Handle] = {}
    for axes in panels:
        handles, labels = axes.get_legend_handles_labels()
        for handle, label in zip(handles, labels, strict=True):
            entries.setdefault(label, handle)
    return entries


def legend_below(figure: Figure, entries: Mapping[str, Handle]) -> None:
    """Put one legend for all panels below them, outside the data, in as many columns as fit the figure."""
    if not entries:
        return
    # The stubs know no tuples of artists; matplotlib draws them over each other.
    handles: list[Any] = list(entries.values())
    for columns in range(min(MOST_COLUMNS, len(entries)), 0, -1):
        legend = figure.legend(handles, list(entries), loc="outside lower center", ncols=columns)
        if columns == 1 or legend.get_window_extent().width <= LEGEND_SHARE * figure.bbox.width:
            return
        legend.remove()


def plain_number(value: float) -> str:
    """Return a number with as many digits as it needs, with a minus sign instead of a hyphen."""
    return f"{value:g}".replace("-", "−")


def plain_log_axis(axes: Axes, which: Literal["x", "y"] = "x") -> None:
    """Scale an axis logarithmically with plain numbers (0.01, 0.1, 1, 10) instead of powers."""
    (axes.set_xscale if which == "x" else axes.set_yscale)("log")
    axis = axes.xaxis if which == "x" else axes.yaxis
    axis.set_major_locator(LogLocator(base=10.0))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    # All eight of a decade would cost a third of the time that a figure takes.
    axis.set_minor_locator(LogLocator(base=10.0, subs=LABELLED))
    axis.set_minor_formatter(FuncFormatter(lambda value, _: _minor_label(axis, value)))


def _minor_label(axis: Axis, value: float) -> str:
    """Return a label at 2 and 5 of a decade on an axis that shows little more than one decade."""
    low, high = axis.get_view_interval()
    mantissa = round(value / 10.0 ** np.floor(np.log10(value)), 6)
    return f"{value:g}" if high < FEW_DECADES * low and mantissa in LABELLED else ""


def save_figure(figure: Figure, path: str | Path) -> None:
    """Write a figure as SVG, PNG or PDF by the suffix; the same figure gives the same bytes.

    Letters are written as outlines, so that the picture does not depend on the reader's fonts.
    """
    target = Path(path)
    metadata: dict[str, str | None]
    match target.suffix:
        case ".svg":
            metadata = {"Date": None, "Creator": None}
        case ".png":
            metadata = {"Software": None}
        case _:
            metadata = {"CreationDate": None}
    with mpl.rc_context(_SETTINGS | {"svg.fonttype": "path", "svg.hashsalt": "shaftprint"}):
        figure.savefig(target, format=target.suffix[1:], dpi=PNG_DPI, metadata=metadata)
    match target.suffix:
        case ".svg":
            target.write_text(shorter_svg(target.read_text(encoding="utf-8")), encoding="utf-8")
        case ".png":
            with Image.open(target) as picture:
                few = picture.convert("RGB").quantize(PNG_COLOURS, dither=Image.Dither.NONE)
            few.save(target, "PNG", optimize=True)


def shorter_svg(svg: str) -> str:
    """Return an SVG with coordinates to a hundredth of a point, without repeated letters, comments and indents."""
    return _INDENT.sub("\n", _COMMENT.sub("", _COORDINATES.sub(lambda found: _shorter(found.group()), svg)))


def _shorter(coordinates: str) -> str:
    fewer = _IDLE_DIGITS.sub(r"\1", coordinates)
    for same in (_POLYLINE, _BENDS):
        fewer = same.sub(lambda found: _REPEATED.sub(" ", found.group()), fewer)
    return fewer
