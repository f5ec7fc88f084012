"""The first lines of a text file: what separates the columns, what they are called and in which unit."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._csv_dates import is_date
from shaftprint.recording.readers._units import plain_unit, seconds_in
from shaftprint.recording.readers._vectors import TIME_NAMES

_DELIMITERS = (";", "\t", ",")
_COLUMN = re.compile(r"(?P<name>.*\S)\s*[\[(](?P<unit>[^\])]*)[\])]")
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf(inity)?)", re.IGNORECASE)
_TIMES = (*TIME_NAMES, "date", "datetime", "date/time", "date time", "datum", "elapsed time")


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """How the lines of a text file are to be read."""

    delimiter: str
    """What stands between two columns."""
    decimal: str
    """Decimal point or comma."""
    names: tuple[str, ...]
    """Name of each column."""
    units: tuple[str, ...]
    """Unit of each column; empty where the file gives none."""
    lines: int
    """How many lines stand before the first row of numbers."""
    time_column: int
    """Which column holds the times."""
    second: float | None
    """How many seconds one unit of time has; None where times are dates."""


def read_header(path: Path, lines: Sequence[str], *, delimiter: str | None, decimal: str | None) -> Header:
    """Understand titles such as ``time [s];M_s [V];...``, or titles with a row of units below.

    Lines before the titles are passed over. Without a unit, times are seconds.

    Parameters
    ----------
    path
        The file, for messages.
    lines
        Its first lines.
    delimiter, decimal
        What the caller knows; found in the lines if absent.

    Raises
    ------
    RecordingError
        If a name is missing or comes twice, there is no column of times, or delimiter or decimal sign could be read in
        two ways.
    """
    delimiter, first = _layout(path, lines, delimiter)
    titles, units = _titles(lines, first, delimiter)
    names, units = _named(path, first, titles, units)
    time = next((place for place, name in enumerate(names) if name.lower() in _TIMES), None)
    rows = lines[first:]
    dated = time is not None and is_date(_fields(rows[0], delimiter)[time] if rows and time < len(names) else "")
    second = None if dated or time is None else (1.0 if units[time] == "" else seconds_in(units[time]))
    if time is None or (second is None and not dated):
        raise RecordingError(
            f'{path}, line {max(first, 1)}: expected a column "time [s]", found "{"; ".join(titles)[:80]}".'
        )
    if len(names) == 1:
        raise RecordingError(f"{path}, line {first}: expected a channel beside the time, found none.")
    decimal = decimal or _decimal(path, rows, delimiter, time if dated else None)
    if decimal == delimiter:
        raise RecordingError(f'{path}: expected decimal sign and delimiter to differ, found "{decimal}" for both.')
    return Header(
        delimiter=delimiter,
        decimal=decimal,
        names=tuple(names),
        units=tuple(units),
        lines=first,
        time_column=time,
        second=second,
    )


def looks_like_a_table(lines: Sequence[str]) -> bool:
    """Return whether text has rows of at least two numbers under a line of titles."""
    return any(_first_row(lines, delimiter) for delimiter in _DELIMITERS)


def _layout(path: Path, lines: Sequence[str], delimiter: str | None) -> tuple[str, int]:
    """Return the delimiter and the number of lines before the first row of numbers."""
    candidates = (delimiter,) if delimiter else _DELIMITERS
    for candidate in candidates:
        first = _first_row(lines, candidate)
        if first:
            return candidate, first
    title = lines[0] if lines else ""
    found = [candidate for candidate in candidates if candidate in title]
    if len(found) != 1 and delimiter is None:
        what = "several of them" if found else "none of them"
        raise RecordingError(
            f"{path}, line 1: expected columns separated by semicolon, tab or comma, found {what} in "
            f'"{title.strip()[:80]}"; pass delimiter=.'
        )
    return delimiter or found[0], 1


def _first_row(lines: Sequence[str], delimiter: str) -> int | None:
    """Return the place of the first row of numbers that has titles above it and a row like it below."""
    for place in range(1, len(lines)):
        fields = _fields(lines[place], delimiter)
        if len(fields) < 2 or not _is_row(fields):
            continue
        below = next((line for line in lines[place + 1 :] if line.strip()), None)
        if below is None or _is_row(_fields(below, delimiter)):
            return None if _is_row(_fields(lines[place - 1], delimiter)) else place
    return None


def _is_row(fields: Sequence[str]) -> bool:
    numbers = [field for field in fields if field]
    return bool(numbers) and all(_NUMBER.fullmatch(field) or is_date(field) for field in numbers)


def _fields(line: str, delimiter: str) -> list[str]:
    return [field.strip().strip('"').strip() for field in line.strip("\r\n").split(delimiter)]


def _titles(lines: Sequence[str], first: int, delimiter: str) -> tuple[list[str], list[str]]:
    """Return titles and units: those of a row of its own, where the time's field there is a unit of time."""
    below = _fields(lines[first - 1].lstrip("\ufeff").lstrip("#%"), delimiter) if lines else [""]
    if first >= 2:
        above = _fields(lines[first - 2].lstrip("\ufeff").lstrip("#%"), delimiter)
        time = next((place for place, name in enumerate(above) if name.lower() in _TIMES), None)
        if time is not None and len(above) == len(below):
            units = [field.strip("[]() ") for field in below]
            if seconds_in(units[time]) is not None or units[time] in ("", "-"):
                return above, ["" if unit == "-" else unit for unit in units]
    return below, []


def _named(path: Path, first: int, titles: Sequence[str], units: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return names and units, taken apart where a title has both."""
    names, found = [], []
    for place, title in enumerate(titles):
        match = None if units else _COLUMN.fullmatch(title)
        name = match["name"].strip() if match else title
        if not name:
            raise RecordingError(f'{path}, line {max(first, 1)}: expected titles like "M_s [V]", found "{title[:80]}".')
        names.append(name.replace("/", "|") if name.lower() not in _TIMES else name)
        found.append(plain_unit(match["unit"] if match else units[place] if units else ""))
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise RecordingError(
            f"{path}, line {max(first, 1)}: expected different names, found {', '.join(twice)[:200]} twice."
        )
    return names, found


def _decimal(path: Path, rows: Sequence[str], delimiter: str, dates: int | None) -> str:
    if delimiter == ",":
        return "."
    fields = [field for row in rows for place, field in enumerate(_fields(row, delimiter)) if place != dates]
    commas = any("," in field for field in fields)
    points = any("." in field for field in fields)
    if commas and points:
        raise RecordingError(
            f"{path}: expected a decimal point or a decimal comma, found both in the first rows; pass decimal=."
        )
    return "," if commas else "."
