"""Text files of one column, or of titles without a row."""

import re
from collections.abc import Sequence
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers.csv._fields import NUMBER, split_row
from shaftprint.recording.readers.csv._table import Table, find_table
from shaftprint.recording.readers.csv._time_titles import is_time_title

_SHOWN = 80
# a value as it is shown: 25.5 kN m
_WITH_UNIT = re.compile(r"[+-]?\d+([.,]\d+)? ?[A-Za-z°%µ][^\d]*")


def lone_table(path: Path, lines: Sequence[str], delimiter: str | None, width: int, *, has_rate: bool) -> Table:
    """Return the table of one column, of times or of values at a stated rate, or of titles without a row.

    Raises RecordingError if the file is neither.
    """
    table = find_table(lines, width=1, delimiter=delimiter or ";")
    title = lines[table.first - 1].strip() if table is not None and table.first > 0 else ""
    if table is not None and title and (has_rate or is_time_title(_plain_title(title))):
        return table
    if table is not None and not width:
        named = f' "{printable(title)[:_SHOWN]}"' if title else ""
        raise RecordingError(
            f"{path}: expected a column of times, found one column of numbers{named or ' without a title'} alone; pass "
            f"its rate{'' if title else ' and name'}, sample_rate_hz= (--sample-rate 1000"
            f"{'' if title else ' --columns u'})."
        )
    if width:
        raise RecordingError(f"{path}: expected a row of {width} columns, as the hint columns says, found none.")
    titles = next((line for line in lines if line.strip()), "")
    marks = [mark for mark in (";", "\t", ",") if mark in titles]
    if len(marks) != 1 and delimiter is None:
        if is_time_title(_plain_title(titles)):
            return Table(delimiter=";", first=1, width=1, kinds=NUMBER, rows=())
        what = "several of them" if marks else "none of them"
        raise RecordingError(
            f"{path}, line 1: expected columns separated by semicolon, tab, comma or white space, with rows of "
            f'numbers, found {what} in "{printable(titles.strip())[:_SHOWN]}"; pass delimiter= (--delimiter).'
        )
    mark = delimiter or marks[0]
    count = len(split_row(titles, mark))
    with_unit = next((field for line in lines for field in split_row(line, mark) if _WITH_UNIT.fullmatch(field)), None)
    if with_unit is not None:
        raise RecordingError(
            f'{path}: expected numbers, found "{printable(with_unit)[:_SHOWN]}"; write the values without their units, '
            "which may change from row to row (Grafana: switch off Formatted data)."
        )
    return Table(
        delimiter=mark, first=lines.index(titles) + 1 if titles else 0, width=count, kinds=NUMBER * count, rows=()
    )


def _plain_title(line: str) -> str:
    return line.lstrip("\ufeff").lstrip("#%").strip().strip('"')
