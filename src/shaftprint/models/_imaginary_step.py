"""Derivatives of real formulas by an imaginary step, exact to the last digits.

``f(x + i h) = f(x) + i h f'(x) - ...``: with ``h`` so small that its square is lost in rounding, the imaginary part
over ``h`` is the derivative, and no difference is formed that would lose digits (Squire and Trapp, Using complex
variables to estimate derivatives of real functions, 1998). The formula must be one of arithmetic and NumPy
functions: ``abs`` drops the imaginary part, ``min`` and ``if`` refuse it.
"""

import warnings
from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray

_Result = TypeVar("_Result")

IMAGINARY_STEP = 1e-30
NOT_DIFFERENTIABLE = (TypeError, np.exceptions.ComplexWarning)
"""Errors of a formula that cannot take complex numbers."""


def stepped(formula: Callable[..., _Result], values: Sequence[FloatArray | float], index: int) -> _Result:
    """Return what a formula gives with the imaginary step on one of its values.

    A formula that cannot take complex numbers raises one of ``NOT_DIFFERENTIABLE``.
    """
    moved = [value + 1j * IMAGINARY_STEP if i == index else value for i, value in enumerate(values)]
    with warnings.catch_warnings():
        warnings.simplefilter("error", np.exceptions.ComplexWarning)
        return formula(*moved)


def slope(result: ArrayLike) -> FloatArray:
    """Return the derivative that a result of :func:`stepped` carries."""
    return np.asarray(np.imag(result) / IMAGINARY_STEP)
