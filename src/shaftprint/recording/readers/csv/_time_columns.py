"""Which columns of a table hold the times of its rows."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._time_scale import is_capital, unit_in_name
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._dates import dates, is_date
from shaftprint.recording.readers.csv._day_times import AMBIGUOUS, AMBIGUOUS_DAY
from shaftprint.recording.readers.csv._fields import DATE, DAY_TIME, GAP, NUMBER, TEXT, is_number
from shaftprint.recording.readers.csv._table import Table
from shaftprint.recording.readers.csv._time_titles import MILLISECONDS, begins_as_time, is_time_title
from shaftprint.recording.readers.csv._titles import counts_rows

_LONGEST, _MINUTE_S = 80, 61.0
_COMPACT_DAY = re.compile(r"(19|20)\d{6}")
_SECONDS = ("sec", "secs", "second", "seconds")
_FRACTIONS = {
    word: unit
    for words, unit in (("nsec nsecs nanosec nanosecs nanoseconds", 1e-9), ("usec usecs microsec microseconds", 1e-6))
    for word in words.split()
}
# times may go back where a logger begins again
_MOST = 0.9


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
    fraction: tuple[int, float] | None = None
    """Column of what is beyond the whole seconds of the times, and its unit [s]."""
    more: tuple[tuple[int, str | None], ...] = ()
    """Further columns of times, each with its unit, None of dates: the columns behind it are on those."""
    other_dates: int | None = None
    """Column of dates that are others than those of the rows."""
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


def without_times(table: Table, names: Sequence[str]) -> str:
    """Return what to do about a table in which no column is one of times: only one that ascends may be."""
    rate = "pass sample_rate_hz= (--sample-rate)"
    numbers = [place for place, kind in enumerate(table.kinds) if kind == NUMBER]
    ascending = [place for place in numbers if _ascends([row[place] for row in table.rows])]
    if not ascending:
        return f"no column ascends as times do: {rate}, the rate of the rows"
    place = ascending[0]
    if names[place]:
        proposal = f"{printable(names[place])}=time [s]"
    else:
        proposal = ",".join("time [s]" if at == place else name or "-" for at, name in enumerate(names))
    return f'name the columns, columns= (--columns "{proposal}"), or {rate} where there are no times'


def _instead(field: str) -> str:
    """Return what to do about a date that is none."""
    which = ", of which day and month cannot be told apart" if AMBIGUOUS.fullmatch(field) else ""
    return f"{which}; write the dates as in ISO 8601, or pass the rate of the rows, sample_rate_hz= (--sample-rate)"


def time_columns(table: Table, names: Sequence[str], units: Sequence[str], *, has_rate: bool) -> TimeColumns:
    """Return which columns hold the times: numbers by their title, else dates, times of day, or what counts time."""
    first = _first_times(table, names, units, has_rate=has_rate)
    if first.place is None:
        return first
    if first.stamps:
        first = replace(first, more=_more_dates(table, names, first))
        return first if first.more else replace(first, other_dates=_other_dates(table, names, first))
    return replace(first, more=_more(table, names, units, cast(int, first.place)))


def _more(table: Table, names: Sequence[str], units: Sequence[str], first: int) -> tuple[tuple[int, str], ...]:
    """Return further columns of times: with a column between them and the times before, and one behind."""
    more: list[tuple[int, str]] = []
    before = first
    for place in range(first + 2, table.width - 1):
        unit = _of_time(units[place]) or unit_in_name(names[place]) or ""
        is_of_time = table.kinds[place] == NUMBER and (not unit or seconds_in(unit) is not None)
        ascends = is_of_time and _ascends([row[place] for row in table.rows], _MOST)
        if ascends and _may_be_further(names, place, first) and place > before + 1:
            more.append((place, unit))
            before = place
    return tuple(more)


def _may_be_further(names: Sequence[str], place: int, first: int) -> bool:
    return _is_titled(names, place) or names[place] == names[first] or _is_of_next(names, place)


def _more_dates(table: Table, names: Sequence[str], first: TimeColumns) -> tuple[tuple[int, None], ...]:
    """Return further columns of dates, or of dates and times of day, that go on in front of columns of their own."""
    lead, size = first.stamps[0], len(first.stamps)
    form = table.kinds[lead : lead + size]
    if first.stamps != tuple(range(lead, lead + size)) or set(form) - {DATE, DAY_TIME}:
        return ()
    places = [
        place
        for place in range(lead + size + 1, table.width - size)
        if table.kinds[place : place + size] == form
        and table.kinds[place - 1] not in (DATE, DAY_TIME)
        and _may_be_further(names, place, lead)
    ]
    return tuple((one, None) for one in places if len({row[one : one + size] for row in table.rows}) > 1)


def _other_dates(table: Table, names: Sequence[str], first: TimeColumns) -> int | None:
    """Return the first column of dates that are others than those of the rows, with columns of their own behind it."""
    for place in range(max(first.stamps) + 2, table.width - 1):
        alike = [stamp for stamp in first.stamps if table.kinds[place] == table.kinds[stamp] in (DATE, DAY_TIME)]
        if alike and any(row[place] not in ("", *(row[stamp] for stamp in alike)) for row in table.rows):
            return place
    return None


def _is_titled(names: Sequence[str], place: int) -> bool:
    return is_time_title(names[place]) or begins_as_time(names[place])


def _is_of_next(names: Sequence[str], place: int) -> bool:
    """Return whether a title is that of the times of the next column: Torque time, Torque."""
    own, following = (" ".join(name.lower().replace("_", " ").split()) for name in (*names, "")[place : place + 2])
    return own in (f"{following} time", f"time {following}")


def _first_times(table: Table, names: Sequence[str], units: Sequence[str], *, has_rate: bool) -> TimeColumns:
    kinds = table.kinds
    dated = [place for place, kind in enumerate(kinds) if kind == DATE]
    # one that stays is the begin of an export where another goes on: _start, _stop, _time
    dated = [place for place in dated if len({row[place] for row in table.rows} - {""}) > 1] or dated
    hours = [place for place, kind in enumerate(kinds) if kind == DAY_TIME]
    titled = [place for place, name in enumerate(names) if kinds[place] in (NUMBER, GAP) and is_time_title(name)]
    # 20260305 beside a time of day
    titled = [
        place for place in titled if not hours or not all(_COMPACT_DAY.fullmatch(row[place]) for row in table.rows)
    ]
    titled = [place for place in titled if not _is_of_second(table, place, hours, units)]
    plain = [place for place in titled if not is_capital(names[place])] or titled
    whole = _whole_seconds(table, names)
    if whole is not None and (not plain or plain[0] == whole.place):
        return whole
    # a time in a column further on may be anything where dates stand in the first
    if plain and not (dated and seconds_in(_of_time(units[plain[0]]) or "s") is None):
        place = plain[0]
        unit = _of_time(units[place]) or unit_in_name(names[place]) or ""
        if not dated or (names[place].lower() not in MILLISECONDS and _agree(table, place, unit, dated[0])):
            return TimeColumns(
                place=place,
                unit=unit,
                dates_beside=dated[0] if dated and not hours else None,
            )
    if dated or hours:
        return _stamps(table, names, units, dated, hours)
    if has_rate:
        return TimeColumns()
    first = next((place for place, kind in enumerate(kinds) if kind == NUMBER), None)
    if first is None:
        return TimeColumns()
    ascends = _ascends([row[first] for row in table.rows])
    # few digits may make two times equal
    stays = not names[first] and bool(units[first]) and _ascends([row[first] for row in table.rows], equal=True)
    if stays and seconds_in(units[first]) is not None:
        return TimeColumns(place=first, unit=units[first])
    if ascends and (seconds_in(units[first]) is not None or begins_as_time(names[first]) or _is_of_next(names, first)):
        return TimeColumns(place=first, unit=units[first])
    if ascends and not names[first] and not counts_rows([row[first] for row in table.rows]):
        return TimeColumns(
            place=first, unit=units[first], remark="The first column, which has no title, was taken for the times"
        )
    return TimeColumns()


def _whole_seconds(table: Table, names: Sequence[str]) -> TimeColumns | None:
    """Return times of which whole seconds stand in one column, what is beyond them in the next: secs, nsecs."""
    last_words = [re.split(r"[ ._/|]", name.lower())[-1] for name in names]
    for place, (word, behind) in enumerate(pairwise(last_words)):
        if word in _SECONDS and behind in _FRACTIONS and set(table.kinds[place : place + 2]) == {NUMBER}:
            return TimeColumns(place=place, unit="s", fraction=(place + 1, _FRACTIONS[behind]))
    return None


def _agree(table: Table, place: int, unit: str, date: int) -> bool:
    """Return whether times with a unit go on as the dates beside them do, which may say minutes alone."""
    second = seconds_in(unit)
    rows = [row for row in table.rows if is_number(row[place]) and is_date(row[date]) and ":" in row[date]]
    if second is None or len(rows) < 2:
        return True
    try:
        first, last = dates(Path(), [row[date] for row in (rows[0], rows[-1])])
    except RecordingError:
        return True
    by_dates_s = float((last - first) / np.timedelta64(1, "s"))
    begin, end = (float(row[place].replace(",", ".")) for row in (rows[0], rows[-1]))
    return abs((end - begin) * second - by_dates_s) <= _MINUTE_S + 0.1 * abs(by_dates_s)


def _stamps(
    table: Table, names: Sequence[str], units: Sequence[str], dates: Sequence[int], hours: Sequence[int]
) -> TimeColumns:
    """Return dates, with the times of day and the milliseconds beside them."""
    if not dates:
        # dates of which nobody can tell the day stand in front of the times of day
        dates = [
            place
            for place, kind in enumerate(table.kinds[: hours[0]])
            if kind == TEXT and all(AMBIGUOUS_DAY.fullmatch(row[place]) for row in table.rows)
        ]
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
            if table.kinds[place] == NUMBER
            and (
                name.lower() in MILLISECONDS
                or (not name and units[place] == "ms")
                or _is_of_second(table, place, stamps[-1:], units)
            )
        ),
        None,
    )
    if thousandths is None or any("." in part.rpartition(":")[2] for part in parts):
        return TimeColumns(place=lead, stamps=tuple(stamps))
    return TimeColumns(place=lead, stamps=(*stamps, thousandths), milliseconds=thousandths)


def _is_of_second(table: Table, place: int, hours: Sequence[int], units: Sequence[str]) -> bool:
    """Return whether numbers are milliseconds that begin again with each second of the times of day before them."""
    rows = [(row[place - 1], row[place]) for row in table.rows]
    if place - 1 not in hours or units[place] != "ms" or not all(part.isdecimal() for _, part in rows):
        return False
    changes = [(first != second, int(after) <= int(before)) for (first, before), (second, after) in pairwise(rows)]
    return (True, True) in changes and all(is_next == begins for is_next, begins in changes)


def _of_time(unit: str) -> str:
    """Return the unit of a time, in small letters where only those make it one."""
    return unit if seconds_in(unit) is not None or seconds_in(unit.lower()) is None else unit.lower()


def _ascends(fields: Sequence[str], share: float = 1.0, *, equal: bool = False) -> bool:
    """Return whether numbers ascend, at no less than a share of the steps; ``equal``: or stay."""
    numbers = [float(field.replace(",", ".")) for field in fields if is_number(field)]
    ascending = sum(below > above or (equal and below == above) for above, below in pairwise(numbers))
    return len(numbers) > 1 and ascending >= share * (len(numbers) - 1)
