"""A parameter that follows from others: tied to them, or another form of one of them."""

import inspect
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._expression import Gradient

# Imaginary step on a real formula: its square is lost beside 1, so that no digit of the derivative is.
IMAGINARY_STEP = 1e-30


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
        moved = (values[name] + 1j * IMAGINARY_STEP if name == to else values[name] for name in self.arguments)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", np.exceptions.ComplexWarning)
                return np.asarray(np.imag(self.of(*moved)) / IMAGINARY_STEP)
        except (TypeError, np.exceptions.ComplexWarning) as error:
            raise StructureError(
                f"tied parameter {self.name}: its formula could not be differentiated to {to} ({error}); use "
                "arithmetic and NumPy functions only."
            ) from None


def through_ties(ties: Sequence[Tie], slopes: Gradient, values: Mapping[str, FloatArray]) -> Gradient:
    """Return derivatives to independent parameters: those that reach the response through a tie are added.

    Parameters
    ----------
    ties
        Parameters that follow.
    slopes
        Derivatives of a response to the parameters of its blocks, tied ones included.
    values
        Independent parameters by name, each of shape (..., 1).
    """
    found = dict(slopes)
    for tie in ties:
        for argument in tie.arguments:
            if tie.name in slopes:
                through = slopes[tie.name] * tie.slope(values, argument)
                found[argument] = found[argument] + through if argument in found else through
    return found
