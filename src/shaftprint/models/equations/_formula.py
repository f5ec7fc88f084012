"""Scalar formulas of the time domain: what an equation is made of, before any number is known.

A block states its equations as formulas; from them come the compiled simulation, its derivatives, the
linearisation and the source text of an exported model. A formula is a node of a graph: an operation on other
formulas, or a leaf: a number, a parameter, an input, a state, or the past of a signal.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from numbers import Real
from typing import TypeAlias, Union

import numpy as np

from shaftprint.errors import StructureError

Number: TypeAlias = Union["Formula", float]


@dataclass(frozen=True, slots=True, eq=False)
class Formula:
    """A scalar formula; composed with ``+ - * / **`` and the functions of this module."""

    operation: str
    """``add``, ``multiply``, ``divide``, ``power``, ``minimum`` ..., or the kind of leaf."""
    of: tuple["Formula", ...] = ()
    """What it operates on."""
    name: str = ""
    """Name of a leaf; of a table the name of nothing."""
    value: float = 0.0
    """Number of a leaf that is one; exponent of a power."""
    place: int = 0
    """Number of a state, past or unknown."""
    points: tuple[tuple[float, float], ...] = field(default=())
    """Corner points of a table, ascending."""

    def __add__(self, other: Number) -> "Formula":
        """Return the sum."""
        return NotImplemented if (right := _formula(other)) is None else add(self, right)

    def __radd__(self, other: Number) -> "Formula":
        """Return the sum."""
        return NotImplemented if (left := _formula(other)) is None else add(left, self)

    def __sub__(self, other: Number) -> "Formula":
        """Return the difference."""
        return NotImplemented if (right := _formula(other)) is None else add(self, -right)

    def __rsub__(self, other: Number) -> "Formula":
        """Return the difference."""
        return NotImplemented if (left := _formula(other)) is None else add(left, -self)

    def __neg__(self) -> "Formula":
        """Return the opposite."""
        return multiply(number(-1.0), self)

    def __pos__(self) -> "Formula":
        """Return the formula."""
        return self

    def __mul__(self, other: Number) -> "Formula":
        """Return the product."""
        return NotImplemented if (right := _formula(other)) is None else multiply(self, right)

    def __rmul__(self, other: Number) -> "Formula":
        """Return the product."""
        return NotImplemented if (left := _formula(other)) is None else multiply(left, self)

    def __truediv__(self, other: Number) -> "Formula":
        """Return the quotient."""
        return NotImplemented if (right := _formula(other)) is None else divide(self, right)

    def __rtruediv__(self, other: Number) -> "Formula":
        """Return the quotient."""
        return NotImplemented if (left := _formula(other)) is None else divide(left, self)

    def __pow__(self, exponent: float) -> "Formula":
        """Return a power with a fixed exponent."""
        if not isinstance(exponent, Real):
            return NotImplemented
        return power(self, float(exponent))

    def __bool__(self) -> bool:
        """Refuse: a formula is neither true nor false.

        Raises StructureError always.
        """
        raise StructureError(
            "equations: a formula was compared or used in an 'if'; use minimum, maximum, clip or choose instead."
        )

    def __lt__(self, other: Number) -> bool:
        """Refuse, see ``__bool__``."""
        return bool(self)

    __le__ = __gt__ = __ge__ = __lt__

    # numpy calls these on objects, so that formulas may be written with np.sqrt and the like

    def sqrt(self) -> "Formula":
        """Return the square root."""
        return _of("sqrt", self)

    def exp(self) -> "Formula":
        """Return the exponential."""
        return _of("exp", self)

    def log(self) -> "Formula":
        """Return the natural logarithm."""
        return _of("log", self)

    def sin(self) -> "Formula":
        """Return the sine."""
        return _of("sin", self)

    def cos(self) -> "Formula":
        """Return the cosine."""
        return _of("cos", self)

    def tanh(self) -> "Formula":
        """Return the hyperbolic tangent."""
        return _of("tanh", self)

    def __abs__(self) -> "Formula":
        """Return the absolute value."""
        return _of("absolute", self)

    @property
    def is_number(self) -> bool:
        """Whether this is a plain number."""
        return self.operation == "number"

    def equals(self, value: float) -> bool:
        """Return whether this is the plain number given."""
        return self.operation == "number" and self.value == value


def number(value: float) -> Formula:
    """Return a plain number."""
    return Formula("number", value=float(value))


def as_formula(value: Number) -> Formula:
    """Return a number or a formula as a formula.

    Raises StructureError if it is neither.
    """
    formula = _formula(value)
    if formula is None:
        raise StructureError(f"equations: expected a formula or a number, found {value!r}.")
    return formula


def _formula(value: object) -> Formula | None:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        # what NumPy makes of one formula
        value = value.item()
    if isinstance(value, Formula):
        return value
    return number(float(value)) if isinstance(value, Real) else None


def add(left: Formula, right: Formula) -> Formula:
    """Return a sum, without zeros."""
    if left.is_number and right.is_number:
        return number(left.value + right.value)
    if left.equals(0.0):
        return right
    return left if right.equals(0.0) else Formula("add", (left, right))


def multiply(left: Formula, right: Formula) -> Formula:
    """Return a product, without factors one and zero; a number stands first."""
    if right.is_number and not left.is_number:
        left, right = right, left
    if left.is_number:
        if right.is_number:
            return number(left.value * right.value)
        if left.value == 0.0:
            return left
        if left.value == 1.0:
            return right
        if right.operation == "multiply" and right.of[0].is_number:
            return multiply(number(left.value * right.of[0].value), right.of[1])
    return Formula("multiply", (left, right))


def divide(left: Formula, right: Formula) -> Formula:
    """Return a quotient.

    Raises StructureError if the denominator is the number zero.
    """
    if right.equals(0.0):
        raise StructureError("equations: division by a formula that is zero; hold its parameters at other values.")
    if left.equals(0.0):
        return left
    return multiply(number(1.0 / right.value), left) if right.is_number else Formula("divide", (left, right))


def power(base: Formula, exponent: float) -> Formula:
    """Return a power with a fixed exponent."""
    if base.is_number:
        return number(base.value**exponent)
    if exponent in (0.0, 1.0):
        return base if exponent else number(1.0)
    return multiply(base, base) if exponent == 2.0 else Formula("power", (base,), value=exponent)


def minimum(left: Number, right: Number) -> Formula:
    """Return the smaller of two; where they are equal, the first."""
    return Formula("minimum", (as_formula(left), as_formula(right)))


def maximum(left: Number, right: Number) -> Formula:
    """Return the larger of two; where they are equal, the first."""
    return Formula("maximum", (as_formula(left), as_formula(right)))


def clip(value: Number, lowest: Number, highest: Number) -> Formula:
    """Return a value held between two others."""
    return minimum(maximum(value, lowest), highest)


def choose(left: Number, right: Number, at_most: Number, above: Number) -> Formula:
    """Return ``at_most`` where ``left <= right``, otherwise ``above``."""
    return Formula("choose", (as_formula(left), as_formula(right), as_formula(at_most), as_formula(above)))


def table(value: Number, points: Sequence[tuple[float, float]]) -> Formula:
    """Return a piecewise linear function, constant beyond its ends.

    Parameters
    ----------
    points
        Corner points, ascending.

    Raises
    ------
    StructureError
        If there are fewer than two points, or they do not ascend.
    """
    corners = tuple((float(x), float(y)) for x, y in points)
    if len(corners) < 2 or any(b[0] <= a[0] for a, b in pairwise(corners)):
        raise StructureError(f"equations: expected a table of two or more ascending points, found {corners}.")
    return Formula("table", (as_formula(value),), points=corners)


def _of(operation: str, value: Formula) -> Formula:
    return Formula(operation, (value,))
