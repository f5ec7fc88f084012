"""Titles under which text files keep their times."""

import re

from shaftprint.recording.readers._time_scale import unit_in_name

_MORE = (
    "date", "datetime", "date/time", "date time", "date&time", "date & time", "date and time", "datum", "datum/uhrzeit",
    "datum/zeit", "datum uhrzeit", "datum und uhrzeit", "uhrzeit", "zeitstempel", "zeitachse", "messzeit", "laufzeit",
    "time axis", "time_stamp", "timestamp", "x_value", "x-axis", "x axis", "rel time", "rel. time", "relative time",
    "abs time", "abs. time", "absolute time", "clock time", "second", "seconds", "sec", "secs", "sekunde", "sekunden",
    "fecha", "fecha/hora", "tiempo", "hora", "heure", "tempo", "data/ora", "tid", "czas", "datum/tijd",
    "measurement time",
)  # fmt: skip
# A program names the clock behind the word: Time  1 - default sample rate, Time (Formatted).
_WITH_MORE = re.compile(r"(time|zeit)\b[^\[(]*([\[(].*[\])])?", re.IGNORECASE)
IN_BRACKETS = re.compile(r"(?P<name>.*\S)\s*[\[(](?P<unit>[^\])]*)[\])]")
"""A title with its unit in brackets."""
MILLISECONDS = ("ms", "msec", "millisec", "millisecond", "milliseconds", "millitm", "millisekunden", "ms.")
"""Titles, in small letters, of a column that goes on where dates end at the second."""


def is_time_title(title: str) -> bool:
    """Return whether a title, with its unit or without, is that of times."""
    match = IN_BRACKETS.fullmatch(title.strip())
    name = match["name"].strip() if match is not None else title.strip()
    return name.lower() in _MORE or unit_in_name(name) is not None or unit_in_name(title.strip()) is not None


def begins_as_time(title: str) -> bool:
    """Return whether a title begins with the word time, as that of a first column may."""
    return _WITH_MORE.fullmatch(title.strip()) is not None
