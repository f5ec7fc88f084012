"""The derivative of a block to one parameter, found without the block's own formula for it.

Of a rational block ``H = N / D`` it follows from the coefficients by the imaginary step,
``dH = (dN - H dD) / D``; of any other block, from two central differences. Either way some digits may be lost: where a
response hardly depends on a parameter, what is left is rounding. So both say where their result is certain.
"""

from collections.abc import Callable
from typing import TypeAlias, cast

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.models._block import Block
from shaftprint.models._expression import Polynomials
from shaftprint.models._imaginary_step import NOT_DIFFERENTIABLE, slope, stepped
from shaftprint.models._parameter import Parameter

Derivative: TypeAlias = tuple[ComplexArray, BoolArray]
"""Derivative, shape (sets, frequencies), and where it is certain."""

# Two central differences, with steps of these shares of a value, must agree before they are held against a formula,
# and rounding must be as small a share of a derivative: two that have lost all digits may agree by chance.
STEPS = (1e-4, 1e-5)
AGREEMENT = 1e-5
ROUNDING = float(np.finfo(np.float64).eps)
# A coefficient with an ``abs`` in it loses the imaginary step: its slope is then off by far more than this share.
SAME_SLOPE = 1e-3


def numerical_derivative(
    block: Block, s: ComplexArray, response: ComplexArray, values: tuple[FloatArray, ...], index: int
) -> Derivative:
    """Return the derivative of a block's response to its parameter number ``index``.

    ``s``: laplace variable [rad/s], shape (frequencies,). ``response``: response there, shape (sets, frequencies).
    ``values``: sets of the parameters, each of shape (sets, 1).
    """
    exact = []
    for row in range(response.shape[0]):
        at_row = _by_imaginary_step(block, s, [float(value[row, 0]) for value in values], index)
        if at_row is None:
            return _by_differences(block, s, response, values, index)
        exact.append(at_row)
    return np.array([derivative for derivative, _ in exact]), np.array([certain for _, certain in exact])


def _by_imaginary_step(block: Block, s: ComplexArray, values: list[float], index: int) -> Derivative | None:
    """Return the derivative at one set, shape (frequencies,); None where the coefficients do not give it."""
    if block.ratio(*values) is None:
        return None
    ratio = cast(Callable[..., Polynomials], block.ratio)
    try:
        top_slope, bottom_slope = (slope(part) for part in stepped(ratio, values, index))
    except NOT_DIFFERENTIABLE:
        return None
    step = float(_step(block.parameters[index], np.array(values[index]), min(STEPS)))
    if not _are_slopes((top_slope, bottom_slope), ratio, values, index, step):
        return None
    numerator, denominator = ratio(*values)
    bottom = np.polyval(denominator, s)
    response = np.polyval(numerator, s) / bottom
    derivative = (np.polyval(top_slope, s) - response * np.polyval(bottom_slope, s)) / bottom
    terms = np.polyval(np.abs(top_slope), np.abs(s)) + np.abs(response) * np.polyval(np.abs(bottom_slope), np.abs(s))
    return derivative, ROUNDING * terms <= AGREEMENT * np.abs(derivative * bottom)


def _are_slopes(
    slopes: Polynomials, ratio: Callable[..., Polynomials], values: list[float], index: int, step: float
) -> bool:
    """Return whether the imaginary step found what a central difference of the coefficients finds."""
    ahead, behind = (ratio(*values[:index], values[index] + side, *values[index + 1 :]) for side in (step, -step))
    for by_step, above, below in zip(slopes, ahead, behind, strict=True):
        difference = (above - below) / (2.0 * step)
        tolerance = SAME_SLOPE * np.abs(difference) + ROUNDING / AGREEMENT * np.abs(above) / step
        if not np.all(np.abs(by_step - difference) <= tolerance):
            return False
    return True


def _by_differences(
    block: Block, s: ComplexArray, response: ComplexArray, values: tuple[FloatArray, ...], index: int
) -> Derivative:
    parameter = block.parameters[index]

    def difference(step: FloatArray) -> ComplexArray:
        ahead, behind = (
            block.transfer(s, *values[:index], values[index] + side * step, *values[index + 1 :])
            for side in (1.0, -1.0)
        )
        return np.asarray((ahead - behind) / (2.0 * step))

    coarse, fine = (difference(_step(parameter, values[index], share)) for share in STEPS)
    certain = np.abs(coarse - fine) <= AGREEMENT * np.abs(coarse)
    smallest = _step(parameter, values[index], min(STEPS))
    certain &= ROUNDING * np.abs(response) <= AGREEMENT * smallest * np.abs(coarse)
    return coarse, certain


def _step(parameter: Parameter, value: FloatArray, share: float) -> FloatArray:
    """Return the step of a central difference in the parameter's unit, shape of the value."""
    width = parameter.upper - parameter.lower
    return np.asarray(share * np.maximum(np.abs(value), 1e-2 * width if np.isfinite(width) else 1e-2))
