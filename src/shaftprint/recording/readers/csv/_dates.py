"""Dates in text files: ISO 8601, or day.month.year with dots."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from shaftprint.errors import RecordingError

_ISO = re.compile(
    r"(?P<year>\d{4})[-/](?P<month>\d\d?)[-/](?P<day>\d\d?)"
    r"(?P<rest>([T ]\d\d?:\d\d(:\d\d([.,]\d+)?)?)?\s?(Z|[+-]\d\d(:?\d\d)?)?)"
)
_DOTTED = re.compile(r"(\d\d?)\.(\d\d?)\.(\d{4})[T ](\d\d?:\d\d(:\d\d([.,]\d+)?)?)")
_ZONE = re.compile(r"\s?(Z|[+-]\d\d(?::?\d\d)?)$")


def is_date(text: str) -> bool:
    """Return whether a field is a date with or without a time of day."""
    return _ISO.fullmatch(text) is not None or _DOTTED.fullmatch(text) is not None


def has_offset(text: str) -> bool:
    """Return whether a date says how far its clock is from UTC."""
    return _ZONE.search(text[8:]) is not None


def dates(path: Path, texts: Sequence[str]) -> "np.ndarray[tuple[int], np.dtype[np.datetime64]]":
    """Return dates as microseconds: in UTC where they have an offset from it, else as they are written.

    Raises
    ------
    RecordingError
        If a text is no date, or one has an offset and others have none.
    """
    iso_texts, offsets = [], []
    for text in texts:
        dotted, iso = _DOTTED.fullmatch(text), _ISO.fullmatch(text)
        if dotted is not None:
            day, month, year, rest = dotted[1], dotted[2], dotted[3], dotted[4]
        elif iso is not None:
            year, month, day, rest = iso["year"], iso["month"], iso["day"], iso["rest"] or ""
        else:
            raise RecordingError(
                f'{path}: expected dates such as 2026-11-21T12:00:00.5 or 21.11.2026 12:00:00, found "{text[:40]}".'
            )
        zone = _ZONE.search(rest)
        offsets.append(None if zone is None else _minutes(zone[1]))
        clock = _ZONE.sub("", rest).lstrip("T ").replace(",", ".")
        hour, colon, more = clock.partition(":")
        iso_texts.append(f"{year}-{int(month):02}-{int(day):02}" + (f"T{int(hour):02}:{more}" if colon else ""))
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


def _minutes(zone: str) -> int:
    """Return how far a zone such as ``+01:00`` is before UTC [min]."""
    if zone == "Z":
        return 0
    digits = zone[1:].replace(":", "")
    return (-1 if zone[0] == "-" else 1) * (60 * int(digits[:2]) + int(digits[2:] or 0))
