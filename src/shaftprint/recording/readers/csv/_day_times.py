"""Times of a day, such as ``09:00:00.010``, which begin again at midnight: without a date, or behind an ambiguous one.

Of 03/05/2026 and 26-03-05 nobody can tell day and month apart; the times behind them count nevertheless.
"""

import datetime as dt
import re
from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray

_DATE = r"'?\d\d?(?P<mark>[/-])\d\d?(?P=mark)\d{2,4}"
AMBIGUOUS = re.compile(rf"{_DATE}([T ,].*)?")
"""A date of which day and month cannot be told apart."""
AMBIGUOUS_DAY = re.compile(_DATE)
"""The same without a time of day."""
# a span of time by pandas, 1 days 00:00:00.010, and by MATLAB
_DAYS = r"(?:(?P<days>\d{1,4}) days? )?"
_SPAN = re.compile(r"(?P<number>\d+(?:\.\d+)?(?:e-\d+)?) (?P<unit>sec|min|hr)")
# with seconds, or as spreadsheets shorten it: minutes and seconds with a decimal
_DAY_TIME = re.compile(
    rf"(?:(?P<date>{_DATE})[T ,]+|{_DAYS})"
    r"(?:(?P<hour>\d{1,3}):)?(?P<minute>[0-5]?\d):(?P<second>[0-5]?\d)(?P<part>[.,:;]\d+)?\s?(?P<half>[AaPp][Mm])?"
)
_DAY_S, _HALF_DAY_S = 86_400.0, 43_200.0
_MONTHS, _TWO_FIGURES = 12, 99


def is_day_time(text: str) -> bool:
    """Return whether a field is a time of day, or the time that has passed as hours, minutes and seconds."""
    return _DAY_TIME.fullmatch(text) is not None or _SPAN.fullmatch(text) is not None


def is_span(text: str) -> bool:
    """Return whether a field is the time that has passed, with its days or its unit: it does not begin again."""
    match = _DAY_TIME.fullmatch(text)
    return _SPAN.fullmatch(text) is not None if match is None else match["days"] is not None


def day_time_s(text: str) -> float:
    """Return the seconds since midnight; not a number where the text is no time of day."""
    span = _SPAN.fullmatch(text)
    if span is not None:
        return float(span["number"]) * {"sec": 1.0, "min": 60.0, "hr": 3600.0}[span["unit"]]
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
    return (
        _DAY_S * float(parts["days"] or 0.0)
        + 3600.0 * hour
        + 60.0 * float(parts["minute"])
        + float(parts["second"])
        + part
    )


def ambiguous_date(text: str) -> str:
    """Return the date in front of a time of day; empty where there is none."""
    match = _DAY_TIME.fullmatch(text)
    return "" if match is None else match["date"] or ""


def told_date(date: str) -> dt.date | None:
    """Return what an ambiguous date is where one of its first parts is no month; None where nobody can tell."""
    first, second, year = (int(part) for part in re.findall(r"\d+", date))
    in_order = {(True, False): (second, first), (False, True): (first, second)}
    month, day = in_order.get((first > _MONTHS, second > _MONTHS), (0, 0))
    try:
        return dt.date(year, month, day) if year > _TWO_FIGURES else None
    except ValueError:
        return None


def may_follow(date: str, before: str) -> bool:
    """Return whether an ambiguous date may be that of the day behind another, whichever part is the day."""
    parts = zip(re.findall(r"\d+", before), re.findall(r"\d+", date), strict=True)
    moves = [(int(new), int(new) - int(old)) for old, new in parts]
    # the day behind the last of a month or a year is a first
    others = [new for new, move in moves if move not in (0, 1)]
    return any(move == 1 for _, move in moves) and all(new == 1 for new in others)


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
