"""Numbers as they are printed: as many digits as the uncertainty leaves, no scientific notation."""

import math

NARROW_SPACE = "\u202f"
LEAST_DIGITS = 4
DIGITS_OF_STD = 2
NOT_KNOWN = "not known"
SMALLEST_P = 1e-6
_UNITS = {"kg m2": "kg m²", "N m": "N·m", "N m/rpm": "N·m/rpm", "N m/(rpm s)": "N·m/(rpm·s)", "1/s": "s⁻¹", "-": ""}


def unit_text(unit: str) -> str:
    """Return a unit as printed; nothing for a number without unit."""
    return _UNITS.get(unit, unit)


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
        return max(0, _place(std))
    if value == 0.0 or not math.isfinite(value):
        return 0
    return max(0, LEAST_DIGITS - 1 - math.floor(math.log10(abs(value))))


def _place(value: float) -> int:
    """Return how many decimals leave two digits of a number; less than none where it is a hundred or more."""
    return DIGITS_OF_STD - 1 - math.floor(math.log10(abs(value)))


def with_deviation(value: float, std: float) -> str:
    """Return ``value ± one standard deviation``, both rounded to the second digit of the standard deviation.

    A value keeps two digits of its own where a standard deviation of a hundred or more would leave none.
    """
    if not (math.isfinite(std) and math.isfinite(value)):
        return f"{rounded(value)} ({NOT_KNOWN})"
    if std == 0.0:
        return f"{rounded(value)} ± {plain(0.0, decimals_of(value, 0.0))}"
    decimals = _place(std)
    least = _place(value) if value else 0
    shown = decimals if decimals >= 0 else max(decimals, least)
    return f"{plain(round(value, shown), max(shown, 0))} ± {plain(round(std, decimals), max(decimals, 0))}"


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


def p_value_text(p_value: float | None) -> str:
    """Return a p-value with two digits, or as smaller than a millionth; a dash where there is none."""
    if p_value is None or math.isnan(p_value):
        return "–"
    return "< 0.000001" if p_value < SMALLEST_P else rounded(p_value, DIGITS_OF_STD)
