"""Tables that are no columns of signals: rows of one value each, rows of frames of a CAN bus, two tables in one."""

import re
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.recording.readers.csv._fields import DATE, DAY_TIME, GAP, NUMBER, TEXT, kinds_of, split_row
from shaftprint.recording.readers.csv._table import Table

# Words in the title of a column that says of which signal a row is, and of the values; fused ones are taken apart.
_SIGNALS = frozenset(
    {
        "tag", "signal", "channel", "variable", "var", "sensor", "parameter", "param", "point", "item", "field", "pid",
        "measurement", "metric", "series", "entity", "node", "quantity", "name", "attribute", "register", "topic",
        "key", "path", "spn", "pgn", "messstelle", "kanal", "signalname", "variablenname",
    }
)  # fmt: skip
_VALUES = frozenset({"value", "val", "wert", "messwert", "state", "reading", "valeur", "valor", "waarde"})
# what such a column says else
_OTHERWISE = frozenset({"status", "quality", "alarm", "mode", "unit", "units", "type", "code", "count", "source"})
_ID = "id"
# Words in the title of a column that says of which ship, engine or logger the whole row is; its numbers change in turn.
_SENDERS = frozenset(
    {
        "mmsi", "imo", "ship", "vessel", "schiff", "device", "logger", "asset", "machine", "engine", "motor", "shaft",
        "drive", "instance", "unit", "side", "station", "host", "sender",
    }
)  # fmt: skip
_NUMBERED = frozenset({_ID, "no", "nr", "number", "name"})
_MOST_SENDERS, _IN_TURN = 8, 0.25
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-zäöüß]+")
_FUSED = re.compile(r"(tag|var|signal|channel|sensor|node|point|item|entity|messstellen)(name|id|value|val|wert)")
# titles of the bytes of a frame: D0, Data1, Byte 0
_BYTES = re.compile(r"(?<![A-Za-z])(data|d|b|byte)[ _]?[01](?!\d)", re.IGNORECASE)
_HEAD, _SHOWN, _MOST = 30, 80, 0.9
# Beside the values rows of one signal each have times, codes, places at most; more are signals in columns.
_MOST_NUMBERS = 8
_BESIDE_VALUES = (
    (
        re.compile(r"\b[A-Za-z_]+\s?[:=]\s?[+-]?\d"),
        2,
        "names in front of them",
        "print the values alone, or take the names out, sed -E 's/[A-Za-z_. ]+[:=] ?//g', and name the columns with "
        "columns= (--columns).",
    ),
    (
        re.compile(r"\d\d:\d\d:\d\d\.\d{3} -> "),
        1,
        "the times of a serial monitor",
        "make columns of them, sed 's/ -> /,/', and name these with columns= (--columns).",
    ),
    (
        re.compile(r"(?:^|[;,\t])\d[\d., ]* ?(?:ns|us|µs|ms|s)(?=[;,\t])"),
        1,
        "times with a unit in each row",
        "write them in one unit, without it, under the title time [s].",
    ),
)
"""How lines show names beside values, how often in each, what that is, and what to do."""
_ALONE = re.compile(r"(?:^|[;,\t])[+-]?\d+(?:\.\d+)?(?=[;,\t]|$)")
# Fewer rows of numbers may stand in a head.
_ROWS = 4


def expect_a_column_a_signal(path: Path, table: Table, names: Sequence[str]) -> None:
    """Refuse rows that each hold one value of one signal, which stand in turn.

    Raises RecordingError if a column says of which signal the values of another are.
    """
    words = [_words(name) for name in names]
    values = [place for place, of_name in enumerate(words) if of_name & _VALUES and not of_name & _OTHERWISE]
    if len(values) != 1 or table.kinds[values[0]] != NUMBER or table.kinds.count(NUMBER) > _MOST_NUMBERS:
        return
    for place, of_name in enumerate(words):
        may_be = of_name & _SIGNALS and not of_name & _OTHERWISE and place != values[0]
        # a number is a name only where the title says so: TagId
        if not may_be or (table.kinds[place] != TEXT and not (table.kinds[place] == NUMBER and _ID in of_name)):
            continue
        signals = list(dict.fromkeys(row[place] for row in table.rows if row[place]))
        if 1 < len(signals) <= max(len(table.rows) // 2, 2):
            raise RecordingError(
                f"{path}, column {names[place]}: expected a column for each signal, found the values of "
                f'{printable(", ".join(signals))[:_SHOWN]} in turn in one, "{names[values[0]]}"; write a column for '
                f'each, in pandas: table.pivot_table(index=TIME, columns="{names[place]}", '
                f'values="{names[values[0]]}").to_csv(...).'
            )


def expect_plain_values(path: Path, lines: Sequence[str]) -> None:
    """Refuse rows with names in front of the values, or with the arrow of a serial monitor.

    Raises RecordingError if nearly all lines are such.
    """
    filled = [line for line in lines if line.strip()]
    for pattern, fewest, found, remedy in _BESIDE_VALUES:
        hits = [len(pattern.findall(line)) for line in filled]
        # columns of words, as "A:0/B:0 %", may stand among more of numbers
        shown = sum(
            hit >= fewest and (hit >= len(_ALONE.findall(line)) or fewest == 1)
            for hit, line in zip(hits, filled, strict=True)
        )
        if len(filled) > _ROWS and shown >= _MOST * len(filled):
            raise RecordingError(
                f"{path}: expected values alone below one row of titles, found {found}, "
                f'"{printable(filled[-2])[:30]}"; {remedy}'
            )


def expect_rows_of_one(path: Path, table: Table, names: Sequence[str]) -> None:
    """Refuse rows of several ships or engines in turn, which would be one channel.

    Raises RecordingError if a column says of which a row is.
    """
    for place, name in enumerate(names):
        words = _words(name)
        fields = [row[place] for row in table.rows if row[place]]
        several = list(dict.fromkeys(fields))
        if (
            table.kinds[place] not in (TEXT, NUMBER)
            or not words & _SENDERS
            or words - _SENDERS - _NUMBERED
            or len(several) < 2
        ):
            continue
        changes = sum(one != other for one, other in pairwise(fields))
        is_id = bool(words & {"mmsi", "imo", _ID})
        if not is_id and (len(several) > _MOST_SENDERS or changes < _IN_TURN * len(fields)):
            continue
        if table.kinds[place] == NUMBER and not all(field.isdecimal() for field in several):
            continue
        raise RecordingError(
            f"{path}, column {name}: expected the rows of one, found those of "
            f"{printable(', '.join(several))[:_SHOWN]} in turn; write a file for each, in pandas: "
            f'for one, rows in table.groupby("{name}"): rows.to_csv(f"{{one}}.csv").'
        )


def expect_one_table(path: Path, lines: Sequence[str], table: Table) -> None:
    """Refuse a file whose first rows are not of the table that has the most.

    Raises RecordingError if rows of numbers stand above the titles.
    """
    above = [
        number
        for number, line in enumerate(lines[: table.first], start=1)
        if line.strip() and _is_row(kinds_of(split_row(line, table.delimiter)))
    ]
    if len(above) >= _ROWS:
        raise RecordingError(
            f"{path}, line {above[0]}: expected one table, found {len(above)} rows of another above line "
            f"{table.first + 1}, from which on most rows are; save each in a file of its own."
        )


def _is_row(kinds: str) -> bool:
    return len(kinds) > 1 and NUMBER in kinds and not set(kinds) - {NUMBER, DATE, DAY_TIME, GAP}


def expect_no_frames(path: Path, lines: Sequence[str]) -> None:
    """Refuse rows of frames of a bus, whose bytes are no values.

    Raises RecordingError if titles name identifier, length and bytes.
    """
    for line in lines[:_HEAD]:
        words = {word.replace("databytes", "data") for word in re.findall(r"[a-z]+", line.lower())}
        has_length = "dlc" in words or (words & {"len", "length"} and _BYTES.search(line) is not None)
        has_length = has_length or words == {"timestamp", "type", "id", "data"}
        if words & {"id", "identifier"} and has_length and (_BYTES.search(line) is not None or "data" in words):
            raise RecordingError(
                f"{path}: expected columns of values, found the frames of a CAN bus; make a log of them as ASC, BLF or "
                "TRC in the program that wrote them (python-can: can_logconvert FILE log.blf), and give that with its "
                "DBC file (--dbc)."
            )


def _words(title: str) -> frozenset[str]:
    apart = _FUSED.sub(r"\1 \2", " ".join(_WORD.findall(title)).lower())
    return frozenset(apart.split()) | {word.removesuffix("s") for word in apart.split()}
