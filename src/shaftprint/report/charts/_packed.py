"""Numbers as they travel to the page: few digits, or 16 bits each where there are many."""

import base64
import math
from typing import Any, TypeAlias

import numpy as np

from shaftprint.arrays import FloatArray

Json: TypeAlias = dict[str, Any]

# Digits of a number in the data of the page; a screen shows four.
DIGITS = 6
# A longer list is packed.
MANY = 400
# Steps between the lowest and the highest value of a packed list, and the number that stands for none.
STEPS = 65_000
GAP = -32_768
# Distances that differ by less than this share are even.
EVEN = 1e-6


def numbers(values: FloatArray) -> list[float | None]:
    """Return numbers rounded to a few significant digits; None where one is not finite."""
    return [_rounded(value) for value in np.asarray(values, dtype=np.float64).tolist()]


def packed(values: FloatArray) -> Json:
    """Return a long list as whole numbers of 16 bits in base 64, ``value = offset + scale * number``.

    A screen of 4,000 dots shows a sixteenth of these steps. Not a number is a gap in the line.
    """
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
    scale = (high - low) / STEPS or 1.0
    counts = np.full(values.shape, GAP, dtype="<i2")
    counts[np.isfinite(values)] = np.round((finite - low) / scale) - STEPS // 2
    offset = low + scale * (STEPS // 2)
    return {"int16": base64.b64encode(counts.tobytes()).decode(), "scale": scale, "offset": offset}


def line_data(x: FloatArray, y: FloatArray) -> Json:
    """Return the points of a line; evenly spaced ones as first and distance, which halves a long list."""
    if x.size <= MANY:
        return {"x": numbers(x), "y": numbers(y)}
    gaps = np.diff(x)
    if np.ptp(gaps) < EVEN * abs(gaps.mean()):
        return {"x0": float(x[0]), "dx": float((x[-1] - x[0]) / (x.size - 1)), "y": packed(y)}
    return {"x": packed(x), "y": packed(y)}


def plain_json(content: object) -> object:
    """Return content that JSON has: numbers of NumPy as Python's, none that is not finite, tuples as lists.

    Raises TypeError if there is anything else.
    """
    match content:
        case np.generic():
            return plain_json(content.item())
        case dict():
            return {str(key): plain_json(value) for key, value in content.items()}
        case str() | bool() | int() | None:
            return content
        case float():
            return content if math.isfinite(content) else None
        case np.ndarray() | list() | tuple():
            return [plain_json(value) for value in content]
        case _:
            raise TypeError(f"chart: expected text, numbers and lists, found {type(content).__name__}.")


def _rounded(value: float) -> float | None:
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
