"""Tail of the F distribution: the p-value of a squared distance whose covariance was estimated."""

import math

from shaftprint.identify.likelihood._chi_square import chi_square_tail

ITERATIONS = 10_000
PRECISION = 1e-15
TINY = 1e-300


def f_tail(value: float, numerator: float, denominator: float) -> float:
    """Return the probability that an F variable exceeds a value.

    It is the regularised incomplete beta function ``I_x(denominator / 2, numerator / 2)`` at
    ``x = denominator / (denominator + numerator value)``.

    Parameters
    ----------
    numerator, denominator
        Degrees of freedom; those of the denominator may be infinite.
    """
    if value <= 0.0:
        return 1.0
    if math.isinf(denominator):
        return chi_square_tail(numerator * value, numerator)
    a, b = 0.5 * denominator, 0.5 * numerator
    x = denominator / (denominator + numerator * value)
    # 1 - x without the loss of its digits where x is close to 1.
    rest = numerator * value / (denominator + numerator * value)
    log_beta = math.lgamma(a) + math.lgamma(b) - math.lgamma(a + b)
    front = math.exp(a * math.log(x) + b * math.log(rest) - log_beta)
    if x < (a + 1.0) / (a + b + 2.0):
        return front * _beta_fraction(a, b, x) / a
    return max(0.0, 1.0 - front * _beta_fraction(b, a, rest) / b)


def _beta_fraction(a: float, b: float, x: float) -> float:
    """Return the continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz' method."""
    c, d = 1.0, 1.0 / _not_zero(1.0 - (a + b) * x / (a + 1.0))
    total = d
    for k in range(1, ITERATIONS):
        even = k * (b - k) * x / ((a + 2 * k - 1.0) * (a + 2 * k))
        odd = -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 2 * k + 1.0))
        for top in (even, odd):
            d = 1.0 / _not_zero(1.0 + top * d)
            c = _not_zero(1.0 + top / c)
            total *= c * d
        if abs(c * d - 1.0) < PRECISION:
            break
    return total


def _not_zero(value: float) -> float:
    return value if abs(value) > TINY else TINY
