"""Exports of TwinCAT's Scope: rows of the head have their key above each column of times, values above the others."""

import re
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

from shaftprint.recording.readers.csv._fields import split_row
from shaftprint.recording.readers.csv._table import Table
from shaftprint.units import plain_unit

END_OF_EXPORT = "EOF"
"""The last line of an export, behind its rows."""
_NAME, _UNIT = "Name", "Unit"
_START = re.compile(r'"?Starttime of export"?(?P<mark>[;,\t|])"?(?P<ticks>\d{17,19})\b')
# the quantity of a unit: V (Voltage), (None)
_OF_NO_UNIT = re.compile(r"\s*\(.*\)")
# zero of the ticks of 100 ns
_ZERO = datetime(1601, 1, 1, tzinfo=UTC)


def began_of_export(lines: Sequence[str]) -> datetime | None:
    """Return when an export of TwinCAT's Scope begins, by its lines above the rows; nothing of other files."""
    start = _start(lines)
    return None if start is None else _ZERO + timedelta(microseconds=int(start["ticks"]) // 10)


def width_of_export(lines: Sequence[str]) -> int:
    """Return how many columns such an export has; 0 of other files. Its rows get shorter where columns end."""
    start = _start(lines)
    names = [line for line in lines if line.lstrip('"').startswith(_NAME)]
    return 0 if start is None or not names else len(split_row(names[-1], start["mark"]))


def _start(lines: Sequence[str]) -> re.Match[str] | None:
    return next((match for match in map(_START.match, lines) if match is not None), None)


def titles_of_export(lines: Sequence[str], table: Table) -> tuple[list[str], list[str]] | None:
    """Return the titles and units of such an export, times in milliseconds; nothing of other files."""
    if _start(lines) is None:
        return None
    rows = {row[0]: row for row in (split_row(line, table.delimiter)[: table.width] for line in lines) if row}
    names = rows.get(_NAME, [])
    if len(names) != table.width:
        return None
    units = rows.get(_UNIT, [])
    units = units if len(units) == len(names) else [_UNIT] * len(names)
    of_times = [name == _NAME for name in names]
    return ["time" if is_time else name for is_time, name in zip(of_times, names, strict=True)], [
        "ms" if is_time else plain_unit(_OF_NO_UNIT.sub("", unit).removeprefix(_UNIT))
        for is_time, unit in zip(of_times, units, strict=True)
    ]
