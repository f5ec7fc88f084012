"""The sample rate behind a step that was printed with few digits."""

import math
from decimal import Decimal, InvalidOperation

_MOST_DIGITS = 9
_ROUNDING = 1e-12


def rate_of_step(printed: str) -> float | None:
    """Return the rate of a step that is printed as text [Hz]; None where it is no positive number.

    Of all rates whose step is printed so, the one with the fewest digits is taken: loggers are set to round ones. Steps
    of 1.953125E-5 and 1.95312e-05 are both those of 51200 Hz, 0.000977 that of 1024 Hz.
    """
    try:
        step = Decimal(printed.strip().replace(",", "."))
    except InvalidOperation:
        return None
    if not step.is_finite() or step <= 0:
        return None
    exponent = step.as_tuple().exponent
    half = Decimal((0, (5,), int(exponent) - 1))
    # a step may be cut off in place of being rounded
    highest_hz = (1.0 + _ROUNDING) / float(max(step - half, step / 2))
    return roundest_rate(1.0 / float(step + 2 * half), highest_hz, float(1 / step))


def roundest_rate(lowest_hz: float, highest_hz: float, nearest_hz: float) -> float:
    """Return the rate with the fewest digits in a range, of several the one nearest to another."""
    for digits in range(1, _MOST_DIGITS):
        unit = 10.0 ** (math.floor(math.log10(highest_hz)) - digits + 1)
        near = round(nearest_hz / unit)
        candidates = [float(f"{unit * whole:.{digits + 2}g}") for whole in (near - 1, near, near + 1)]
        inside = [rate for rate in candidates if lowest_hz <= rate <= highest_hz]
        if inside:
            return min(inside, key=lambda rate: abs(rate - nearest_hz))
    return float(f"{nearest_hz:.12g}")
