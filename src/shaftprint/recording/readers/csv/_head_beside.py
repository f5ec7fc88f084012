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
    """Return the head that stands in the first columns of the first rows of a file; nothing of other files.

    A row of letters above it, as of a spreadsheet, is passed over; of several channels each has its head beside it.
    """
    fields = [split_row(line, _DELIMITER) for line in lines[:_LINES]]
    first = next((row for row in fields[:2] if _FIRST_KEY in map(plain_key, row)), [])
    begins = [place for place, field in enumerate(first) if plain_key(field) == _FIRST_KEY]
    if not begins or begins[0] != 0 or not all(map(is_number, _of_rows(first, begins) or [""])):
        return None
    width = begins[-1] + _OF_HEAD + 2
    names, units = [""] * width, [""] * width
    for number, begin in enumerate(begins, start=1):
        said = {plain_key(row[begin]): row[begin + 1] for row in fields if len(row) > begin + 1 and row[begin]}
        unit = plain_unit(said.get("vertical units", ""))
        names[begin + _OF_HEAD] = "time"
        names[begin + _OF_HEAD + 1] = said.get("source") or f"CH{number}"
        units[begin + _OF_HEAD] = said.get("horizontal units") or "s"
        units[begin + _OF_HEAD + 1] = unit
    return HeadBeside(
        rows=[_without_head(split_row(line, _DELIMITER), begins, width) for line in lines],
        names=tuple(names),
        units=tuple(units),
    )


def _without_head(fields: Sequence[str], begins: Sequence[int], width: int) -> str:
    """Return a row with times and values alone at their places."""
    row = [""] * width
    for begin in begins:
        place = begin + _OF_HEAD
        row[place : place + 2] = [*fields[place : place + 2], "", ""][:2]
    return _DELIMITER.join(row)


def _of_rows(fields: Sequence[str], begins: Sequence[int]) -> list[str]:
    """Return times and values of a row."""
    return [field for begin in begins for field in fields[begin + _OF_HEAD : begin + _OF_HEAD + 2]]
