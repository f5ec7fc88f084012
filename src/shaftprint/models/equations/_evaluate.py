"""Values of formulas with NumPy, for many points at once."""

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.models.equations._calculus import postorder
from shaftprint.models.equations._formula import Formula

# Real; complex only where a derivative is checked by a complex step.
Array: TypeAlias = FloatArray
Leaves: TypeAlias = Mapping[tuple[str, int], ArrayLike]

_FUNCTIONS = {
    "add": np.add,
    "multiply": np.multiply,
    "divide": np.divide,
    "sqrt": np.sqrt,
    "exp": np.exp,
    "log": np.log,
    "sin": np.sin,
    "cos": np.cos,
    "tanh": np.tanh,
}


def evaluate(formulas: Sequence[Formula], leaves: Leaves) -> list[Array]:
    """Return the values of formulas.

    ``leaves``: values of leaves by kind and place, such as ``("state", 0)``, of shapes that broadcast; real or complex.
    """
    values: dict[int, Array] = {}
    with np.errstate(all="ignore"):
        for node in postorder(formulas):
            if node.operation == "number":
                values[id(node)] = np.asarray(node.value)
            elif not node.of:
                values[id(node)] = np.asarray(leaves[node.operation, node.place])
            else:
                values[id(node)] = _value(node, [values[id(part)] for part in node.of])
    return [values[id(formula)] for formula in formulas]


def _value(node: Formula, of: list[Array]) -> Array:
    # an ordered comparison of complex numbers, as of a complex step, is one of their real parts
    real = [np.real(value) for value in of]
    match node.operation:
        case "minimum":
            return np.where(real[0] <= real[1], of[0], of[1])
        case "maximum":
            return np.where(real[1] <= real[0], of[0], of[1])
        case "choose":
            return np.where(real[0] <= real[1], of[2], of[3])
        case "absolute":
            return np.where(real[0] <= 0.0, -of[0], of[0])
        case "power":
            return np.asarray(of[0] ** node.value)
        case "table":
            return _table(of[0], real[0], node.points)
        case "table slope":
            return _table_slope(real[0], node.points)
    return np.asarray(_FUNCTIONS[node.operation](*of))


def _table(x: Array, real: Array, points: tuple[tuple[float, float], ...]) -> Array:
    places, values = np.array(points).T
    corner = _before(places, real)
    slope = _table_slope(real, points)
    inside = np.clip(real, places[0], places[-1])
    return np.asarray(values[corner] + (inside - places[corner]) * _raw_slope(corner, points) + slope * (x - real))


def _raw_slope(corner: IntArray, points: tuple[tuple[float, float], ...]) -> Array:
    places, values = np.array(points).T
    return np.asarray((np.diff(values) / np.diff(places))[corner])


def _table_slope(real: Array, points: tuple[tuple[float, float], ...]) -> Array:
    """Return the slope, zero beyond the ends; at a corner that of the stretch before."""
    places, _ = np.array(points).T
    corner = _before(places, real)
    outside = (real <= places[0]) | (real > places[-1])
    return np.where(outside, 0.0, _raw_slope(corner, points))


def _before(places: FloatArray, x: FloatArray) -> IntArray:
    """Return the stretch of a table in which each place lies."""
    return np.clip(np.searchsorted(places, x, side="left") - 1, 0, places.size - 2).astype(np.int64)
