"""Numbers with as few digits as the recording can tell from them."""

from collections.abc import Callable, Mapping

# A sum of squares over samples that come through a filter grows by so many noise variances for a number that is off
# by two deviations.
_ALLOWED = 12.0
_MOST_DIGITS = 9


def plainest(value: float, tolerance: float, *, most: int = _MOST_DIGITS) -> float:
    """Return the number with the fewest digits behind the point that is within a tolerance of a value."""
    for digits in range(most):
        if abs(round(value, digits) - value) <= tolerance:
            return round(value, digits) + 0.0
    return round(value, most)


def plainest_fit(
    values: Mapping[str, float], cost: Callable[[Mapping[str, float]], float], *, samples: int
) -> dict[str, float]:
    """Return numbers with as few digits as leave a sum of squares what it is, one after the other.

    ``values``: the numbers of the best fit by name, in the order in which they are rounded. ``cost``: sum of squares
    that they leave. ``samples``: number of independent samples of that sum.
    """
    best = dict(values)
    least = cost(best)
    allowed = least * (1.0 + _ALLOWED / max(samples, 1)) + 1e-15
    for name, value in values.items():
        for digits in range(_MOST_DIGITS):
            tried = best | {name: round(value, digits) + 0.0}
            if cost(tried) <= allowed:
                best = tried
                break
        else:
            best[name] = round(value, _MOST_DIGITS)
        allowed = max(allowed, cost(best) * (1.0 + 1e-9))
    return best
