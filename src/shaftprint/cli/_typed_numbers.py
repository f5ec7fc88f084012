"""Numbers as they are typed, with a unit behind them or without, such as ``880kW``, ``12min`` and ``5 %``."""

import math
import re

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\d\s].*?)?\s*$")


def number_and_unit(text: str) -> tuple[float | None, str]:
    """Return the finite number at the beginning of a text and the unit behind it; None where there is none."""
    match = _NUMBER.match(text)
    if match is None:
        return None, ""
    number = float(match[1])
    return (number if math.isfinite(number) else None), match[2] or ""
