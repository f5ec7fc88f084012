"""Numbers as they are written in tables."""

import math

DIGITS_OF_UNCERTAINTY = 2


def with_uncertainty(value: float, std: float) -> str:
    """Return ``value +/- std``, both rounded to the second digit of the standard deviation.

    An infinite standard deviation, which says that nothing is known, is written as ``unknown``. A value keeps two
    digits of its own where a standard deviation of a hundred or more would leave none.
    """
    if not (math.isfinite(std) and math.isfinite(value)):
        return f"{value:.4g} +/- unknown"
    if std == 0.0:
        return f"{value:.6g} +/- 0"
    decimals = DIGITS_OF_UNCERTAINTY - 1 - math.floor(math.log10(std))
    if decimals < 0:
        own = DIGITS_OF_UNCERTAINTY - 1 - math.floor(math.log10(abs(value))) if value else 0
        return f"{round(value, max(decimals, own)):.{max(own, 0)}f} +/- {round(std, decimals):.0f}"
    return f"{value:.{decimals}f} +/- {std:.{decimals}f}"


def plain(value: float) -> str:
    """Return a number with four significant digits."""
    return f"{value:.4g}"
