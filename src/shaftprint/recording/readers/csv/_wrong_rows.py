"""What is wrong with rows of a text file that are no rows of numbers."""

from collections.abc import Sequence
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording.readers.csv._dates import is_date

# So many mistakes of a file are told, and so many letters of each.
MOST = 5
LONGEST = 80


def wrong_rows(
    path: Path, rows: Sequence[tuple[int, Sequence[str]]], names: Sequence[str], *, time: int | None = None
) -> RecordingError:
    """Return the error that tells the first mistakes of some rows, each with its line and column.

    Parameters
    ----------
    path
        The file.
    rows
        Number and fields of each line.
    names
        Titles of the columns.
    time
        Column of the times, which may be dates; None where there is none.
    """
    mistakes = [sentence for line, fields in rows for sentence in _mistakes(line, fields, names, time)]
    if len(mistakes) == 1:
        return RecordingError(f"{path}, {mistakes[0]}")
    more = [f"and {len(mistakes) - MOST} more."] if len(mistakes) > MOST else []
    count = f"{len(mistakes)} fields or rows cannot be used."
    return RecordingError("\n  ".join([f"{path}: {count}", *mistakes[:MOST], *more]))


def _mistakes(line: int, fields: Sequence[str], names: Sequence[str], time: int | None) -> list[str]:
    if len(fields) != len(names):
        shown = "; ".join(fields)[:LONGEST]
        return [
            f'line {line}: expected {len(names)} fields, as many as titles, found {len(fields)} in "{shown}"; is the '
            "file cut off there, or a decimal comma taken for a delimiter?"
        ]
    mistakes = []
    for column, field in enumerate(fields):
        if is_number(field) or (column == time and is_date(field)):
            continue
        expected = "seconds or a date such as 2026-11-22 10:00:00" if column == time else "a number"
        where = f"line {line}, column {column + 1} ({names[column]})"
        mistakes.append(f'{where}: expected {expected}, found "{field.strip()[:LONGEST]}".')
    return mistakes


def is_number(field: str) -> bool:
    """Return whether a field can be read as a number; an empty one is a gap."""
    try:
        float(field.strip() or "nan")
    except ValueError:
        return False
    return True
