"""An interactive figure as plain data, in the terms of plotly: traces, layout, and colours by the name of their part.

A colour is written as ``@0`` to ``@5`` for the lines in order of use, ``@0~`` for the band around one, and
``@data``, ``@ink``, ``@grid``, ``@reference``, ``@soft`` and ``@paper`` for the rest: the page puts in those of its
light or dark look.
"""

import base64
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray

Json: TypeAlias = dict[str, Any]

# Kinds of traces that a report may draw: plotly's script on the page has no others.
TRACE_TYPES = ("bar", "scatter")
# Digits of a number in the data of the page; a screen shows four.
DIGITS = 6
# Steps between the lowest and the highest value of a packed signal, and the number that stands for none.
STEPS = 65_000
GAP = -32_768


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Plot:
    """An interactive figure."""

    traces: Sequence[Json]
    """Lines, points and bands, each as plotly takes it."""
    layout: Json
    """Axes and legend, as plotly takes them."""
    height_px: int = 520
    """Height on the page [px]."""

    def __post_init__(self) -> None:
        """Refuse traces that the page cannot draw."""
        for trace in self.traces:
            kind = trace.get("type", "scatter")
            if kind not in TRACE_TYPES:
                raise ValueError(
                    f"interactive figure: expected a trace of type {' or '.join(TRACE_TYPES)}, found {kind}."
                )

    def text(self) -> str:
        """Return the figure as JSON without numbers that are not finite, safe inside a script."""
        content = {"data": list(self.traces), "layout": self.layout, "height": self.height_px}
        text = json.dumps(_plain(content), separators=(",", ":"), allow_nan=False, ensure_ascii=False)
        # A name with a closing tag must not end the script that holds it; the other two end lines in old scripts.
        return text.replace("<", "\\u003c").replace("\u2028", "\\u2028").replace("\u2029", "\\u2029")


def numbers(values: FloatArray | Sequence[float], *, digits: int = DIGITS) -> list[float | None]:
    """Return numbers rounded to a few significant digits; None where one is not finite."""
    return [_rounded(value, digits) for value in np.asarray(values, dtype=np.float64).tolist()]


def packed(values: FloatArray) -> Json:
    """Return a long signal as whole numbers of 16 bits in base 64, ``value = offset + scale * number``.

    A screen of 4,000 dots shows a sixteenth of these steps. Not a number is a gap in the line.
    """
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    scale = (high - low) / STEPS or 1.0
    counts = np.full(values.shape, GAP, dtype="<i2")
    counts[np.isfinite(values)] = np.round((finite - low) / scale) - STEPS // 2
    offset = low + scale * (STEPS // 2)
    return {"int16": base64.b64encode(counts.tobytes()).decode(), "scale": scale, "offset": offset}


def _rounded(value: float, digits: int) -> float | None:
    return float(f"{value:.{digits}g}") if math.isfinite(value) else None


def _plain(content: object) -> object:
    """Return content that JSON has: numbers of NumPy as Python's, none that is not finite, tuples as lists."""
    match content:
        case np.generic():
            return _plain(content.item())
        case Mapping():
            return {str(key): _plain(value) for key, value in content.items()}
        case str() | bool() | int() | None:
            return content
        case float():
            return content if math.isfinite(content) else None
        case np.ndarray() | list() | tuple():
            return [_plain(value) for value in content]
        case _:
            raise TypeError(f"interactive figure: expected text, numbers and lists, found {type(content).__name__}.")
