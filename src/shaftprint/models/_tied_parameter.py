"""A parameter that follows from others: tied to them, or another form of one of them."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._expression import Gradient
from shaftprint.models._imaginary_step import NOT_DIFFERENTIABLE, slope, stepped


@dataclass(frozen=True, slots=True)
class Tie:
    """A formula for one parameter in terms of others, such as ``K_i = K_p / T_i``."""

    name: str
    """The parameter that follows."""
    of: Callable[..., FloatArray]
    """Its value from the values of the parameters that it is named after."""
    arguments: tuple[str, ...]
    """Names of those parameters, in the order in which the formula takes them."""

    @classmethod
    def from_formula(cls, name: str, formula: Callable[..., FloatArray]) -> "Tie":
        """Return the tie of a formula whose argument names are parameter names.

        Raises
        ------
        StructureError
            If it is no formula.
        """
        if not callable(formula):
            raise StructureError(
                f"tied parameter {name}: expected a formula such as lambda K: 2.0 * K, found {formula!r}; hold a "
                "parameter at a number with held_at()."
            )
        return cls(name=name, of=formula, arguments=tuple(inspect.signature(formula).parameters))

    def value(self, values: Mapping[str, FloatArray]) -> FloatArray:
        """Return the value from all independent values by name."""
        return self.of(*(values[name] for name in self.arguments))

    def slope(self, values: Mapping[str, FloatArray], to: str) -> FloatArray:
        """Return the derivative to one of the arguments, exact for formulas of arithmetic and NumPy functions.

        Raises
        ------
        StructureError
            If the formula cannot take complex numbers.
        """
        try:
            return slope(stepped(self.of, [values[name] for name in self.arguments], self.arguments.index(to)))
        except NOT_DIFFERENTIABLE as error:
            raise StructureError(
                f"tied parameter {self.name}: its formula could not be differentiated to {to} ({error}); use "
                "arithmetic and NumPy functions only."
            ) from None


def through_ties(ties: Sequence[Tie], slopes: Gradient, values: Mapping[str, FloatArray]) -> Gradient:
    """Return derivatives to independent parameters: those that reach the response through a tie are added.

    ``ties``: parameters that follow. ``slopes``: derivatives of a response to the parameters of its blocks, tied ones
    included. ``values``: independent parameters by name, each of shape (..., 1).
    """
    gradient = dict(slopes)
    for tie in ties:
        for argument in tie.arguments:
            if tie.name in slopes:
                through = slopes[tie.name] * tie.slope(values, argument)
                gradient[argument] = gradient[argument] + through if argument in gradient else through
    return gradient
