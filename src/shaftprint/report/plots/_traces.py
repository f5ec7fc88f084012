"""The parts that interactive figures are made of: lines, bands, points with error bars, straight lines."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.report.plots._plot import Json, numbers

DASHES = ("solid", "dash", "dashdot", "dot", "longdash", "longdashdot")
MARKERS = ("circle", "square", "triangle-up", "diamond", "triangle-down", "cross")
COLOURS = 6

Values = FloatArray | Sequence[float]


def colour(place: int) -> str:
    """Return the colour of the line at a place of a list; they repeat after six."""
    return f"@{place % COLOURS}"


def line(x: Values, y: Values, name: str, place: int, axes: Json, *, legend: bool = True) -> Json:
    """Return a line of a model or signal."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": numbers(x),
        "y": numbers(y),
        "name": name,
        "legendgroup": name,
        "showlegend": legend,
        "line": {"color": colour(place), "width": 2, "dash": DASHES[place % len(DASHES)], "simplify": False},
        **axes,
    }


def band(
    x: Values, lower: Values, upper: Values, name: str, place: int, axes: Json, *, legend: bool = True
) -> list[Json]:
    """Return a filled band; nothing where one of its ends is not known."""
    if not (np.isfinite(np.asarray(lower)).all() and np.isfinite(np.asarray(upper)).all()):
        return []
    there = numbers(x)
    return [
        {
            "type": "scatter",
            "mode": "lines",
            "x": [*there, *reversed(there)],
            "y": [*numbers(upper), *reversed(numbers(lower))],
            "name": name,
            "legendgroup": name,
            "showlegend": legend,
            "hoverinfo": "skip",
            "fill": "toself",
            "fillcolor": f"{colour(place)}~",
            "line": {"width": 0, "color": f"{colour(place)}~"},
            **axes,
        }
    ]


def points(
    x: Values,
    y: Values,
    name: str,
    axes: Json,
    *,
    shade: str = "@data",
    marker: str = "circle",
    filled: bool = True,
    bars: tuple[Values, Values] | None = None,
    words: Sequence[str] = (),
    legend: bool = True,
) -> Json:
    """Return points, hollow or filled, with error bars down and up where given and a word at each when pointed at."""
    trace: Json = {
        "type": "scatter",
        "mode": "markers",
        "x": numbers(x),
        "y": numbers(y),
        "name": name,
        "legendgroup": name,
        "showlegend": legend,
        "marker": {
            "color": shade if filled else "@paper",
            "size": 7,
            "symbol": marker,
            "line": {"color": shade, "width": 1.2},
        },
        **axes,
    }
    if words:
        trace |= {"text": list(words)}
    if bars is not None:
        trace["error_y"] = {
            "type": "data",
            "symmetric": False,
            "arrayminus": numbers(bars[0]),
            "array": numbers(bars[1]),
            "color": shade,
            "thickness": 1.2,
            "width": 3,
        }
    return trace


def straight(name: str, axes: Json, x: Values, y: Values, *, shade: str = "@reference", legend: bool = True) -> Json:
    """Return a dotted reference line through two points."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": numbers(x),
        "y": numbers(y),
        "name": name,
        "legendgroup": name,
        "showlegend": legend,
        "line": {"color": shade, "width": 1.5, "dash": "dot"},
        **axes,
    }
