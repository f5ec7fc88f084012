"""Which columns of a table hold the times of its rows."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._time_scale import is_capital, unit_in_name
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._dates import AMBIGUOUS
from shaftprint.recording.readers.csv._fields import DATE, DAY_TIME, GAP, NUMBER, TEXT, is_number
from shaftprint.recording.readers.csv._table import Table
from shaftprint.recording.readers.csv._time_titles import MILLISECONDS, begins_as_time, is_time_title
from shaftprint.recording.readers.csv._titles import counts_rows

_LONGEST = 80


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeColumns:
    """Which columns make the times."""

    place: int | None = None
    """Column of the numbers, or of the dates; None where there are no times."""
    unit: str | None = None
    """Unit of numbers; None where times are dates."""
    stamps: tuple[int, ...] = ()
    """Columns of dates, times of day and milliseconds, which make the times together."""
    milliseconds: int | None = None
    """Which of them holds milliseconds alone."""
    dates_beside: int | None = None
    """Column of dates beside times that are numbers."""
    remark: str = ""
    """What was taken though the file does not say it."""


def expect_no_words_as_times(path: Path, table: Table, names: Sequence[str]) -> None:
    """Refuse a column of times whose fields are none.

    Raises RecordingError if there is one.
    """
    for place, name in enumerate(names):
        if table.kinds[place] == TEXT and is_time_title(name):
            field = table.rows[0][place]
            raise RecordingError(
                f"{path}, line {table.first + 1}, column {place + 1} ({name}): expected seconds or a date such as "
                f'2026-11-22 10:00:00, found "{printable(field)[:_LONGEST]}"{_instead(field)}.'
            )


def _instead(field: str) -> str:
    """Return what to do about a date that is none."""
    which = ", of which day and month cannot be told apart" if AMBIGUOUS.fullmatch(field) else ""
    return f"{which}; write the dates as in ISO 8601, or pass the rate of the rows, sample_rate_hz= (--sample-rate)"


def time_columns(table: Table, names: Sequence[str], units: Sequence[str], *, has_rate: bool) -> TimeColumns:
    """Return which columns hold the times: numbers by their title, else dates, times of day, or what counts time."""
    kinds = table.kinds
    dates = [place for place, kind in enumerate(kinds) if kind == DATE]
    hours = [place for place, kind in enumerate(kinds) if kind == DAY_TIME]
    titled = [place for place, name in enumerate(names) if kinds[place] in (NUMBER, GAP) and is_time_title(name)]
    plain = [place for place in titled if not is_capital(names[place])] or titled
    # a time in a column further on may be anything where dates stand in the first
    if plain and not (dates and seconds_in(_of_time(units[plain[0]]) or "s") is None):
        place = plain[0]
        if not dates or names[place].lower() not in MILLISECONDS:
            return TimeColumns(
                place=place,
                unit=_of_time(units[place]) or unit_in_name(names[place]) or "",
                dates_beside=dates[0] if dates and not hours else None,
            )
    if dates or hours:
        return _stamps(table, names, units, dates, hours)
    if has_rate:
        return TimeColumns()
    first = next((place for place, kind in enumerate(kinds) if kind == NUMBER), None)
    if first is None:
        return TimeColumns()
    ascends = _ascends([row[first] for row in table.rows])
    if ascends and (seconds_in(units[first]) is not None or begins_as_time(names[first])):
        return TimeColumns(place=first, unit=units[first])
    if ascends and not names[first] and not counts_rows([row[first] for row in table.rows]):
        return TimeColumns(
            place=first, unit=units[first], remark="The first column, which has no title, was taken for the times"
        )
    return TimeColumns()


def _stamps(
    table: Table, names: Sequence[str], units: Sequence[str], dates: Sequence[int], hours: Sequence[int]
) -> TimeColumns:
    """Return dates, with the times of day and the milliseconds beside them."""
    lead = dates[0] if dates else hours[0]
    stamps = [lead]
    has_hours = not dates or any(":" in row[lead] for row in table.rows)
    if not has_hours and hours:
        stamps.append(hours[0])
        has_hours = True
    parts = [row[stamps[-1]] for row in table.rows]
    thousandths = next(
        (
            place
            for place, name in enumerate(names)
            if table.kinds[place] == NUMBER and (name.lower() in MILLISECONDS or (not name and units[place] == "ms"))
        ),
        None,
    )
    if thousandths is None or any("." in part.rpartition(":")[2] for part in parts):
        return TimeColumns(place=lead, stamps=tuple(stamps))
    return TimeColumns(place=lead, stamps=(*stamps, thousandths), milliseconds=thousandths)


def _of_time(unit: str) -> str:
    """Return the unit of a time, in small letters where only those make it one."""
    return unit if seconds_in(unit) is not None or seconds_in(unit.lower()) is None else unit.lower()


def _ascends(fields: Sequence[str]) -> bool:
    numbers = [float(field.replace(",", ".")) for field in fields if is_number(field)]
    return len(numbers) > 1 and all(below > above for above, below in pairwise(numbers))
