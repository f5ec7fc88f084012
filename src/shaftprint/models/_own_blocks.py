"""Blocks that a user makes from a function, without a class."""

import inspect
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._expression import Polynomials
from shaftprint.models._imaginary_step import NOT_DIFFERENTIABLE, slope, stepped
from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._formula import Formula

Coefficients: TypeAlias = Callable[..., tuple[Sequence[ArrayLike], Sequence[ArrayLike]]]


@dataclass(frozen=True, slots=True, eq=False)
class FunctionBlock(Block):
    """Any response ``H(s, *values)``, with numerical derivatives.

    On its own it is taken as stable; a block with poles in the right half plane is a :class:`RationalBlock`.
    """

    function: Callable[..., ArrayLike]
    """Takes ``s``, shape (frequencies,), and each parameter, shape (..., 1); gives the response (..., frequencies)."""
    of: tuple[Parameter, ...]
    """Its parameters, in the order in which the function takes them."""

    def __post_init__(self) -> None:
        """Check that function and parameters belong together.

        Raises StructureError if they do not.
        """
        expect_function(self.function, ("s",), self.of)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters."""
        return self.of

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return what the function gives."""
        return np.asarray(self.function(s, *values), dtype=np.complex128)


@dataclass(frozen=True, slots=True, eq=False)
class RationalBlock(Block):
    """A transfer function ``N(s) / D(s)`` whose coefficients are formulas of physical parameters.

    From the formulas come the response, its exact derivatives and its poles. Derivatives of the coefficients are taken
    by an imaginary step: they use arithmetic and NumPy functions, but no ``abs``, ``min`` or ``if``.
    """

    coefficients: Coefficients
    """Takes the parameters, gives the coefficients of numerator and denominator, highest power first."""
    of: tuple[Parameter, ...]
    """Its parameters, in the order in which ``coefficients`` takes them."""

    def __post_init__(self) -> None:
        """Check that formulas and parameters belong together.

        Raises StructureError if they do not.
        """
        expect_function(self.coefficients, (), self.of)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters."""
        return self.of

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``N(s) / D(s)``."""
        numerator, denominator = self._lists(*values)
        return _polynomial(numerator, s) / _polynomial(denominator, s)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``(dN - H dD) / D`` for each parameter."""
        _, denominator = self._lists(*values)
        inverse = 1.0 / _polynomial(denominator, s)
        derivatives = []
        for index in range(len(values)):
            top, bottom = ([slope(coefficient) for coefficient in part] for part in self._stepped(index, values))
            derivatives.append((_polynomial(top, s) - response * _polynomial(bottom, s)) * inverse)
        return tuple(derivatives)

    def ratio(self, *values: float) -> Polynomials:
        """Return the coefficients."""
        numerator, denominator = self._lists(*values)
        # of formulas instead of numbers where the equations in time are wanted
        kind = object if any(isinstance(value, Formula) for value in values) else np.result_type(np.float64, *values)
        return np.array(numerator, dtype=kind), np.array(denominator, dtype=kind)

    def _lists(self, *values: ArrayLike) -> tuple[Sequence[ArrayLike], Sequence[ArrayLike]]:
        """Return both lists of coefficients.

        Raises StructureError if there are not two, each a list: an array alone would be taken for the list of its rows.
        """
        lists = self.coefficients(*values)
        if isinstance(lists, list | tuple) and [isinstance(part, list | tuple) for part in lists] == [True, True]:
            return lists[0], lists[1]
        raise StructureError(
            f"{block_words(self.of)}: expected two lists, numerator and denominator, highest power first, such as "
            "([K], [T, 1.0])."
        )

    def _stepped(self, index: int, values: tuple[FloatArray, ...]) -> tuple[Sequence[ArrayLike], Sequence[ArrayLike]]:
        try:
            return stepped(self._lists, values, index)
        except NOT_DIFFERENTIABLE as error:
            raise StructureError(
                f"{block_words(self.of)}: the coefficients could not be differentiated to "
                f"{self.of[index].name} ({error}): use arithmetic and NumPy functions only, or a FunctionBlock."
            ) from None


def expect_function(function: object, first: tuple[str, ...], of: Iterable[Parameter] | Parameter) -> None:
    """Check that a function takes as many values as there are parameters.

    ``first``: what it takes before the parameters. ``of``: parameters, in the order in which it takes them. Raises
    StructureError if it does not, or the parameters are not parameters.
    """
    if isinstance(of, Parameter):
        raise StructureError(f"block of {of.name}: expected a tuple of parameters, such as ({of.name},).")
    parameters: tuple[Parameter, ...] = tuple(of)
    if not callable(function):
        raise StructureError(f"{block_words(parameters)}: expected a function, found {function!r}.")
    if isinstance(function, np.ufunc):
        return
    arguments = inspect.signature(function).parameters.values()
    if any(p.kind is inspect.Parameter.VAR_POSITIONAL for p in arguments):
        return
    needed = [p.name for p in arguments if p.default is inspect.Parameter.empty]
    if not len(needed) <= len(first) + len(parameters) <= len(arguments):
        wanted, actual = (", ".join(names) or "nothing" for names in ((*first, *(p.name for p in parameters)), needed))
        raise StructureError(f"{block_words(parameters)}: expected a function of {wanted}, found one of {actual}.")


def block_words(parameters: Sequence[Parameter]) -> str:
    """Return what to call a block of some parameters."""
    names = ", ".join(getattr(p, "name", repr(p)) for p in parameters)
    return f"block of {names}" if names else "block without parameters"


def _polynomial(coefficients: Sequence[ArrayLike], s: ComplexArray) -> ComplexArray:
    """Return the value of a polynomial with coefficients of shape (..., 1) at every ``s``, by Horner's rule."""
    value = np.zeros_like(s)
    for coefficient in coefficients:
        value = value * s + np.asarray(coefficient)
    return value
