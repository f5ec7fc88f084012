"""Files of older oscilloscopes of Tektronix: one channel each, with the head beside its first rows, not above them."""

from collections.abc import Sequence
from dataclasses import dataclass

from shaftprint.recording.readers.csv._fields import is_number, split_row
from shaftprint.recording.readers.csv._head_facts import plain_key
from shaftprint.units import plain_unit

_DELIMITER, _FIRST_KEY, _LINES = ",", "record length", 30
# key, value and its unit; then time and value of the row
_OF_HEAD = 3


@dataclass(frozen=True, kw_only=True, slots=True)
class HeadBeside:
    """The head of such a file."""

    rows: list[str]
    """The lines without it."""
    names: tuple[str, ...]
    """Titles of the columns, those of the head empty."""
    units: tuple[str, ...]
    """Their units."""


def head_beside(lines: Sequence[str]) -> HeadBeside | None:
    """Return the head that stands in the first columns of the first rows of a file; nothing of other files."""
    fields = [split_row(line, _DELIMITER) for line in lines[:_LINES]]
    if not fields or plain_key(fields[0][0]) != _FIRST_KEY or not all(map(is_number, _of_row(fields[0]) or [""])):
        return None
    said = {plain_key(row[0]): row[1] for row in fields if len(row) > 1 and row[0]}
    name, unit = said.get("source") or "CH1", said.get("vertical units", "")
    return HeadBeside(
        rows=[_OF_HEAD * _DELIMITER + _DELIMITER.join(_of_row(split_row(line, _DELIMITER))) for line in lines],
        names=(*_OF_HEAD * ("",), "time", name),
        units=(*_OF_HEAD * ("",), said.get("horizontal units") or "s", plain_unit(unit)),
    )


def _of_row(fields: Sequence[str]) -> list[str]:
    """Return time and value of a row."""
    return list(fields[_OF_HEAD : _OF_HEAD + 2])
