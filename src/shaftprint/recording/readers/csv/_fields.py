"""Fields of a line of text, and what one can be: a number, a date, a time of day, a mark for no value, or words."""

import csv
import re
from collections.abc import Iterable

from shaftprint.recording.readers.csv._dates import is_date
from shaftprint.recording.readers.csv._day_times import is_day_time

WHITE_SPACE, TAB = " ", "\t"
DELIMITERS = (";", TAB, ",", "|", WHITE_SPACE)

NUMBER, DATE, DAY_TIME, GAP, TEXT = "n", "d", "c", "g", "t"
"""Kinds of a field, a letter each; a mark for no value and an empty field are of one kind."""

# What instruments and programs write in place of a number: nothing, an overload, a sensor that is off.
_GAPS = (
    "na", "n/a", "#n/a", "#na", "null", "none", "nil", "-nan", "+nan", "nan(ind)", "-nan(ind)",
    "#value!", "#div/0!", "#num!", "ol", "+ol", "-ol", "ovld", "over", "+over", "-over", "overload",
    "overrange", "over range", "underrange", "overflow", "burnout", "burn out", "b.o.", "invalid", "bad", "no data",
    "nodata", "err", "error", "fault", "?", "off", "∞", "+∞", "-∞",
    # historians
    "(null)", "i/o timeout", "pt created", "calc failed", "comm fail", "scan off", "shutdown", "intf shut",
    "bad input", "bad data", "not connect", "no result", "no sample", "configure",
)  # fmt: skip
OVERLOAD = 9.89e37
"""From here on a number is none: instruments write 9.9e37 for an overload and 9.91e37 for no value (SCPI 1999)."""
# printed by programs of Windows, with as many figures as were asked for: 1.#INF00, -1.#IND, 1.#QNAN
_WINDOWS = re.compile(r"[+-]?1[.,]#[a-z]+0*", re.IGNORECASE)
_DASHES = re.compile(r"[-*_.]*|\+{2,}|[+-]?\*+|[+-]?-{2,}")
# thousands in groups, 1.234,5 or 1,234.5: two signs, of which the last is the decimal one
_GROUPED = r"[+-]?\d{1,3}(\.\d{3})+,\d+|[+-]?\d{1,3}(,\d{3})+\.\d+"
_NUMBER = re.compile(rf"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf(inity)?)|{_GROUPED}", re.IGNORECASE)
_IN_GROUPS = {",": re.compile(r"[+-]?\d{1,3}(\.\d{3})+(,\d*)?"), ".": re.compile(r"[+-]?\d{1,3}(,\d{3})+\.\d+")}
_PLAIN = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf(inity)?)", re.IGNORECASE)
_LONGEST = 120_000


def split_row(line: str, delimiter: str) -> list[str]:
    """Return the fields of a line without the white space and the quotes around them."""
    plain = line.rstrip("\r\n")
    if '"' not in plain or len(plain) > _LONGEST:
        fields = plain.split() if delimiter == WHITE_SPACE else plain.split(delimiter)
        return [field.strip() for field in fields]
    if delimiter == WHITE_SPACE:
        plain = re.sub(r"[\t ]+", " ", plain.strip())
    (fields,) = csv.reader([plain], delimiter=delimiter, skipinitialspace=True)
    return [field.strip().strip('"').strip() for field in fields]


def with_point(field: str, decimal: str) -> str:
    """Return a field with a decimal point in place of a decimal sign, and without what groups thousands."""
    if _IN_GROUPS[decimal].fullmatch(field) is not None:
        field = field.replace("." if decimal == "," else ",", "")
    return field.replace(",", ".") if decimal == "," else field


def decimal_sign(fields: Iterable[str]) -> str | None:
    """Return the decimal sign of some numbers: a point where there is none; None where both may be."""
    grouped, plain = set(), set()
    for field in fields:
        signs = [letter for letter in field if letter in ".,"]
        if len(set(signs)) == 2:
            grouped.add(signs[-1])
        elif len(signs) == 1:
            plain.add(signs[0])
    if len(grouped) == 1:
        # a lone sign of the other kind groups thousands
        return grouped.pop()
    return None if grouped or len(plain) > 1 else (plain or {"."}).pop()


def is_number(field: str) -> bool:
    """Return whether a field is a number with a decimal point or comma."""
    return _NUMBER.fullmatch(field) is not None


def number(field: str) -> float | None:
    """Return the number that a field with a decimal point is, not a number for a gap or an overload; None for words."""
    if _PLAIN.fullmatch(field) is not None:
        value = float(field)
        return value if abs(value) < OVERLOAD else float("nan")
    return float("nan") if is_gap(field) else None


def is_gap(field: str) -> bool:
    """Return whether a field stands for no value."""
    return bool(_DASHES.fullmatch(field) or _WINDOWS.fullmatch(field)) or field.lower() in _GAPS


def kinds_of(fields: Iterable[str]) -> str:
    """Return the kinds of some fields, a letter each."""
    return "".join(map(_kind, fields))


def _kind(field: str) -> str:
    if _NUMBER.fullmatch(field) is not None:
        return NUMBER
    if is_gap(field):
        return GAP
    if is_date(field):
        return DATE
    return DAY_TIME if is_day_time(field) else TEXT
