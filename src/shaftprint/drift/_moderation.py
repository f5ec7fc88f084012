"""How far several variances, each told by few differences, may be taken for one (limma's closed form).

Variances ``s^2`` of ``d`` degrees of freedom, whose true values scatter as an inverse chi-square of ``d0`` does, have
logarithms with the variance ``trigamma(d/2) + trigamma(d0/2)``, from which ``d0`` follows: as many differences as what
they have in common is worth beside the own ones (G. K. Smyth, "Linear models and empirical Bayes methods for assessing
differential expression", Statistical Applications in Genetics and Molecular Biology 3, 2004, section 6.2).
"""

import numpy as np

from shaftprint.arrays import FloatArray

LEAST_WORTH, MOST_WORTH = 2.0, 200.0
_SMALLEST, _SHIFT, _BISECTIONS = 1e-3, 10.0, 60


def worth_of_common(variances: FloatArray, freedom: float) -> float:
    """Return how many differences what the variances have in common is worth, ``d0`` between 2 and 200.

    ``variances``: each over what it is expected to be, shape (variances,). ``freedom``: degrees of freedom of each.
    """
    if variances.size < 2:
        return MOST_WORTH
    scatter = float(np.log(np.maximum(variances, _SMALLEST)).var(ddof=1)) - trigamma(0.5 * freedom)
    low, high = LEAST_WORTH, MOST_WORTH
    if scatter <= trigamma(0.5 * high):
        return high
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if trigamma(0.5 * middle) > scatter else (low, middle)
    return low


def trigamma(x: float) -> float:
    """Return the second derivative of the logarithm of the gamma function (Abramowitz and Stegun 6.4.6, 6.4.12)."""
    total = 0.0
    while x < _SHIFT:
        total += x**-2
        x += 1.0
    return total + 1.0 / x + 0.5 / x**2 + 1.0 / (6.0 * x**3) - 1.0 / (30.0 * x**5) + 1.0 / (42.0 * x**7)
