"""Equations in time of a transfer function whose coefficients are formulas."""

from collections.abc import Sequence
from typing import TypeAlias

from shaftprint.errors import StructureError
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula, Number, as_formula, number

Coefficients: TypeAlias = list[Formula]
Ratio: TypeAlias = tuple[Coefficients, Coefficients]


def coefficients(values: Sequence[Number]) -> Coefficients:
    """Return a polynomial without leading zeros, highest power first."""
    formulas = [as_formula(value) for value in values]
    while len(formulas) > 1 and formulas[0].equals(0.0):
        del formulas[0]
    return formulas


def product(left: Coefficients, right: Coefficients) -> Coefficients:
    """Return the product of two polynomials."""
    terms: Coefficients = [number(0.0)] * (len(left) + len(right) - 1)
    for i, a in enumerate(left):
        for j, b in enumerate(right):
            terms[i + j] = terms[i + j] + a * b
    return coefficients(terms)


def total(left: Coefficients, right: Coefficients) -> Coefficients:
    """Return the sum of two polynomials."""
    size = max(len(left), len(right))
    padded = [[number(0.0)] * (size - len(part)) + part for part in (left, right)]
    return coefficients([a + b for a, b in zip(*padded, strict=True)])


def realised(flow: Flow, signal: Formula, ratio: Ratio, name: str) -> Formula:
    """Return what a transfer function makes of a signal.

    Observable canonical form: of ``y^(n) + a_1 y^(n-1) + ... = b_0 u^(n) + b_1 u^(n-1) + ...`` the states are what
    is integrated once, twice, ... into ``y = x_1 + b_0 u`` (Kailath, Linear Systems, 1980, section 2.1). Where the
    numerator is of higher order, the changes of the signal are formed from the equations, not from its values.

    ``ratio``: numerator and denominator, highest power first. ``name``: what to call the states. Raises StructureError
    if the denominator is zero.
    """
    top, bottom = coefficients(ratio[0]), coefficients(ratio[1])
    if bottom[0].equals(0.0):
        raise StructureError(f"equations of {name}: the denominator is zero; hold its parameters at other values.")
    ahead = number(0.0)
    while len(top) > len(bottom):
        order = len(top) - len(bottom)
        factor = top[0] / bottom[0]
        change = signal
        for _ in range(order):
            change = flow.change(change)
        ahead = ahead + factor * change
        subtracted = [factor * b for b in bottom] + [number(0.0)] * order
        top = [t - b for t, b in zip(top[1:], subtracted[1:], strict=True)]
        top = top if len(top) <= len(bottom) else coefficients(top)
    top = [number(0.0)] * (len(bottom) - len(top)) + top
    b = [part / bottom[0] for part in top]
    a = [part / bottom[0] for part in bottom]
    states = [flow.state(name) for _ in a[1:]]
    out = b[0] * signal + states[0] if states else b[0] * signal
    for i, state in enumerate(states, start=1):
        following = states[i] if i < len(states) else number(0.0)
        flow.rate(state, b[i] * signal - a[i] * out + following)
    return ahead + out
