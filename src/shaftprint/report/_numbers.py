"""Numbers as they are printed: as many digits as the uncertainty leaves, no scientific notation."""

import math

NARROW_SPACE = "\u202f"
LEAST_DIGITS = 4
NOT_KNOWN = "not known"


def plain(value: float, decimals: int) -> str:
    """Return a number with fixed decimals, thousands set apart by a narrow space, and a true minus sign."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    text = f"{value:,.{decimals}f}".replace(",", NARROW_SPACE).replace("-", "−")
    return text.removeprefix("−") if not any(digit in "123456789" for digit in text) else text


def decimals_of(value: float, std: float) -> int:
    """Return how many decimals are worth printing: two digits of the standard deviation, or four of the value."""
    if std > 0.0 and math.isfinite(std):
        return max(0, 1 - math.floor(math.log10(std)))
    if value == 0.0 or not math.isfinite(value):
        return 0
    return max(0, LEAST_DIGITS - 1 - math.floor(math.log10(abs(value))))


def with_deviation(value: float, std: float) -> str:
    """Return ``value ± one standard deviation``."""
    if math.isinf(std) or math.isnan(std):
        return f"{plain(value, decimals_of(value, 0.0))} ({NOT_KNOWN})"
    decimals = decimals_of(value, std)
    return f"{plain(value, decimals)} ± {plain(std, decimals)}"


def interval(lower: float, upper: float, std: float) -> str:
    """Return ``lower to upper`` with the digits that the standard deviation leaves."""
    if math.isnan(lower) or math.isnan(upper):
        return "–"
    decimals = decimals_of(upper, std if math.isfinite(std) else 0.0)
    return f"{plain(lower, decimals)} to {plain(upper, decimals)}"


def rounded(value: float, digits: int = LEAST_DIGITS) -> str:
    """Return a number with a few significant digits."""
    if value == 0.0 or not math.isfinite(value):
        return plain(value, 0)
    return plain(value, max(0, digits - 1 - math.floor(math.log10(abs(value)))))
