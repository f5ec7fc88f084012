"""A chart for the page: what plotly draws, as JSON, made without importing plotly.

The traces are in the terms of plotly. Panels, axes and legend are in our own: the page lays them out by its width. A
colour is written as ``@`` and the name of its part, ``@0~`` for the band around a line and ``@=0.5`` for a field: the
page puts in those of its light or dark look.
"""

import json
import math
from typing import Any

import numpy as np

from shaftprint.arrays import runs_of
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
from shaftprint.report.charts._packed import Json, line_data, numbers, plain_json
from shaftprint.report.charts._text import Text, as_html, as_plain

# Kinds of traces that a report may draw: plotly's script on the page has no others.
TRACE_TYPES = ("bar", "scatter")
TEXTURE_PX = 7
SYMBOLS = {"x": "x-thin", "plus": "cross-thin"}
BAR_PX = 1.2
WORDS_PX = 6
ANCHORS: dict[str, Json] = {
    "right": {"xanchor": "left", "xshift": WORDS_PX},
    "left": {"xanchor": "right", "xshift": -WORDS_PX},
    "above": {"xanchor": "center", "yanchor": "bottom"},
}


def chart_script(chart: Chart) -> str:
    """Return a chart as JSON without numbers that are not finite, safe inside a script."""
    text = json.dumps(plain_json(chart_json(chart)), separators=(",", ":"), allow_nan=False, ensure_ascii=False)
    # A name with a closing tag must not end the script that holds it; the other two end lines in old scripts.
    return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def chart_json(chart: Chart) -> Json:
    """Return a chart in the page's terms."""
    named: set[str] = set()
    traces: list[Json] = []
    shapes: list[Json] = []
    words: list[Json] = []
    for place, panel in enumerate(chart.panels, start=1):
        axes = {"xaxis": f"x{place if place > 1 else ''}", "yaxis": f"y{place if place > 1 else ''}"}
        for mark in panel.marks:
            legend = _legend(getattr(mark, "name", ""), named)
            match mark:
                case Straight():
                    shapes.append(_straight(mark, axes) | legend)
                case Words():
                    words.append(_words(mark, panel, axes))
                case _:
                    traces.append(_trace(mark, panel) | legend | axes)
    return {
        "data": traces,
        "shapes": shapes,
        "words": words,
        "panels": [{"title": as_html(p.title), "x": _scale(p.x), "y": _scale(p.y)} for p in chart.panels],
        "columns": chart.columns,
        "heights": [chart.row_px(row) for row in range(chart.rows)],
        "linked": chart.linked,
        "square": chart.square,
        "legend": [len(as_plain(name)) for name in chart.legend],
    }


def _legend(name: Text, named: set[str]) -> Json:
    """Return the part of a mark in the legend: marks of one name have one entry, and go together."""
    letters = as_plain(name)
    if not letters:
        return {"showlegend": False}
    first = letters not in named
    named.add(letters)
    return {"name": as_html(name), "legendgroup": as_html(name), "showlegend": first}


def _scale(scale: Scale) -> Json:
    span = scale.span
    if span is not None and scale.log:
        span = (math.log10(span[0]), math.log10(span[1]))
    return {
        "title": as_html(scale.title),
        "log": scale.log,
        "span": None if span is None else [float(f"{end:.6g}") for end in span],
        "step": scale.step,
        "names": [as_html(name) for name in scale.names],
    }


def _trace(mark: Mark, panel: Panel) -> Json:
    match mark:
        case Line():
            return _line(mark, packs=not panel.x.log)
        case Band():
            return _band(mark)
        case Points():
            return _points(mark)
        case Bars():
            return _bars(mark)
        case Fields():
            return _fields(mark)
        case _:
            raise TypeError(f"chart: expected a mark with data, found {type(mark).__name__}.")


def _line(mark: Line, *, packs: bool) -> Json:
    data = line_data(mark.x, mark.y) if packs else {"x": numbers(mark.x), "y": numbers(mark.y)}
    drawn: Json = {
        "type": "scatter",
        "mode": "lines+markers" if mark.marker else "lines",
        "line": {"color": _colour(mark.shade), "width": mark.width, "dash": mark.dash or dash_of(mark.shade)},
        **data,
    }
    if mark.marker:
        drawn["marker"] = {"color": _colour(mark.shade), "size": 6, "symbol": mark.marker}
    return drawn | _pointed(mark.words)


def _band(mark: Band) -> Json:
    known = np.isfinite(mark.lower) & np.isfinite(mark.upper)
    x: list[float | None] = []
    y: list[float | None] = []
    for piece in (slice(*run) for run in runs_of(known)):
        there = numbers(mark.x[piece])
        x += [*there, *reversed(there), None]
        y += [*numbers(mark.upper[piece]), *reversed(numbers(mark.lower[piece])), None]
    thin = f"{_colour(mark.shade)}~"
    return {
        "type": "scatter",
        "mode": "lines",
        "x": x[:-1],
        "y": y[:-1],
        "hoverinfo": "skip",
        "fill": "toself",
        "fillcolor": thin,
        "line": {"width": 0, "color": thin},
    }


def _points(mark: Points) -> Json:
    shade = _colour(mark.shade)
    marker = mark.marker or marker_of(mark.shade)
    drawn: Json = {
        "type": "scatter",
        "mode": "markers",
        "x": numbers(mark.x),
        "y": numbers(mark.y),
        "marker": {
            "color": shade if mark.filled else "@paper",
            "size": mark.size,
            "symbol": SYMBOLS.get(marker, marker),
            "line": {"color": shade, "width": 1.2},
        },
    }
    if mark.bars is not None:
        drawn[f"error_{mark.bars_along}"] = {
            "type": "data",
            "symmetric": False,
            "arrayminus": numbers(mark.bars[0]),
            "array": numbers(mark.bars[1]),
            "color": shade,
            "thickness": BAR_PX,
            "width": 3,
        }
    return drawn | _pointed(mark.words)


def _bars(mark: Bars) -> Json:
    along, across = ("y", "x") if mark.upright else ("x", "y")
    texture, is_pale = texture_of(mark.shade)
    shade = _colour(mark.shade)
    ground, lines = ("@paper", shade) if is_pale else (shade, "@paper")
    return {
        "type": "bar",
        "orientation": "v" if mark.upright else "h",
        along: numbers(mark.lengths),
        across: numbers(mark.places),
        "base": numbers(mark.starts),
        "width": mark.width,
        "marker": {
            "color": shade,
            "pattern": {"shape": texture, "size": TEXTURE_PX, "solidity": 0.2, "bgcolor": ground, "fgcolor": lines},
        },
        "hovertemplate": f"%{{customdata:.3~g}}<extra>{as_html(mark.name)}</extra>",
        "customdata": numbers(mark.lengths),
    }


def _fields(mark: Fields) -> Json:
    """Return a matrix as bars of height 1: an image of it would have to be allowed by the page's policy."""
    rows, columns = (places.ravel().astype(np.float64) for places in np.indices(mark.values.shape))
    values = mark.values.ravel()
    known = np.isfinite(values)
    return {
        "type": "bar",
        "x": columns.tolist(),
        "y": [1.0] * values.size,
        "base": (rows - 0.5).tolist(),
        "width": 1.0,
        "marker": {"color": [f"@={v:.3f}" if k else "@paper" for v, k in zip(values, known, strict=True)]},
        "text": [word for row in mark.words for word in row],
        "textposition": "inside",
        "insidetextanchor": "middle",
        "textangle": 0,
        "constraintext": "none",
        "insidetextfont": {"color": [f"@on={v:.3f}" if k else "@ink" for v, k in zip(values, known, strict=True)]},
        "hovertemplate": "%{text}<extra></extra>",
    }


def _straight(mark: Straight, axes: Json) -> Json:
    upright = mark.axis == "x"
    ends = (
        {"x0": mark.at, "x1": mark.at, "y0": 0, "y1": 1}
        if upright
        else {"x0": 0, "x1": 1, "y0": mark.at, "y1": mark.at}
    )
    return {
        "type": "line",
        "xref": axes["xaxis"] + ("" if upright else " domain"),
        "yref": axes["yaxis"] + (" domain" if upright else ""),
        "line": {"color": _colour(mark.shade), "width": 1.5, "dash": mark.dash},
        **ends,
    }


def _words(mark: Words, panel: Panel, axes: Json) -> Json:
    return {
        "x": math.log10(mark.x) if panel.x.log else mark.x,
        "y": math.log10(mark.y) if panel.y.log else mark.y,
        "xref": axes["xaxis"],
        "yref": axes["yaxis"],
        "text": as_html(mark.text),
        "showarrow": False,
        **ANCHORS[mark.anchor],
    }


def _pointed(words: Any) -> Json:
    return {"text": list(words)} if words else {}


def _colour(shade: Shade) -> str:
    return f"@{shade % COLOURS}" if isinstance(shade, int) else f"@{shade}"
