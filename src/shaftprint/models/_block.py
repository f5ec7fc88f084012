"""A building block: the leaf of an expression, with its parameters."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._expression import Dual, Expression, Gradient, Polynomials, Walk
from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula
from shaftprint.models.equations._realisation import Ratio, coefficients, realised

# Share of a parameter by which it is moved to find a derivative: errors of rounding and of the formula are alike.
STEP = 1e-3


class Block(Expression):
    """A building block: a transfer function of a few parameters, with its derivatives.

    A block of one's own is a frozen dataclass with :class:`Parameter` fields, the property ``parameters`` and the
    method ``transfer``; ``derivatives`` too where exact ones are wanted instead of numerical ones, and ``ratio`` if it
    is rational in ``s``. ``RationalBlock`` and ``FunctionBlock`` make one from a function.
    """

    __slots__ = ()

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """Parameters in the order in which ``transfer`` takes them."""

    @abstractmethod
    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the transfer function at ``s``; values have shape (..., 1), the result (..., frequencies)."""

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the derivative of ``transfer`` to each parameter; ``response`` is its value.

        Central differences of fourth order where a block has no formula for them: right to about eleven digits. They
        ask for values a thousandth outside the bounds.
        """
        return tuple(self._difference(s, values, index) for index in range(len(values)))

    def _difference(self, s: ComplexArray, values: tuple[FloatArray, ...], index: int) -> ComplexArray:
        parameter, value = self.parameters[index], values[index]
        step = STEP * np.maximum(np.abs(value), STEP * (parameter.upper - parameter.lower))

        def at(steps: float) -> ComplexArray:
            return self.transfer(s, *values[:index], value + steps * step, *values[index + 1 :])

        return np.asarray((8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step))

    def ratio(self, *values: float) -> Polynomials | None:
        """Return numerator and denominator in ``s``, highest power first, or None where it is not rational."""
        return None

    @property
    def is_linear(self) -> bool:
        """Whether the block does to a sum of signals what it does to each."""
        return True

    def flow(self, flow: Flow, signal: Formula) -> Formula:
        """Return what the block makes of a signal in time; from its ratio where it states no equations.

        Raises
        ------
        StructureError
            If it has neither.
        """
        ratio = self.coefficients_in(flow)
        if ratio is None:
            raise StructureError(
                f"{type(self).__name__} of {', '.join(p.name for p in self.parameters) or 'no parameters'} has no "
                "equations in time: give it a method flow, or make it a RationalBlock."
            )
        return realised(flow, signal, ratio, type(self).__name__)

    def coefficients_in(self, flow: Flow) -> Ratio | None:
        """Return numerator and denominator with formulas as coefficients; None where it is not rational."""
        # formulas take the place of numbers
        values: list[Any] = [flow.parameter(parameter.name) for parameter in self.parameters]
        ratio = self.ratio(*values)
        return None if ratio is None else (coefficients(list(ratio[0])), coefficients(list(ratio[1])))

    def evaluate(self, walk: Walk) -> Dual:
        """Return the response and the wanted derivatives."""
        values = [walk.values[parameter.name] for parameter in self.parameters]
        response = self.transfer(walk.s, *values)
        names = [parameter.name for parameter in self.parameters]
        if not any(name in walk.wanted for name in names):
            return response, {}
        gradient: Gradient = {}
        for name, derivative in zip(names, self.derivatives(walk.s, response, *values), strict=True):
            if name in walk.wanted:
                gradient[name] = gradient[name] + derivative if name in gradient else derivative
        return response, gradient

    def children(self) -> tuple[Expression, ...]:
        """Return nothing: a block is a leaf."""
        return ()

    def polynomials(self, values: Mapping[str, float]) -> Polynomials | None:
        """Return numerator and denominator at the given values."""
        return self.ratio(*(values[parameter.name] for parameter in self.parameters))
