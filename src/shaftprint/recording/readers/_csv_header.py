"""The first line of a CSV file: what separates the columns, what they are called and in which unit."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from shaftprint.errors import RecordingError

TIME = "time"

_DELIMITERS = (";", "\t", ",")
_COLUMN = re.compile(r"(?P<name>.*\S)\s*\[(?P<unit>[^\]]*)\]")


@dataclass(frozen=True, kw_only=True, slots=True)
class Header:
    """How the lines of a CSV file are to be read."""

    delimiter: str
    """What stands between two columns."""
    decimal: str
    """Decimal point or comma."""
    names: tuple[str, ...]
    """Name of each column."""
    units: tuple[str, ...]
    """Unit of each column."""

    @property
    def time_column(self) -> int:
        """Which column holds the times."""
        return self.names.index(TIME)


def read_header(path: Path, line: str, rows: Sequence[str], *, delimiter: str | None, decimal: str | None) -> Header:
    """Understand the header line ``time [s];M_s [V];...`` with the first rows below it.

    Parameters
    ----------
    path
        The file, for messages.
    line
        Its first line.
    rows
        The next lines, from which a decimal comma is told.
    delimiter, decimal
        What the caller knows; found in the lines if absent.

    Raises
    ------
    RecordingError
        If a column has no unit, a name comes twice, there is no time in seconds, or delimiter or
        decimal sign could be read in two ways.
    """
    delimiter = delimiter or _delimiter(path, line)
    names, units = [], []
    for title in line.strip().split(delimiter):
        match = _COLUMN.fullmatch(title.strip().strip('"'))
        if match is None:
            raise RecordingError(f'{path}, line 1: expected titles like "M_s [V]", found "{title.strip()[:80]}".')
        names.append(match["name"].strip())
        units.append(match["unit"].strip())
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise RecordingError(f"{path}, line 1: expected different names, found {', '.join(twice)} twice.")
    if TIME not in names or units[names.index(TIME)] != "s":
        raise RecordingError(f'{path}, line 1: expected a column "time [s]", found "{line.strip()[:80]}".')
    if len(names) == 1:
        raise RecordingError(f"{path}, line 1: expected a channel beside the time, found none.")
    decimal = decimal or _decimal(path, rows, delimiter)
    if decimal == delimiter:
        raise RecordingError(f'{path}: expected decimal sign and delimiter to differ, found "{decimal}" for both.')
    return Header(delimiter=delimiter, decimal=decimal, names=tuple(names), units=tuple(units))


def _delimiter(path: Path, line: str) -> str:
    found = [candidate for candidate in _DELIMITERS if candidate in line]
    if len(found) != 1:
        what = "several of them" if found else "none of them"
        raise RecordingError(
            f"{path}, line 1: expected columns separated by semicolon, tab or comma, found {what} in "
            f'"{line.strip()[:80]}"; pass delimiter=.'
        )
    return found[0]


def _decimal(path: Path, rows: Sequence[str], delimiter: str) -> str:
    if delimiter == ",":
        return "."
    commas = any("," in row for row in rows)
    points = any("." in row for row in rows)
    if commas and points:
        raise RecordingError(
            f"{path}: expected a decimal point or a decimal comma, found both in the first rows; pass decimal=."
        )
    return "," if commas else "."
