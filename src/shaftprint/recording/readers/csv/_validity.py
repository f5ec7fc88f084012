"""Columns that say whether values count, as historians and OPC clients write them: Status, Quality, Validity."""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.escape import printable
from shaftprint.recording._channel import Source
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._gather import names_in_words
from shaftprint.recording.readers.csv._fields import GAP, NUMBER, TEXT, split_row
from shaftprint.recording.readers.csv._table import Table

_TITLE = re.compile(
    r"(?:.*[\s._|-])?(?:status|quality|validity|qualität|gültigkeit)(?: \(\d+\))?", re.IGNORECASE | re.DOTALL
)
_BAD = re.compile(
    r"(?:not ?good|bad|invalid|ungültig|schlecht|comm(unication)? fail\w*|i/o timeout|no ?data)\b.*", re.IGNORECASE
)
# a number that is called a status may be one of the plant
_NUMBERED = re.compile(r".*(?:quality|validity|qualität|gültigkeit).*", re.IGNORECASE | re.DOTALL)
# Of OPC two bits say bad (0), uncertain (64) or good (192); of WinCC 1 stands for valid.
_GOOD_OF_OPC, _BAD_OF_OPC, _BYTE, _VALID = 192.0, 64.0, 256.0, 1.0
_BLOCK, _SHOWN = 1 << 20, 3

Status = tuple[int, tuple[str, ...]]
"""Column of a file that says it, and the names of the channels of which it does."""


def status_columns(table: Table, names: Sequence[str], channels: Collection[int]) -> tuple[Status, ...]:
    """Return the columns that say whether values count, with the names of those values.

    One alone, behind the others or in front of them, says it of all; one behind a value of that. ``names``: of all
    columns. ``channels``: those that are read, without times.
    """
    places = [
        place
        for place, name in enumerate(names)
        if _TITLE.fullmatch(name) is not None
        and (table.kinds[place] == TEXT or (table.kinds[place] == NUMBER and _NUMBERED.fullmatch(name) is not None))
    ]
    values = [place for place in channels if place not in places and table.kinds[place] in (NUMBER, GAP)]
    if len(places) == 1 and values and not min(values) < places[0] < max(values):
        return ((places[0], tuple(names[place] for place in values)),)
    behind = ((place, place - 1) for place in places)
    return tuple((place, (names[before],)) for place, before in behind if before in values)


def invalid_rows(
    lines: Iterable[str],
    delimiter: str,
    status: Sequence[Status],
    read: Mapping[str, int],
    names: Sequence[str],
    spool: Spool,
    count: int,
    left_out: dict[str, str],
) -> dict[str, IntArray]:
    """Return the rows in which a value does not count, by the name of its channel, and name how many there are.

    ``lines``: the rows of the file, which are read only where a status is a word. ``names``: of
    all columns. ``read``: number in the spool of each column that is in it. ``count``: number of rows. ``left_out``:
    takes what is said.
    """
    words = {place for place, _ in status if names[place] not in read}
    told = _words(lines, delimiter, words) if words else {}
    invalid: dict[str, IntArray] = {}
    for place, of in status:
        number = read.get(names[place])
        if number is None:
            said = told[place]
            rows = np.array([row for row, word in enumerate(said) if _BAD.fullmatch(word)], dtype=np.int64)
            known = len(said) == count
            shown = [word for word, _ in Counter(said[row] for row in rows.tolist()).most_common(_SHOWN)]
        else:
            rows, shown = _bad_numbers(spool.source(number), count)
            known = True
        for name in of if rows.size else ():
            says = f"column {names[place]} says {names_in_words([printable(word)[:30] for word in shown])}"
            if known:
                invalid[name] = rows
                left_out[f"values of {name}"] = f"{rows.size} of {count} values are none: {says}"
            else:
                left_out[f"validity of {name}"] = f"{says} in {rows.size} rows, and rows were left out: values stay"
    return invalid


def without(read: Source, rows: IntArray | None) -> Source:
    """Return what gives a column with no value in some rows."""
    if rows is None:
        return read
    chosen = rows

    def masked(start: int, stop: int) -> FloatArray:
        values = np.array(read(start, stop), dtype=np.float64)
        first, last = np.searchsorted(chosen, (start, stop))
        values[chosen[first:last] - start] = np.nan
        return values

    return masked


def _words(lines: Iterable[str], delimiter: str, places: Collection[int]) -> dict[int, list[str]]:
    """Return the word of each row in some columns."""
    told: dict[int, list[str]] = {place: [] for place in places}
    for line in lines:
        if not line.strip():
            continue
        fields = split_row(line, delimiter)
        for place, said in told.items():
            said.append(fields[place] if place < len(fields) else "")
    return told


def _bad_numbers(read: Source, count: int) -> tuple[IntArray, list[str]]:
    """Return the rows with numbers that say bad, and these numbers; none where they are no status of OPC or WinCC."""
    blocks = [np.asarray(read(at, min(at + _BLOCK, count)), dtype=np.float64) for at in range(0, count, _BLOCK)]
    numbers = np.concatenate(blocks)
    counted = Counter(numbers[np.isfinite(numbers)].tolist())
    if not counted or any(not number.is_integer() or not 0.0 <= number < _BYTE for number in counted):
        return np.empty(0, dtype=np.int64), []
    usual = counted.most_common(1)[0][0]
    if usual >= _GOOD_OF_OPC:
        bad = numbers < _BAD_OF_OPC
    elif usual == _VALID and set(counted) <= {0.0, _VALID}:
        bad = numbers == 0.0
    else:
        bad = np.zeros(numbers.size, dtype=bool)
    return np.flatnonzero(bad), [f"{number:g}" for number in sorted(set(numbers[bad].tolist()))[:_SHOWN]]
