"""What is wrong with rows of a text file that are no rows of numbers."""

from collections.abc import Sequence
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording.readers.csv._fields import number
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._stamps import is_stamp

# So many mistakes of a file are told, and so many letters of each.
MOST = 5
LONGEST = 80


def wrong_rows(path: Path, rows: Sequence[tuple[int, Sequence[str]]], header: Header) -> RecordingError:
    """Return the error that tells the first mistakes of some rows, each with its line and column.

    ``path``: the file. ``rows``: number and fields of each line. ``header``: what stands in which column.
    """
    mistakes = [sentence for line, fields in rows for sentence in _mistakes(line, fields, header)]
    if len(mistakes) == 1:
        return RecordingError(f"{path}, {mistakes[0]}")
    more = [f"and {len(mistakes) - MOST} more."] if len(mistakes) > MOST else []
    count = f"{len(mistakes)} fields or rows cannot be used."
    begins = min((line for line, fields in rows if _has_words_alone(fields, header)), default=None)
    if begins is not None:
        more.append(
            f"Line {begins} has words alone, as titles: if another table begins there, as of another rate, write each "
            "table into a file of its own."
        )
    return RecordingError("\n  ".join([f"{path}: {count}", *mistakes[:MOST], *more]))


def _has_words_alone(fields: Sequence[str], header: Header) -> bool:
    filled = [header.pointed(field) for field in fields if field.strip()]
    return len(filled) > 1 and all(number(field) is None and not is_stamp(field) for field in filled)


def _mistakes(line: int, fields: Sequence[str], header: Header) -> list[str]:
    if len(fields) != header.width:
        shown = "; ".join(fields)[:LONGEST]
        return [
            f'line {line}: expected {header.width} fields, as many as titles, found {len(fields)} in "{shown}"; is the '
            "file damaged there, or a decimal comma taken for a delimiter?"
        ]
    mistakes = []
    for column, (name, place) in enumerate(zip(header.names, header.places, strict=True)):
        field = header.pointed(fields[place])
        if is_stamp(field) if place in header.stamps else number(field) is not None:
            continue
        expected = "seconds or a date such as 2026-11-22 10:00:00" if column == header.time_column else "a number"
        where = f"line {line}, column {place + 1} ({name})"
        mistakes.append(f'{where}: expected {expected}, found "{field[:LONGEST]}".')
    return mistakes
