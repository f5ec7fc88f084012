"""Upper tails of the distributions that the tests need."""

import math


def chi_square_tail(statistic: float, freedom: int) -> float:
    """Return the probability that chi-square of a number of degrees of freedom exceeds a statistic.

    Closed forms: ``erfc(sqrt(x/2))`` for one degree, ``exp(-x/2)`` for two, and two more degrees add
    ``(x/2)^(k/2) exp(-x/2) / Gamma(k/2 + 1)`` (Abramowitz and Stegun, "Handbook of Mathematical Functions", 26.4.4-5).

    Parameters
    ----------
    statistic
        The value, at least 0.
    freedom
        Degrees of freedom, at least 1.
    """
    half = 0.5 * max(statistic, 0.0)
    total = math.erfc(math.sqrt(half)) if freedom % 2 else math.exp(-half)
    for lower in range(2 - freedom % 2, freedom - 1, 2):
        place = 0.5 * lower
        total += math.exp(place * math.log(half) - half - math.lgamma(place + 1.0)) if half > 0.0 else 0.0
    return min(total, 1.0)


def f_tail_two(statistic: float, samples: float) -> float:
    """Return the tail of F with 2 and ``2 samples`` degrees of freedom: ``(1 + F / samples)^-samples``.

    It is that of the squared magnitude of one complex normal value over the mean of so many others.
    """
    return float((1.0 + max(statistic, 0.0) / samples) ** -samples)
