"""Tails and quantiles of the normal, chi-square, F and Student's t distribution: one way to each, without scipy.

``scipy.special`` takes several times as long to load as everything that a fit needs. Its values are those of the tests.
"""

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from shaftprint.arrays import FloatArray

NORMAL_95 = 1.959963984540054
"""So many standard deviations on either side hold 95 % of a normal distribution."""

# Terms after which series and continued fractions have long settled, for up to a hundred thousand degrees of freedom.
_TERMS = 100_000
_TINY = 1e-300
# As many as halving takes, should it come to that; ten are usual.
_STEPS = 60
# Two steps that end at one number, but for the rounding of the tail.
_SAME = 4e-16

_erfc = np.frompyfunc(math.erfc, 1, 1)


def normal_cdf(values: FloatArray | float) -> FloatArray:
    """Return the probability that a standard normal variable is smaller, of the shape of the values."""
    return 0.5 * np.asarray(_erfc(-values / math.sqrt(2.0)), dtype=np.float64)


# the figures of a report ask for the same few degrees of freedom hundreds of times, each a millisecond's bisection
@cache
def deviations(coverage: float, degrees_of_freedom: float = math.inf) -> float:
    """Return how many standard deviations on either side hold a share of a normal distribution.

    Parameters
    ----------
    coverage
        The share, between 0 and 1, such as 0.95.
    degrees_of_freedom
        Those of the standard deviation, where it was estimated: then the distribution is Student's t.

    Raises
    ------
    ValueError
        If the share is not between 0 and 1.
    """
    if not 0.0 < coverage < 1.0:
        raise ValueError(f"coverage: expected a share between 0 and 1, found {coverage}.")
    if math.isinf(degrees_of_freedom):
        return _quantile(lambda value: math.erfc(value / math.sqrt(2.0)), 1.0 - coverage)
    return _quantile(lambda value: f_tail(value**2, 1.0, degrees_of_freedom), 1.0 - coverage)


def deviations_passed(share: float) -> float:
    """Return the standard deviations that a normal number passes, to one side, with a probability below a half."""
    return deviations(1.0 - 2.0 * share)


def chi_square_quantile(coverage: float, degrees_of_freedom: float) -> float:
    """Return the value below which a share of a chi-square distribution lies."""
    return _quantile(lambda value: chi_square_tail(value, degrees_of_freedom), 1.0 - coverage)


def _quantile(tail: Callable[[float], float], share: float) -> float:
    """Return the positive value beyond which a share of a distribution lies."""
    low, high = 0.0, 1.0
    # over the logarithm a tail is nearly straight: the secant of a bracket finds it in a few steps
    below, above = -math.log(share), _above(tail(high), share)
    while above > 0.0:
        low, high, below = high, 2.0 * high, above
        above = _above(tail(high), share)
    before, side = low, 0
    for _ in range(_STEPS):
        middle = low + (high - low) * below / (below - above) if above > -math.inf else 0.5 * (low + high)
        if abs(middle - before) <= _SAME * middle:
            return middle
        value, before = _above(tail(middle), share), middle
        # Illinois rule: an end that stays twice counts half, so that both close in
        if value > 0.0:
            low, below, above, side = middle, value, above * (0.5 if side > 0 else 1.0), 1
        else:
            high, above, below, side = middle, value, below * (0.5 if side < 0 else 1.0), -1
    return 0.5 * (low + high)


def _above(probability: float, share: float) -> float:
    """Return by how much a probability is above a share, over their logarithms."""
    return math.log(probability / share) if probability > 0.0 else -math.inf


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
        return max(0.0, 1.0 - front * _gamma_series(shape, half))
    return front * _gamma_fraction(shape, half)


def _gamma_series(shape: float, half: float) -> float:
    """Return ``sum of half^n / (shape (shape + 1) ... (shape + n))``."""
    term = total = 1.0 / shape
    for n in range(1, _TERMS):
        term *= half / (shape + n)
        total += term
        if term < 1e-17 * total:
            break
    return total


def _gamma_fraction(shape: float, half: float) -> float:
    """Return the continued fraction of the upper incomplete gamma function by Lentz's method."""
    b = half + 1.0 - shape
    c, d = 1.0 / _TINY, 1.0 / b
    product = d
    for n in range(1, _TERMS):
        a = n * (shape - n)
        b += 2.0
        d = 1.0 / _not_zero(a * d + b)
        c = _not_zero(b + a / c)
        product *= c * d
        if abs(c * d - 1.0) < 1e-16:
            break
    return product


def f_tail(value: float, numerator: float, denominator: float) -> float:
    """Return the probability that an F variable is larger: the p-value of a distance whose covariance was estimated.

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
    complement = numerator * value / (denominator + numerator * value)
    log_beta = math.lgamma(a) + math.lgamma(b) - math.lgamma(a + b)
    front = math.exp(a * math.log(x) + b * math.log(complement) - log_beta)
    if x < (a + 1.0) / (a + b + 2.0):
        return front * _beta_fraction(a, b, x) / a
    return max(0.0, 1.0 - front * _beta_fraction(b, a, complement) / b)


def _beta_fraction(a: float, b: float, x: float) -> float:
    """Return the continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method."""
    c, d = 1.0, 1.0 / _not_zero(1.0 - (a + b) * x / (a + 1.0))
    total = d
    for k in range(1, _TERMS):
        even = k * (b - k) * x / ((a + 2 * k - 1.0) * (a + 2 * k))
        odd = -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 2 * k + 1.0))
        for top in (even, odd):
            d = 1.0 / _not_zero(1.0 + top * d)
            c = _not_zero(1.0 + top / c)
            total *= c * d
        if abs(c * d - 1.0) < 1e-15:
            break
    return total


def _not_zero(value: float) -> float:
    return value if abs(value) > _TINY else _TINY
