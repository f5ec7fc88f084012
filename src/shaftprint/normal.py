"""Quantiles of the normal distribution, for intervals."""

import math

NORMAL_95 = 1.959963984540054
"""So many standard deviations on either side hold 95 % of a normal distribution."""

_STEPS = 60


def deviations(coverage: float) -> float:
    """Return how many standard deviations on either side hold a share of a normal distribution.

    Parameters
    ----------
    coverage
        The share, between 0 and 1, such as 0.95.

    Raises
    ------
    ValueError
        If the share is not between 0 and 1.
    """
    if not 0.0 < coverage < 1.0:
        raise ValueError(f"coverage: expected a share between 0 and 1, found {coverage}.")
    low, high = 0.0, 1.0
    while math.erf(high / math.sqrt(2.0)) < coverage:
        low, high = high, 2.0 * high
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        inside = math.erf(middle / math.sqrt(2.0)) < coverage
        low, high = (middle, high) if inside else (low, middle)
    return 0.5 * (low + high)
