"""Times of a day without a date, such as ``09:00:00.010``, which begin again at midnight."""

import re
from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray

# with seconds, or as spreadsheets shorten it: minutes and seconds with a decimal
_DAY_TIME = re.compile(
    r"(?:(?P<hour>\d{1,3}):)?(?P<minute>[0-5]?\d):(?P<second>[0-5]?\d)(?P<part>[.,:]\d+)?\s?(?P<half>[AaPp][Mm])?"
)
_DAY_S, _HALF_DAY_S = 86_400.0, 43_200.0


def is_day_time(text: str) -> bool:
    """Return whether a field is a time of day, or the time that has passed as hours, minutes and seconds."""
    return _DAY_TIME.fullmatch(text) is not None


def day_time_s(text: str) -> float:
    """Return the seconds since midnight; not a number where the text is no time of day."""
    match = _DAY_TIME.fullmatch(text)
    parts = match.groupdict() if match is not None else None
    if parts is not None and parts["hour"] is None and parts["part"] is None:
        # hours and minutes: a lone minute and second has a decimal
        parts = {**parts, "hour": parts["minute"], "minute": parts["second"], "second": "0"}
    if parts is None:
        return np.nan
    hour = float(parts["hour"] or 0.0)
    if parts["half"] is not None:
        hour = hour % 12.0 + (12.0 if parts["half"].lower() == "pm" else 0.0)
    part = float("0." + parts["part"][1:]) if parts["part"] else 0.0
    return 3600.0 * hour + 60.0 * float(parts["minute"]) + float(parts["second"]) + part


def day_times_s(texts: Sequence[str]) -> FloatArray:
    """Return the seconds since midnight of some fields, shape (fields,)."""
    return np.array([day_time_s(text) for text in texts], dtype=np.float64)


def over_midnight(seconds: FloatArray, before_s: float | None) -> FloatArray:
    """Return times of day that go on where they begin again at midnight.

    ``seconds``: seconds since midnight, shape (times,). ``before_s``: the time before the first of them as this
    function gave it; None where there is none.
    """
    first = seconds[0] if before_s is None and seconds.size else before_s
    back = np.diff(seconds, prepend=np.mod(first, _DAY_S) if first is not None and seconds.size else 0.0)
    days = np.cumsum(back < -_HALF_DAY_S) if seconds.size else np.empty(0)
    whole = 0.0 if before_s is None else np.floor(before_s / _DAY_S)
    return seconds + _DAY_S * (days + whole)
