"""Tail of the chi-square distribution: the p-value of a sum of squares."""

import math

# Terms after which series and continued fraction have long settled, for up to a hundred thousand degrees of freedom.
TERMS = 100_000
TINY = 1e-300


def chi_square_tail(value: float, degrees_of_freedom: float) -> float:
    """Return the probability that a chi-square is larger: ``Q(k / 2, x / 2)``, the incomplete gamma function.

    Below its mean by the series, above it by the continued fraction (Press, Teukolsky, Vetterling and Flannery,
    Numerical Recipes, section 6.2), so that small probabilities keep all their digits.

    Parameters
    ----------
    value
        The chi-square.
    degrees_of_freedom
        Their number, not negative, not necessarily whole; without any the chi-square is 0.
    """
    half, shape = 0.5 * value, 0.5 * degrees_of_freedom
    if half <= 0.0:
        return 1.0
    if math.isinf(half) or shape == 0.0:
        return 0.0
    front = math.exp(shape * math.log(half) - half - math.lgamma(shape))
    if half < shape + 1.0:
        return max(0.0, 1.0 - front * _series(shape, half))
    return front * _fraction(shape, half)


def _series(shape: float, half: float) -> float:
    """Return ``sum of half^n / (shape (shape + 1) ... (shape + n))``."""
    term = total = 1.0 / shape
    for n in range(1, TERMS):
        term *= half / (shape + n)
        total += term
        if term < 1e-17 * total:
            break
    return total


def _fraction(shape: float, half: float) -> float:
    """Return the continued fraction of the upper incomplete gamma function by Lentz's method."""
    b = half + 1.0 - shape
    c, d = 1.0 / TINY, 1.0 / b
    product = d
    for n in range(1, TERMS):
        a = n * (shape - n)
        b += 2.0
        d = a * d + b
        d = 1.0 / (d if abs(d) > TINY else TINY)
        c = b + a / c
        c = c if abs(c) > TINY else TINY
        product *= c * d
        if abs(c * d - 1.0) < 1e-16:
            break
    return product
