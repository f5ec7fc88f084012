"""The first lines of a text file: what separates the columns, what they are called and in which unit."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.escape import csv_cell_text
from shaftprint.recording.readers._time_scale import time_of, unit_in_name
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._dates import is_date
from shaftprint.recording.readers.csv._wrong_rows import wrong_rows
from shaftprint.units import plain_unit

WHITE_SPACE = " "
_MARKS = (";", "\t", ",")
_DELIMITERS = (*_MARKS, WHITE_SPACE)
# a title with its unit behind it, where white space stands between columns
_SPACED_TITLE = re.compile(r"\S+(?:\s*[\[(][^\])]*[\])])?")
_COLUMN = re.compile(r"(?P<name>.*\S)\s*[\[(](?P<unit>[^\])]*)[\])]")
_NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf(inity)?)", re.IGNORECASE)
_TIMES = ("date", "datetime", "date/time", "date time", "datum", "x_value")
# LabVIEW's titles end with one for remarks, which its rows of numbers do not have.
_REMARKS = "comment"


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """How the lines of a text file are to be read."""

    delimiter: str
    """What stands between two columns; a space for white space of any length."""
    decimal: str
    """Decimal point or comma."""
    names: tuple[str, ...]
    """Name of each column."""
    units: tuple[str, ...]
    """Unit of each column; empty where the file gives none."""
    lines: int
    """How many lines stand before the first row of numbers."""
    time_column: int | None
    """Which column holds the times; None where there is none."""
    time_unit: str | None
    """Unit of the times, empty where the file gives none; None where times are dates, or there are none."""

    @property
    def dated(self) -> bool:
        """Whether times are dates."""
        return self.time_column is not None and self.time_unit is None


def split_row(line: str, delimiter: str) -> list[str]:
    """Return the fields of a line as they are written."""
    return line.split() if delimiter == WHITE_SPACE else line.rstrip("\r\n").split(delimiter)


def read_header(
    path: Path,
    lines: Sequence[str],
    *,
    delimiter: str | None,
    decimal: str | None,
    columns: str | None = None,
    has_rate: bool = False,
) -> Header:
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
    columns
        Titles that the caller gives in place of the file's, separated by commas.
    has_rate
        Whether the caller knows the sample rate, so that a column of times may be absent.

    Raises
    ------
    RecordingError
        If a name is missing or comes twice, there are no titles or no times, or delimiter or decimal sign could be
        read in two ways.
    """
    hinted = [] if columns is None else [title.strip() for title in columns.split(",")]
    delimiter, first = _layout(path, lines, delimiter, len(hinted))
    if not hinted:
        _expect_titles_above(path, lines, first, delimiter)
    titles, units = (hinted, []) if hinted else _titles(lines, first, delimiter)
    names, units = _named(path, first, titles, units)
    rows = lines[first:]
    where = f"{path}, line {max(first, 1)}"
    time, unit = _time(rows, delimiter, names, units)
    if time is None and not has_rate:
        raise RecordingError(
            f'{where}: expected a column "time [s]", found "{"; ".join(titles)[:80]}"; '
            "name it so with columns=, or pass sample_rate_hz= (--columns and --sample-rate of shaftprint convert)."
        )
    if time is not None and len(names) == 1 and has_rate:
        raise RecordingError(f"{where}: expected a channel besides the time, found none.")
    decimal = decimal or _decimal(path, rows, delimiter, time if unit is None else None)
    if decimal == delimiter:
        raise RecordingError(f'{path}: expected decimal sign and delimiter to differ, found "{decimal}" for both.')
    return Header(
        delimiter=delimiter,
        decimal=decimal,
        names=tuple(names),
        units=tuple(units),
        lines=first,
        time_column=time,
        time_unit=unit,
    )


def looks_like_a_table(lines: Sequence[str]) -> bool:
    """Return whether text has rows of numbers below each other, at least two in a row."""
    return any(_first_row(lines, delimiter) is not None for delimiter in _DELIMITERS)


def _layout(path: Path, lines: Sequence[str], delimiter: str | None, width: int) -> tuple[str, int]:
    """Return the delimiter and the number of lines before the first row of numbers, of which there are ``width``."""
    lone = None if delimiter or width else _row_below_lone_time(lines)
    if lone is not None:
        return _MARKS[0], lone
    candidates = (delimiter,) if delimiter else _DELIMITERS
    places = {candidate: _first_row(lines, candidate, width) for candidate in candidates}
    for candidate, first in places.items():
        if first or (first == 0 and width):
            return candidate, first
    if width:
        raise RecordingError(f"{path}: expected a row of {width} columns, as the hint columns says, found none.")
    untitled = [candidate for candidate, first in places.items() if first == 0]
    if untitled:
        width_of_row = len(_fields(lines[0], untitled[0]))
        raise RecordingError(
            f'{path}, line 1: expected titles such as "time [s];M_s [N m]" above {width_of_row} columns of numbers, '
            "found none; pass columns= (--columns of shaftprint convert), such as time,u,y."
        )
    title = lines[0] if lines else ""
    marks = [mark for mark in _MARKS if mark in title]
    if len(marks) != 1 and delimiter is None:
        what = "several of them" if marks else "none of them"
        raise RecordingError(
            f"{path}, line 1: expected columns separated by semicolon, tab, comma or white space, found {what} in "
            f'"{title.strip()[:80]}"; pass delimiter= (--delimiter of shaftprint convert).'
        )
    return delimiter or marks[0], 1


def _row_below_lone_time(lines: Sequence[str]) -> int | None:
    """Return the place of the first number of a column of times alone, below its title; nothing where there is none."""
    for row, (title, line) in enumerate(pairwise(lines), start=1):
        if _time_column([_bare(title.lstrip("\ufeff").lstrip("#%").strip().strip('"'))]) is not None:
            return row if _NUMBER.fullmatch(line.strip()) else None
    return None


def _expect_titles_above(path: Path, lines: Sequence[str], first: int, delimiter: str) -> None:
    """Refuse a damaged row of numbers that would be taken for titles, because the row below it is the first good one.

    Raises
    ------
    RecordingError
        If a line above the first row has a time where titles further above have their column of times.
    """
    for place in range(first - 1):
        titles = [_bare(title) for title in _title_fields(lines[place], delimiter, 0)]
        time = _time_column(titles)
        if time is None:
            continue
        rows = [(number + 1, _fields(lines[number], delimiter)) for number in range(place + 1, first)]
        timed = [(number, row) for number, row in rows if time < len(row) and _is_row(row[time : time + 1])]
        wrong = [(number, row) for number, row in timed if len(row) != len(titles) or not _is_row(row)]
        if wrong:
            raise wrong_rows(path, [(number, list(map(_pointed, row))) for number, row in wrong], titles, time=time)
        return


def _pointed(field: str) -> str:
    return field.replace(",", ".") if _NUMBER.fullmatch(field) else field


def _bare(title: str) -> str:
    match = _COLUMN.fullmatch(title)
    return match["name"].strip() if match else title


def _first_row(lines: Sequence[str], delimiter: str, width: int = 0) -> int | None:
    """Return the place of the first row of numbers, ``width`` or else at least two, that has a row like it below."""
    for row, line in enumerate(lines):
        fields = _fields(line, delimiter)
        if (len(fields) != width if width else len(fields) < 2) or not _is_row(fields):
            continue
        below = next((line for line in lines[row + 1 :] if line.strip()), None)
        if below is None or _is_row(_fields(below, delimiter)):
            return row
    return None


def _is_row(fields: Sequence[str]) -> bool:
    numbers = [field for field in fields if field]
    return bool(numbers) and all(_NUMBER.fullmatch(field) or is_date(field) for field in numbers)


def _fields(line: str, delimiter: str) -> list[str]:
    return [field.strip().strip('"').strip() for field in split_row(line, delimiter)]


def _time(
    rows: Sequence[str], delimiter: str, names: Sequence[str], units: Sequence[str]
) -> tuple[int | None, str | None]:
    """Return which column holds the times, and their unit, None for dates."""
    time = _time_column(names)
    if time is None:
        return None, None
    first = _fields(rows[0], delimiter) if rows else []
    if is_date(first[time] if time < len(first) else ""):
        return time, None
    return time, units[time] or unit_in_name(names[time]) or ""


def _time_column(names: Sequence[str]) -> int | None:
    """Return which column holds the times by its title; one of dates goes before others."""
    return next((column for column, name in enumerate(names) if name.lower() in _TIMES), time_of(names))


def _titles(lines: Sequence[str], first: int, delimiter: str) -> tuple[list[str], list[str]]:
    """Return titles and units: those of a separate row, where the time's field there is a unit of time."""
    width = len(split_row(lines[first], delimiter)) if first < len(lines) else 0
    below = _title_fields(lines[first - 1], delimiter, width) if lines else [""]
    if first >= 2:
        above = _title_fields(lines[first - 2], delimiter, width)
        time = _time_column(above)
        if time is not None and len(above) == len(below):
            units = [field.strip("[]() ") for field in below]
            if seconds_in(units[time]) is not None or units[time] in ("", "-"):
                return above, ["" if unit == "-" else unit for unit in units]
    return below, []


def _title_fields(line: str, delimiter: str, width: int) -> list[str]:
    """Return the titles of a line; with white space between columns those that are as many as the columns."""
    line = line.lstrip("\ufeff").lstrip("#%")
    if delimiter != WHITE_SPACE:
        titles = [csv_cell_text(field) for field in _fields(line, delimiter)]
        return titles[:-1] if len(titles) == width + 1 and titles[-1].lower() == _REMARKS else titles
    spaced = _SPACED_TITLE.findall(line)
    far_apart = re.split(r"\s{2,}", line.strip())
    return far_apart if len(spaced) != width == len(far_apart) else spaced


def _named(path: Path, first: int, titles: Sequence[str], units: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return names and units, taken apart where a title has both."""
    names, parsed_units = [], []
    for column, title in enumerate(titles):
        match = None if units else _COLUMN.fullmatch(title)
        name = match["name"].strip() if match else title
        if not name:
            raise RecordingError(f'{path}, line {max(first, 1)}: expected titles like "M_s [V]", found "{title[:80]}".')
        names.append(name.replace("/", "|") if _time_column([name]) is None else name)
        parsed_units.append(plain_unit(match["unit"] if match else units[column] if units else ""))
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise RecordingError(
            f"{path}, line {max(first, 1)}: expected different names, found {', '.join(twice)[:200]} twice."
        )
    return names, parsed_units


def _decimal(path: Path, rows: Sequence[str], delimiter: str, dates: int | None) -> str:
    if delimiter == ",":
        return "."
    fields = [field for row in rows for column, field in enumerate(_fields(row, delimiter)) if column != dates]
    commas = any("," in field for field in fields)
    points = any("." in field for field in fields)
    if commas and points:
        raise RecordingError(
            f"{path}: expected a decimal point or a decimal comma, found both in the first rows; pass decimal= "
            "(--decimal of shaftprint convert)."
        )
    return "," if commas else "."
