"""The first lines of a text file: what separates the columns, what they are called, in which unit, which are times."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers._gather import told_apart
from shaftprint.recording.readers.csv._fields import (
    DATE,
    DAY_TIME,
    GAP,
    NUMBER,
    TEXT,
    decimal_sign,
    is_number,
    split_row,
    with_point,
)
from shaftprint.recording.readers.csv._head_beside import head_beside
from shaftprint.recording.readers.csv._head_facts import HeadFacts, head_facts, is_fact
from shaftprint.recording.readers.csv._lone_column import lone_table
from shaftprint.recording.readers.csv._long_form import (
    expect_a_column_a_signal,
    expect_one_table,
    expect_plain_values,
    expect_rows_of_one,
)
from shaftprint.recording.readers.csv._scope_export import began_of_export, width_of_export
from shaftprint.recording.readers.csv._table import Table, find_table
from shaftprint.recording.readers.csv._time_columns import (
    TimeColumns,
    expect_no_words_as_times,
    time_columns,
    without_times,
)
from shaftprint.recording.readers.csv._time_titles import is_time_title
from shaftprint.recording.readers.csv._titles import (
    counts_rows,
    name_and_unit,
    of_pairs,
    titles_and_units,
    told_apart_by_remarks,
)
from shaftprint.recording.readers.csv._validity import Status, status_columns
from shaftprint.units import plain_unit

# Titles of a column that counts the rows.
_COUNTERS = (
    "", "no", "no.", "nr", "nr.", "number", "index", "#", "sequence", "record", "sample", "samples", "point", "row",
    "id", "rn", "scan", "stepcount", "step", "count", "store no.", "counter", "zeile", "unnamed: 0",
)  # fmt: skip
_SHOWN = 80
# An example of names for as many columns as this names each.
_MOST_NAMED = 12


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """How the lines of a text file are to be read."""

    delimiter: str
    """What stands between two columns; a space for white space of any length."""
    decimal: str
    """Decimal point or comma."""
    names: tuple[str, ...]
    """Name of each column that is read."""
    units: tuple[str, ...]
    """Unit of each; empty where the file gives none."""
    places: tuple[int, ...]
    """Which column of the file each is."""
    width: int
    """Number of fields of a row."""
    lines: int
    """How many lines stand before the first row of numbers."""
    time_column: int | None
    """Which of the columns that are read holds the times; None where there is none."""
    time_unit: str | None
    """Unit of the times, empty where the file gives none; None where times are dates, or there are none."""
    more_times: tuple[tuple[int, str | None], ...] = ()
    """Further columns of times among those that are read, each with its unit, None of dates: those behind are on it."""
    is_whole: bool = False
    """Whether rows have all fields, the last a number: one that is shorter is damaged."""
    first_line: int = 1
    """Which line of the file is the first of what is read."""
    stamps: tuple[int, ...] = ()
    """Columns of the file that hold dates, times of day and milliseconds, which make the times together."""
    milliseconds: int | None = None
    """Which of the stamps holds milliseconds alone."""
    fraction: tuple[int, float] | None = None
    """Column of the file that holds what is beyond the whole seconds of the times, and its unit [s]."""
    dates_beside: int | None = None
    """Column of the file that holds dates beside times that are numbers."""
    rate_hz: float | None = None
    """Sample rate that the lines above the titles give, where there are no times [Hz]."""
    stated_rate_hz: float | None = None
    """The same beside times, which may be rounded or without a unit [Hz]."""
    stated_rounded: float = 0.0
    """By how much of itself it may be off, as it is printed."""
    start_s: float = 0.0
    """Second of the first row that they give [s]."""
    began: datetime | None = None
    """Date of second 0 that they give."""
    status: tuple[Status, ...] = ()
    """Columns that say whether the values of others count."""
    titles: tuple[str, ...] = ()
    """Names of all columns."""
    head: frozenset[str] = frozenset()
    """The titles and the lines about them, without white space at their ends: they may come again."""
    left_out: dict[str, str] = field(default_factory=dict)
    """Why other columns are not read."""
    remarks: tuple[str, ...] = ()
    """What was taken though the file does not say it, a sentence each."""

    @property
    def dated(self) -> bool:
        """Whether times are dates or times of day."""
        return bool(self.stamps)

    @property
    def more_dates(self) -> tuple[tuple[int, ...], ...]:
        """Columns of the file that hold dates of the columns behind them, as many as make those of the rows."""
        size, first = len(self.stamp_texts), (self.places[column] for column, unit in self.more_times if unit is None)
        return tuple(tuple(range(place, place + size)) for place in first)

    @property
    def stamp_texts(self) -> tuple[int, ...]:
        """Columns of the file that hold the dates and times of day among the stamps, without the milliseconds."""
        return tuple(place for place in self.stamps if place != self.milliseconds)

    def pointed(self, field: str) -> str:
        """Return a field with a decimal point in place of the file's decimal sign."""
        return with_point(field, self.decimal)


def looks_like_a_table(lines: Sequence[str]) -> bool:
    """Return whether text has rows of numbers below each other, at least two in a row."""
    table = find_table(lines)
    return table is not None and len(table.rows) > 1


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

    Lines before the titles are passed over, but for what they say of the clock.

    ``path``: the file, for messages. ``lines``: its first lines. ``delimiter``, ``decimal``: what the caller knows;
    found in the lines if absent. ``columns``: titles that the caller gives in place of the file's, separated by commas,
    or other names for some of them, as in ``Datum/Uhrzeit=time``. ``has_rate``: whether the caller knows the sample
    rate, so that a column of times may be absent. Raises RecordingError if there are no titles or no times, or
    delimiter or decimal sign could be read in two ways.
    """
    asked = [] if columns is None else [title.strip() for title in columns.split(",")]
    renamed = bool(asked) and all("=" in title for title in asked)
    expect_plain_values(path, lines)
    beside = head_beside(lines)
    lines = lines if beside is None else beside.rows
    table = _expect_table(
        path, lines, delimiter, (0 if renamed else len(asked)) or width_of_export(lines), has_rate=has_rate
    )
    if beside is None:
        expect_one_table(path, lines, table)
    units: list[str]
    titles, units = (asked + [""] * (table.width - len(asked)), []) if asked and not renamed else ([], [])
    if not titles:
        titles, units = titles_and_units(lines, table) if beside is None else (list(beside.names), list(beside.units))
        _expect_titles(path, lines, table, titles)
        titles = of_pairs(titles, table)
    if renamed:
        titles = _renamed(path, titles, asked)
    parsed = [name_and_unit(title) for title in titles] if not units else list(zip(titles, units, strict=True))
    names = [printable(name if is_time_title(name) else name.replace("/", "|")) for name, _ in parsed]
    names = ["" if kind == GAP and is_fact(name) else name for name, kind in zip(names, table.kinds, strict=True)]
    units = [plain_unit(unit) for _, unit in parsed]
    expect_a_column_a_signal(path, table, names)
    expect_rows_of_one(path, table, names)
    facts = head_facts([line for line in lines[: table.first] if line.strip()], table.delimiter)
    times = time_columns(table, [name for name, _ in parsed], units, has_rate=has_rate)
    where = f"{path}, line {max(table.first, 1)}"
    if times.place is None and not has_rate and facts.rate_hz is None:
        expect_no_words_as_times(path, table, names)
        advice = without_times(table, [name for name, _ in parsed])
        raise RecordingError(f'{where}: expected a column "time [s]", found "{"; ".join(titles)[:_SHOWN]}"; {advice}.')
    names = told_apart(told_apart_by_remarks(titles, names))
    kept, left_out = _chosen(table, names, times)
    if not set(kept) - {times.place} and (has_rate or len(names) > 1):
        reasons = "".join(f"; {name}: {reason}" for name, reason in left_out.items())
        raise RecordingError(f"{where}: expected a channel besides the time, found none{reasons[:_SHOWN]}.")
    decimal = decimal or _decimal(path, table, [place for place in kept if place not in times.stamps])
    _expect_other_delimiter(path, table, decimal)
    return Header(
        delimiter=table.delimiter,
        decimal=decimal,
        names=tuple(names[place] or "time" for place in kept),
        units=tuple(units[place] for place in kept),
        places=tuple(kept),
        width=table.width,
        is_whole=not times.more
        and not set(table.kinds[1 + max([*kept, *times.stamps]) :]) & {GAP, TEXT}
        and table.kinds[-1] == NUMBER,
        lines=table.first,
        time_column=None if times.place is None else kept.index(times.place),
        time_unit=times.unit,
        more_times=tuple((kept.index(place), unit) for place, unit in times.more if place in kept),
        stamps=times.stamps,
        milliseconds=times.milliseconds,
        fraction=times.fraction,
        dates_beside=times.dates_beside,
        rate_hz=facts.rate_hz if times.place is None else None,
        stated_rate_hz=None if times.place is None else facts.rate_hz,
        stated_rounded=facts.rounded,
        start_s=facts.start_s + _skipped(table, names) / (facts.rate_hz or np.inf) if times.place is None else 0.0,
        began=began_of_export(lines[: table.first]),
        status=status_columns(table, names, [place for place in kept if place != times.place]),
        titles=tuple(names),
        head=frozenset(line.strip() for line in lines[: table.first] if line.strip()),
        left_out=left_out,
        remarks=_remarks(path, times, facts, has_rate=has_rate),
    )


def _expect_table(path: Path, lines: Sequence[str], delimiter: str | None, width: int, *, has_rate: bool) -> Table:
    """Return the table of a file.

    Raises RecordingError if there is none, or not one of the number of columns that the caller names.
    """
    table = find_table(lines, delimiter=delimiter, width=width)
    if table is None and width:
        table = find_table(lines, delimiter=delimiter)
        if table is not None and (table.width < width or set(table.kinds[width:]) - {GAP}):
            shown = "; ".join(title or "(no title)" for title in titles_and_units(lines, table)[0])
            raise RecordingError(
                f"{path}: expected a row of {width} columns, as the hint columns says, found {table.width}"
                + (f": {shown[:_SHOWN]}" if shown else "")
                + '; name each of them in order, or only some with their titles, as "Datum/Uhrzeit=time".'
            )
    return table or lone_table(path, lines, delimiter, width, has_rate=has_rate)


def _expect_titles(path: Path, lines: Sequence[str], table: Table, titles: Sequence[str]) -> None:
    if len(titles) == table.width:
        return
    place = next((place for place in range(table.first, len(lines)) if lines[place].strip()), table.first)
    shown = "; ".join(split_row(lines[place], table.delimiter))[:_SHOWN] if lines else ""
    few = table.width <= _MOST_NAMED
    example = ",".join(["time [s]", *("uyzabcdefgh"[: table.width - 1] if few else ("u", "y", "..."))])
    how = f'pass columns= (--columns "{example}"){"" if few else f", a name for each of the {table.width}"}'
    # one field above several is a line of text, such as the end of a list of channels
    if len(titles) < min(table.width - 1, 2) or all(is_number(title) for title in titles):
        raise RecordingError(
            f'{path}, line {1 if not titles else place + 1}: expected titles such as "time [s];M_s [N m]" above '
            f"{table.width} columns of numbers, found none; {how}."
        )
    raise RecordingError(
        f"{path}, line {place + 1}: expected {len(titles)} fields, as many as titles, found {table.width} in "
        f'"{shown}"; is a decimal comma taken for a delimiter? Else {how}.'
    )


def _renamed(path: Path, titles: Sequence[str], asked: Sequence[str]) -> list[str]:
    """Return titles with those that the caller calls otherwise.

    Raises RecordingError if the file has no such title.
    """
    new = list(titles)
    for pair in asked:
        old, _, name = (part.strip() for part in pair.rpartition("="))
        place = next((at for at, title in enumerate(titles) if old in (title, name_and_unit(title)[0])), None)
        if place is None:
            raise RecordingError(
                f'{path}: expected a column "{old}", as the hint columns says, found {"; ".join(titles)[:200]}.'
            )
        new[place] = name
    return new


def _chosen(table: Table, names: Sequence[str], times: TimeColumns) -> tuple[list[int], dict[str, str]]:
    """Return the columns that are read, and why others are not."""
    kept: list[int] = []
    left_out: dict[str, str] = {}
    numbers = [
        place for place, kind in enumerate(table.kinds) if kind == NUMBER and place not in (times.place, *times.stamps)
    ]
    columns = [[row[place] for row in table.rows] for place in range(table.width)]
    counters = [place for place in numbers if _is_counter(place, names[place], columns[place])]
    # what counts is a channel where nothing else is one
    counters = counters if len(counters) < len(numbers) else [place for place in counters if not names[place]]
    for place, kind in enumerate(table.kinds):
        name = names[place]
        shown = name or f"column {place + 1}, which has no title"
        if place == times.place or place in dict(times.more):
            kept.append(place)
        elif place in times.stamps or (times.fraction or (-1,))[0] == place or (not name and kind == GAP):
            continue
        elif place in counters:
            left_out[shown] = "it counts the rows"
        elif times.other_dates is not None and place > times.other_dates and kind == NUMBER:
            left_out[shown] = (
                f"it has dates of its own in front, in column {times.other_dates + 1}; save it in a file of its own"
            )
        elif name and kind in (NUMBER, GAP):
            kept.append(place)
        elif kind == TEXT:
            word = next((field for field in columns[place] if field and not is_number(field)), "")
            left_out[shown] = f'it holds {_kind_of_text(word)}, such as "{printable(word)[:30]}"'
        elif kind in (DATE, DAY_TIME):
            left_out[shown] = "it holds dates or times of day beside the times of the rows"
        else:
            left_out[shown] = "name it with columns= (--columns)"
    return kept, left_out


def _kind_of_text(word: str) -> str:
    """Return what a field that is no number is: arrays come as numbers with blanks between, as of FMPy."""
    parts = word.strip("[]()").split()
    is_array = len(parts) > 1 and all(map(is_number, parts))
    return "several numbers in a field (write each in a column of its own)" if is_array else "text"


def _skipped(table: Table, names: Sequence[str]) -> int:
    """Return how many rows a column that counts them leaves out before the first; it may count from 1."""
    columns = ([row[place] for row in table.rows] for place in range(table.width))
    counters = [fields for place, fields in enumerate(columns) if _is_counter(place, names[place], fields)]
    begin = int(counters[0][0]) if counters else 0
    return begin if begin > 1 else 0


def _is_counter(place: int, name: str, fields: Sequence[str]) -> bool:
    return (name.lower() in _COUNTERS or (place == 0 and name.lower() == "x")) and counts_rows(fields)


def _decimal(path: Path, table: Table, places: Sequence[int]) -> str:
    fields = [row[place] for row in table.rows for place in places if is_number(row[place])]
    sign = decimal_sign(fields)
    if sign is None:
        raise RecordingError(
            f"{path}: expected a decimal point or a decimal comma, found both in the first rows; pass "
            "decimal= (--decimal)."
        )
    return sign


def _expect_other_delimiter(path: Path, table: Table, decimal: str) -> None:
    """Refuse a decimal sign that is the delimiter, unless quotes keep the numbers together."""
    in_quotes = any("," in field for row in table.rows for field in row)
    if decimal == table.delimiter and not in_quotes:
        raise RecordingError(f'{path}: expected decimal sign and delimiter to differ, found "{decimal}" for both.')


def _remarks(path: Path, times: TimeColumns, facts: HeadFacts, *, has_rate: bool) -> tuple[str, ...]:
    if times.remark:
        return (f"{times.remark}.",)
    if times.place is None and facts.rate_hz is not None and not has_rate:
        return (f'The rate of {facts.rate_hz:g} Hz is that of "{facts.source}" above the rows.',)
    return ()
