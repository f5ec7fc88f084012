"""Composition of blocks into responses: products, sums, feedback, each with its exact gradient.

An expression is a tree of blocks. Its response at ``s`` and the derivatives of that response with respect to the
parameters are found in one walk (forward differentiation)::

    series      d(G H)      = dG H + G dH
    parallel    d(G + H)    = dG + dH
    inverse     d(1 / G)    = -dG / G^2
    feedback    S = 1 / (1 + L),   dS = -S^2 dL
    closed loop T = G / (1 + G H), dT = S^2 dG - T^2 dH

A parameter that occurs in several blocks is one parameter: its derivatives add up. A block that occurs in several
places of one walk is evaluated once.
"""

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from numbers import Real
from typing import TypeAlias, Union

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._parameter import Parameter

Values: TypeAlias = Mapping[str, FloatArray]
Gradient: TypeAlias = dict[str, ComplexArray]
Dual: TypeAlias = tuple[ComplexArray, Gradient]
Operand: TypeAlias = Union["Expression", float]
Polynomials: TypeAlias = tuple[NDArray[np.floating], NDArray[np.floating]]


@dataclass(slots=True)
class Walk:
    """One evaluation: where, at which parameter values, with derivatives to which parameters."""

    s: ComplexArray
    """Laplace variable [rad/s], shape (frequencies,)."""
    values: Values
    """Parameter values by name, each of shape (..., 1)."""
    wanted: Collection[str]
    """Names of the parameters whose derivatives are wanted."""
    duals: "dict[int, Dual]" = field(default_factory=dict)
    """Results of this walk by node."""

    def dual(self, node: "Expression") -> Dual:
        """Return value and gradient of a node, evaluated at most once a walk."""
        dual = self.duals.get(id(node))
        if dual is None:
            dual = self.duals[id(node)] = node.evaluate(self)
        return dual


class Expression(ABC):
    """A response made of blocks; composed with ``* + - /``, numbers among them, and with ``feedback``."""

    __slots__ = ()

    @abstractmethod
    def evaluate(self, walk: Walk) -> Dual:
        """Return the response, shape (..., frequencies), and its derivatives by parameter name."""

    @abstractmethod
    def children(self) -> "tuple[Expression, ...]":
        """Return the expressions of which this one is made."""

    @abstractmethod
    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Return numerator and denominator in ``s``, highest power first; None where there is a delay."""

    # numpy's numbers would otherwise take an expression for an array of one
    __array_ufunc__ = None

    def __mul__(self, other: "Operand") -> "Expression":
        """Put two expressions in series."""
        return NotImplemented if (right := _operand(other)) is None else Series(self, right)

    def __rmul__(self, other: "Operand") -> "Expression":
        """Put a number before an expression."""
        return NotImplemented if (left := _operand(other)) is None else Series(left, self)

    def __add__(self, other: "Operand") -> "Expression":
        """Put two expressions in parallel."""
        return NotImplemented if (right := _operand(other)) is None else Parallel(self, right)

    def __radd__(self, other: "Operand") -> "Expression":
        """Put a number in parallel with an expression."""
        return NotImplemented if (left := _operand(other)) is None else Parallel(left, self)

    def __neg__(self) -> "Expression":
        """Change the sign."""
        return Series(Constant(-1.0), self)

    def __sub__(self, other: "Operand") -> "Expression":
        """Return the difference."""
        return NotImplemented if (right := _operand(other)) is None else Parallel(self, -right)

    def __rsub__(self, other: "Operand") -> "Expression":
        """Return the difference to a number."""
        return NotImplemented if (left := _operand(other)) is None else Parallel(left, -self)

    def __truediv__(self, other: "Operand") -> "Expression":
        """Put the inverse of the second expression behind the first."""
        return NotImplemented if (right := _operand(other)) is None else Series(self, Inverse(right))

    def __rtruediv__(self, other: "Operand") -> "Expression":
        """Put a number before the inverse."""
        return NotImplemented if (left := _operand(other)) is None else Series(left, Inverse(self))

    def nodes(self) -> "Iterator[Expression]":
        """Walk over this expression and all below it, children first, each object once."""
        seen: set[int] = set()
        yield from _nodes(self, seen)


def _operand(other: "Operand") -> Expression | None:
    """Return an operand as an expression; None for what is neither expression nor number."""
    if isinstance(other, Parameter):
        raise StructureError(f"{other.name} is a parameter, not a block: write Gain({other.name}).")
    if isinstance(other, Real):
        return Constant(float(other))
    return other if isinstance(other, Expression) else None


@dataclass(frozen=True, slots=True, eq=False)
class Constant(Expression):
    """A fixed number, such as the 1 of ``1 - G``; a number combined with an expression becomes one."""

    number: float
    """The number, in the unit of the expression."""

    def evaluate(self, walk: Walk) -> Dual:
        """Return the number at every frequency."""
        return np.full(walk.s.shape, self.number, dtype=np.complex128), {}

    def children(self) -> tuple[Expression, ...]:
        """Return nothing."""
        return ()

    def polynomials(self, values: Mapping[str, float]) -> Polynomials:
        """Return the number over one."""
        return np.array([self.number]), np.array([1.0])


def is_nothing(expression: Expression) -> bool:
    """Return whether a response is the number 0: its input does not move its output."""
    return isinstance(expression, Constant) and expression.number == 0.0


def _nodes(node: Expression, seen: set[int]) -> Iterator[Expression]:
    if id(node) in seen:
        return
    seen.add(id(node))
    for child in node.children():
        yield from _nodes(child, seen)
    yield node


@dataclass(frozen=True, slots=True, eq=False)
class Series(Expression):
    """Two expressions one after the other: ``G H``."""

    first: Expression
    second: Expression

    def evaluate(self, walk: Walk) -> Dual:
        """Apply the product rule, or that of a closed loop where the second expression closes one around the first."""
        if isinstance(self.second, Sensitivity):
            back = self.second.behind(self.first)
            if back is not None:
                return self._closed(walk, back)
        g, dg = walk.dual(self.first)
        h, dh = walk.dual(self.second)
        gradient = {name: derivative * h for name, derivative in dg.items()}
        for name, derivative in dh.items():
            term = g * derivative
            gradient[name] = gradient[name] + term if name in gradient else term
        return g * h, gradient

    def _closed(self, walk: Walk, back: "tuple[Expression, ...]") -> Dual:
        """Return ``T = G / (1 + G H)`` and ``dT = S^2 dG - T^2 dH``: half the products of the rules one by one."""
        g, dg = walk.dual(self.first)
        loop, dh = g, Gradient()
        if back:
            h, dh = walk.dual(back[0])
            loop = g * h
        sensitivity = 1.0 / (1.0 + loop)
        closed = g * sensitivity
        square = sensitivity * sensitivity
        gradient = {name: square * derivative for name, derivative in dg.items()}
        square = -closed * closed
        for name, derivative in dh.items():
            term = square * derivative
            gradient[name] = gradient[name] + term if name in gradient else term
        return closed, gradient

    def children(self) -> tuple[Expression, ...]:
        """Return both expressions."""
        return (self.first, self.second)

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Multiply numerators and denominators; of a closed loop ``N_G D_H / (D_G D_H + N_G N_H)`` is left."""
        one, two = self.first.polynomials(values), self.second.polynomials(values)
        if one is None or two is None:
            return None
        back = self.second.behind(self.first) if isinstance(self.second, Sensitivity) else None
        if back is not None:
            after = back[0].polynomials(values) if back else (np.array([1.0]), np.array([1.0]))
            if after is None:
                return None
            return np.polymul(one[0], after[1]), _sum_of_products(one[1], after[1], one[0], after[0])
        return np.polymul(one[0], two[0]), np.polymul(one[1], two[1])


def _sum_of_products(
    a: NDArray[np.floating], b: NDArray[np.floating], c: NDArray[np.floating], d: NDArray[np.floating]
) -> NDArray[np.floating]:
    return np.asarray(np.polyadd(np.polymul(a, b), np.polymul(c, d)))


@dataclass(frozen=True, slots=True, eq=False)
class Parallel(Expression):
    """Two expressions side by side: ``G + H``."""

    first: Expression
    second: Expression

    def evaluate(self, walk: Walk) -> Dual:
        """Apply the sum rule."""
        g, dg = walk.dual(self.first)
        h, dh = walk.dual(self.second)
        gradient = dict(dg)
        for name, derivative in dh.items():
            gradient[name] = gradient[name] + derivative if name in gradient else derivative
        return g + h, gradient

    def children(self) -> tuple[Expression, ...]:
        """Return both expressions."""
        return (self.first, self.second)

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Bring both on one denominator."""
        one, two = self.first.polynomials(values), self.second.polynomials(values)
        if one is None or two is None:
            return None
        return _sum_of_products(one[0], two[1], two[0], one[1]), np.polymul(one[1], two[1])


@dataclass(frozen=True, slots=True, eq=False)
class Inverse(Expression):
    """The inverse ``1 / G``."""

    of: Expression
    """What is inverted."""

    def evaluate(self, walk: Walk) -> Dual:
        """Apply the quotient rule."""
        g, dg = walk.dual(self.of)
        inverse = 1.0 / g
        square = -inverse * inverse
        return inverse, {name: square * derivative for name, derivative in dg.items()}

    def children(self) -> tuple[Expression, ...]:
        """Return the expression that is inverted."""
        return (self.of,)

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Exchange numerator and denominator."""
        ratio = self.of.polynomials(values)
        return None if ratio is None else (ratio[1], ratio[0])


@dataclass(frozen=True, slots=True, eq=False)
class Sensitivity(Expression):
    """What feedback leaves of an error: ``S = 1 / (1 + L)`` for the loop gain ``L`` under negative feedback."""

    loop: Expression
    """The loop gain ``L``."""

    def evaluate(self, walk: Walk) -> Dual:
        """Apply ``dS = -S^2 dL``."""
        gain, dgain = walk.dual(self.loop)
        response = 1.0 / (1.0 + gain)
        square = -response * response
        return response, {name: square * derivative for name, derivative in dgain.items()}

    def behind(self, forward: Expression) -> tuple[Expression, ...] | None:
        """Return what follows an expression in the loop: nothing where it is all of it; None where it does not lead."""
        if self.loop is forward:
            return ()
        if isinstance(self.loop, Series) and self.loop.first is forward:
            return (self.loop.second,)
        return None

    def children(self) -> tuple[Expression, ...]:
        """Return the loop gain."""
        return (self.loop,)

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Return ``D / (D + N)`` for the loop gain ``N / D``."""
        ratio = self.loop.polynomials(values)
        return None if ratio is None else (ratio[1], np.polyadd(ratio[1], ratio[0]))


def feedback(forward: Expression, back: Expression | None = None) -> Expression:
    """Return the closed loop ``G / (1 + G H)`` under negative feedback; ``H`` is 1 where it is not given."""
    return forward * Sensitivity(forward if back is None else forward * back)
