"""Dates in text files: ISO 8601, or day.month.year with dots."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError

_ISO = re.compile(r"\d{4}[-/]\d\d?[-/]\d\d?([T ]\d\d?:\d\d(:\d\d([.,]\d+)?)?)?\s?(Z|[+-]\d\d:?\d\d)?")
_DOTTED = re.compile(r"(\d\d?)\.(\d\d?)\.(\d{4})[T ](\d\d?:\d\d(:\d\d([.,]\d+)?)?)")
_ZONE = re.compile(r"\s?(Z|[+-]\d\d:?\d\d)$")


def is_date(text: str) -> bool:
    """Return whether a field is a date with or without a time of day."""
    return _ISO.fullmatch(text) is not None or _DOTTED.fullmatch(text) is not None


def dates(path: Path, texts: Sequence[str]) -> "np.ndarray[tuple[int], np.dtype[np.datetime64]]":
    """Return dates as microseconds, in the zone in which they are written.

    Raises
    ------
    RecordingError
        If a text is no date.
    """
    iso_texts = []
    for text in texts:
        dotted = _DOTTED.fullmatch(text)
        if dotted is not None:
            text = f"{dotted[3]}-{int(dotted[2]):02}-{int(dotted[1]):02}T{dotted[4]}"
        elif _ISO.fullmatch(text) is None:
            raise RecordingError(
                f'{path}: expected dates such as 2026-11-21T12:00:00.5 or 21.11.2026 12:00:00, found "{text[:40]}".'
            )
        head = text[:10].replace("/", "-")
        iso_texts.append(head + _ZONE.sub("", text[10:]).replace(",", ".").replace(" ", "T"))
    try:
        return np.array(iso_texts, dtype="datetime64[us]")
    except ValueError as error:
        raise RecordingError(f"{path}: expected dates that the calendar has, found {str(error)[:80]}.") from None


def seconds_from(first: np.datetime64, times: "np.ndarray[tuple[int], np.dtype[np.datetime64]]") -> FloatArray:
    """Return seconds since a first date, shape as the dates."""
    passed: FloatArray = (times - first) / np.timedelta64(1, "us") * 1e-6
    return passed
