"""Numbers as they are printed, in tables, sentences and descriptions: the one rule for their digits.

========================= ============================================================================
quantity                  digits
========================= ============================================================================
standard deviation        two significant ones (JCGM 100, GUM 7.2.6)
value, ends of interval   down to the decimal at which its standard deviation ends
number without deviation  four significant ones; as a power of ten below a millionth
p-value                   two; as a power of ten below a thousandth
========================= ============================================================================

Tables have typographic letters (±, a true minus sign, a narrow space between thousands), sentences those of every
keyboard, which ``stated`` and ``plain_letters`` write.
"""

import math
import re

NARROW_SPACE = "\u202f"
LEAST_DIGITS = 4
DIGITS_OF_STD = 2
NOT_KNOWN = "not known"
SMALLEST_PLAIN = 1e-6
SMALLEST_PLAIN_P, SMALLEST_P = 1e-3, 1e-300
# A time shorter than this, its deviation and its interval included, is printed in milliseconds.
SHORT_S = 0.01
# By unit: below which size a finer one is taken, its factor and itself.
_FINE_UNITS = {
    "s": (SHORT_S, 1e3, "ms"),
    "kg m2": (0.01, 1e4, "kg cm2"),
    "H": (0.1, 1e3, "mH"),
    "N m s/rad": (0.01, 1e3, "mN m s/rad"),
}
_UNITS = {
    "kg cm2": "kg cm²",
    "kg m2": "kg m²",
    "N m": "N·m",
    "N m/rpm": "N·m/rpm",
    "N m/(rpm s)": "N·m/(rpm·s)",
    "1/s": "s⁻¹",
    "-": "",
}
_RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_POWER = "·10⁻"
_EXPONENT = re.compile(r"(?<=\d)e-0*([1-9]\d*)\b")
_PLAIN_LETTERS = str.maketrans(
    {"−": "-", "±": "+/-", "°": " deg", "–": "-", "∞": "inf", NARROW_SPACE: "", "²": "2", "·": " ", "“": '"', "”": '"'}
)


def after_number(unit: str) -> str:
    """Return a unit as it stands behind a number of a sentence; nothing for a number without unit."""
    return "" if unit == "-" else f" {unit}"


def unit_text(unit: str) -> str:
    """Return a unit as printed; nothing for a number without unit."""
    return _UNITS.get(unit, unit)


def plain_letters(text: str) -> str:
    """Return a text of a table with letters that every terminal has; powers of ten become ``4.7e-98``."""
    before, *powers = text.replace("s⁻¹", "1/s").split(_POWER)
    for power in powers:
        digits = power[: len(power) - len(power.lstrip("⁰¹²³⁴⁵⁶⁷⁸⁹"))]
        before += f"e-{digits.translate(_LOWERED)}{power[len(digits) :]}"
    return before.translate(_PLAIN_LETTERS)


def typographic(text: str) -> str:
    """Return a sentence with the letters of tables: ± and powers of ten; the other way round than ``plain_letters``."""
    return _EXPONENT.sub(lambda match: f"·10⁻{match[1].translate(_RAISED)}", text.replace("+/-", "±"))


def plain(value: float, decimals: int) -> str:
    """Return a number with fixed decimals, thousands set apart by a narrow space, and a true minus sign."""
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0.0 else "−∞"
    text = f"{value:,.{decimals}f}".replace(",", NARROW_SPACE).replace("-", "−")
    return text.removeprefix("−") if not any(digit in "123456789" for digit in text) else text


def in_nm(value: float) -> str:
    """Return a torque [N m] for a sentence: four significant digits, large ones without an exponent, and the unit."""
    return f"{float(f'{value:.4g}'):.0f} N m" if 1e4 <= abs(value) < 1e9 else f"{value:.4g} N m"


def rounded(value: float, digits: int = LEAST_DIGITS) -> str:
    """Return a number with a few significant digits."""
    if value == 0.0 or not math.isfinite(value):
        return plain(value, 0)
    if abs(value) < SMALLEST_PLAIN:
        return _power(value, digits)
    return plain(value, max(0, digits - 1 - _exponent(value, digits)))


def to_digit_of(value: float, std: float) -> str:
    """Return a number down to the second digit of its standard deviation; four digits where there is none."""
    if not math.isfinite(value):
        return plain(value, 0)
    place = _last_place(value, std)
    return plain(round(value, place), max(place, 0))


def _decimals_of(value: float, std: float) -> int:
    """Return how many decimals are worth printing: two digits of the standard deviation, or four of the value."""
    return max(0, _last_place(value, std)) if math.isfinite(value) else 0


def with_deviation(value: float, std: float) -> str:
    """Return ``value ± one standard deviation``, both down to the second digit of the standard deviation."""
    if not (math.isfinite(std) and math.isfinite(value)):
        return f"{rounded(value)} ({NOT_KNOWN})"
    if std == 0.0:
        return f"{rounded(value)} ± {plain(0.0, _decimals_of(value, 0.0))}"
    return f"{to_digit_of(value, std)} ± {to_digit_of(std, std)}"


def interval(lower: float, upper: float, std: float) -> str:
    """Return ``lower to upper`` down to the second digit of the standard deviation, where the value ends too."""
    if math.isnan(lower) or math.isnan(upper):
        return "–"
    if not (std > 0.0 and math.isfinite(std)):
        decimals = _decimals_of(upper, 0.0)
        return f"{plain(lower, decimals)} to {plain(upper, decimals)}"
    return f"{to_digit_of(lower, std)} to {to_digit_of(upper, std)}"


def stated(value: float, std: float, unit: str) -> str:
    """Return ``value +/- standard deviation unit`` for a sentence; short times in milliseconds."""
    factor, unit = fine_unit(unit, value, std)
    text = plain_letters(with_deviation(factor * value, factor * std))
    return text + after_number(unit)


def stated_interval(value: float, lower: float, upper: float, std: float, unit: str) -> str:
    """Return ``value (95 % interval lower to upper unit)`` for a sentence, all down to the digit of the deviation."""
    factor, unit = fine_unit(unit, value, lower, upper)
    ends = interval(factor * lower, factor * upper, factor * std) + after_number(unit)
    return plain_letters(f"{to_digit_of(factor * value, factor * std)} (95 % interval {ends})")


def fine_unit(unit: str, *numbers: float) -> tuple[float, str]:
    """Return the factor and the unit in which numbers are printed: a finer one, such as ms, where all are small.

    Parameters
    ----------
    unit
        Unit of the numbers.
    numbers
        What stands in one row: value, standard deviation, ends of an interval.
    """
    sizes = [abs(number) for number in numbers if math.isfinite(number)]
    small, factor, fine = _FINE_UNITS.get(unit, (0.0, 1.0, unit))
    return (factor, fine) if sizes and 0.0 < max(sizes) < small else (1.0, unit)


def p_value_text(p_value: float | None) -> str:
    """Return a p-value with two digits, small ones as a power of ten; a dash where there is none."""
    if p_value is None or math.isnan(p_value):
        return "–"
    if p_value >= SMALLEST_PLAIN_P:
        return rounded(p_value, DIGITS_OF_STD)
    if p_value < SMALLEST_P:
        return f"< {_power(SMALLEST_P)}"
    return _power(p_value)


def _power(number: float, digits: int = DIGITS_OF_STD) -> str:
    mantissa, _, exponent = f"{number:.{digits - 1}e}".replace("-", "−", int(number < 0.0)).partition("e")
    return f"{mantissa}·10{str(int(exponent)).translate(_RAISED)}"


def _last_place(value: float, std: float) -> int:
    """Return the decimal at which a number ends; negative where that is before the point."""
    if std > 0.0 and math.isfinite(std):
        return DIGITS_OF_STD - 1 - _exponent(std, DIGITS_OF_STD)
    return max(0, LEAST_DIGITS - 1 - _exponent(value, LEAST_DIGITS)) if value else 0


def _exponent(number: float, digits: int) -> int:
    """Return the power of ten of the first digit, after rounding: that of 0.0996 with two digits is -1."""
    return int(f"{number:.{digits - 1}e}".partition("e")[2])
