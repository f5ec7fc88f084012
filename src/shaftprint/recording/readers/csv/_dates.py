"""Dates in text files: ISO 8601, day.month.year with dots, or with the name of the month; with AM and PM, or UTC."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from shaftprint.errors import RecordingError

# milliseconds also behind a colon or a semicolon, as Keysight's and Rockwell's programs write them
_CLOCK = r"(?P<clock>\d\d?:\d\d(?::\d\d(?:[.,]\d+|[:;]\d{3})?)?)(?:\s?(?P<half>[AaPp][Mm]))?"
_PART = re.compile(r"(?<=:\d\d:\d\d)[,:;]")
_ZONED = r"(?:\s?(?P<zone>Z|UTC|GMT|[+-]\d\d(?::?\d\d)?))?"
_ISO = re.compile(rf"(?P<year>\d{{4}})[-/](?P<month>\d\d?)[-/](?P<day>\d\d?)(?:[T ]+{_CLOCK})?{_ZONED}")
# 20260305T090000.5, ISO 8601 without separators
_BASIC = re.compile(
    rf"(?P<year>\d{{4}})(?P<month>\d\d)(?P<day>\d\d)[T ](?P<clock>\d{{4}}(?:\d\d(?:[.,]\d+)?)?)(?P<half>){_ZONED}"
)
_WEEKDAY = r"(?:(?:Mon|Tue|Wed|Thu|Fri|Sat|Sun)[a-z]*,? )?"
# 21.11.2026 and 21.11.26, 21-Nov-2026 (MATLAB's datestr), 21 Nov 2026, Sat 21 Nov 2026
_DAY_FIRST = re.compile(
    rf"{_WEEKDAY}"
    r"(?P<day>\d\d?)(?:\.(?P<month>\d\d?)\.|[-. /](?P<name>[A-Za-z]{3})[a-z]*\.?[-. /])(?P<year>\d{4}|\d\d)[T ]+"
    rf"{_CLOCK}{_ZONED}"
)
# 21.11.2026 beside a time of day in a column of its own
_DAY_ALONE = re.compile(
    r"(?P<day>\d\d?)(?:\.(?P<month>\d\d?)\.|[- ](?P<name>[A-Za-z]{3})[a-z]*[- ])(?P<year>\d{4})"
    r"(?P<clock>)(?P<half>)(?P<zone>(?!))?"
)
# Nov 21, 2026
_NAME_FIRST = re.compile(
    rf"{_WEEKDAY}(?P<name>[A-Za-z]{{3}})[a-z]*\.? (?P<day>\d\d?),? (?P<year>\d{{4}})[T ,]+(?:@ )?{_CLOCK}{_ZONED}"
)
# Thu Mar  5 09:00:00 CET 2026, as C and Java print dates; Thu Mar 05 2026 09:00:00 GMT+0100, as JavaScript does
_YEAR_LAST = re.compile(
    rf"{_WEEKDAY}(?P<name>[A-Za-z]{{3}}) +(?P<day>\d\d?) {_CLOCK}(?: (?P<zone>UTC|GMT)| [A-Z]{{3,4}})? "
    r"(?P<year>\d{4})"
)
_SCRIPT = re.compile(
    rf"{_WEEKDAY}(?P<name>[A-Za-z]{{3}}) (?P<day>\d\d) (?P<year>\d{{4}}) {_CLOCK} GMT(?P<zone>[+-]\d{{4}})(?: \(.*\))?"
)
# with the month's name within, as Boost writes dates
_NAME_WITHIN = re.compile(rf"(?P<year>\d{{4}})[- ](?P<name>[A-Za-z]{{3}})[a-z]*[- ](?P<day>\d\d?)[T ]+{_CLOCK}{_ZONED}")
_COMPACT = re.compile(rf"(?P<year>(?:19|20)\d\d)(?P<month>\d\d)(?P<day>\d\d)[T ]+{_CLOCK}{_ZONED}")
_FORMS = (_ISO, _DAY_FIRST, _BASIC, _DAY_ALONE, _NAME_FIRST, _NAME_WITHIN, _COMPACT, _YEAR_LAST, _SCRIPT)
_NAMED = (_DAY_FIRST, _DAY_ALONE, _NAME_FIRST, _NAME_WITHIN, _YEAR_LAST, _SCRIPT)
_MONTHS = {
    name: number
    for number, names in enumerate(
        ("jan", "feb", "mar mrt", "apr", "may mai mei", "jun", "jul", "aug", "sep", "oct okt", "nov", "dec dez"),
        start=1,
    )
    for name in names.split()
}


def _parts(text: str) -> re.Match[str] | None:
    match = next((found for form in _FORMS if (found := form.fullmatch(text)) is not None), None)
    name = match["name"] if match is not None and match.re in _NAMED else None
    return None if name is not None and name.lower() not in _MONTHS else match


def is_date(text: str) -> bool:
    """Return whether a field is a date with or without a time of day."""
    return _parts(text) is not None


def has_offset(text: str) -> bool:
    """Return whether a date says how far its clock is from UTC."""
    parts = _parts(text)
    return parts is not None and parts["zone"] is not None


def dates(path: Path, texts: Sequence[str]) -> "np.ndarray[tuple[int], np.dtype[np.datetime64]]":
    """Return dates as microseconds: in UTC where they have an offset from it, else as they are written.

    Raises RecordingError if a text is no date, or one has an offset and others have none.
    """
    iso_texts, offsets = [], []
    for text in texts:
        parts = _parts(text)
        if parts is None:
            raise RecordingError(
                f'{path}: expected dates such as 2026-11-21T12:00:00.5 or 21.11.2026 12:00:00, found "{text[:40]}".'
            )
        zone = parts["zone"]
        offsets.append(None if zone is None else _minutes(zone))
        iso_texts.append(_in_iso(parts))
    try:
        local = np.array(iso_texts, dtype="datetime64[us]")
    except ValueError as error:
        raise RecordingError(f"{path}: expected dates that the calendar has, found {str(error)[:80]}.") from None
    if all(offset is None for offset in offsets):
        return local
    bare = next((text for text, offset in zip(texts, offsets, strict=True) if offset is None), None)
    if bare is not None:
        raise RecordingError(f'{path}: expected dates with an offset from UTC throughout, found "{bare[:40]}".')
    in_utc: np.ndarray[tuple[int], np.dtype[np.datetime64]] = local - np.array(offsets, dtype="timedelta64[m]")
    return in_utc


def _in_iso(parts: re.Match[str]) -> str:
    """Return the parts of a date in the order of ISO 8601."""
    number = parts["month"] if "month" in parts.re.groupindex else None
    month = number or str(_MONTHS[parts["name"].lower()])
    year = parts["year"] if len(parts["year"]) > 2 else f"20{parts['year']}"
    day = f"{year}-{int(month):02}-{int(parts['day']):02}"
    clock = _PART.sub(".", (parts["clock"] or "").replace(",", "."))
    if not clock:
        return day
    if parts.re is _BASIC:
        clock = ":".join(part for part in (clock[:2], clock[2:4], clock[4:]) if part)
    hour, _, more = clock.partition(":")
    if parts["half"]:
        hour = str(int(hour) % 12 + (12 if parts["half"].lower() == "pm" else 0))
    return f"{day}T{int(hour):02}:{more}"


def _minutes(zone: str) -> int:
    """Return how far a zone such as ``+01:00`` is before UTC [min]."""
    if zone.isalpha():
        return 0
    digits = zone[1:].replace(":", "")
    return (-1 if zone[0] == "-" else 1) * (60 * int(digits[:2]) + int(digits[2:] or 0))
