"""Titles of the columns of a text file: the line they stand in, the units in it or below it, one name a column."""

import re
from collections.abc import Sequence
from itertools import takewhile

from shaftprint.escape import csv_cell_text, printable
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._fields import DATE, DAY_TIME, GAP, WHITE_SPACE, is_number, split_row
from shaftprint.recording.readers.csv._head_facts import is_fact, plain_key
from shaftprint.recording.readers.csv._scope_export import titles_of_export
from shaftprint.recording.readers.csv._table import Table
from shaftprint.recording.readers.csv._time_titles import IN_BRACKETS, begins_as_time, is_time_title
from shaftprint.units import plain_unit

# a title with its unit behind it, where white space stands between columns
_SPACED_TITLE = re.compile(r"\S+(?:\s*[\[(][^\])]*[\])])?")
# what stands alone above the rows: [data]
_SECTION = re.compile(r"\[[A-Za-z][A-Za-z ]{2,}\]")
# the unit behind the channel of an oscilloscope: CH1V
_OF_A_SCOPE = re.compile(r"(?P<name>CH\d+)(?P<unit>V|A)")
_BEHIND_A_WORD = re.compile(r"(?P<name>.*?)\s*(?:\bin\b|/|,)\s*(?P<unit>\S+(?: m)?)")
# What stands in brackets behind a variable of a co-simulation: its number, its type and what it is.
_OF_A_VARIABLE = re.compile(
    r"(\d+\s+)?(real|integer|boolean|string|enumeration|u?int(eger)?\d*|float\d*|double|bool)(\s+\w+)*", re.IGNORECASE
)
_UNITS = frozenset(
    {
        "V", "mV", "kV", "uV", "µV", "mA", "kA", "N", "kN", "Nm", "N·m", "kNm", "N m", "kN m", "mm", "cm", "um", "µm",
        "m/s", "m/s^2", "m/s²", "m/s2", "mm/s", "Hz", "kHz", "rpm", "rad", "deg", "rad/s", "deg/s", "rev", "rev/s",
        "degC", "°C", "°", "bar", "mbar", "Pa", "kPa", "MPa", "hPa", "kW", "MW", "VA", "var", "%", "s", "ms", "us",
        "ns", "min", "kn", "L/h", "kg", "kJ", "Ohm", "ohm", "kOhm", "dB", "um/m", "µm/m", "mV/V", "counts", "-", "#",
        "km/h", "kph", "mph", "/min", "kg/h", "kg/s", "g/s", "mg/s", "g/h", "g/kWh", "g/l", "l/min", "m3/h", "m³/h",
        "ppm", "psi", "inHg", "mmHg", "°F", "degF", "ft", "lb", "lbf", "lb-ft", "ft-lb", "lbft", "hp", "kWh",
    }
)  # fmt: skip
_LETTER_UNITS = frozenset({"m", "g", "C", "t", "h", "A", "K", "W", "J"})
_TIME_FORMATS = re.compile(r"[hHmMsSydDYtT:./ _-]+|ts|abs|rel|date|time", re.IGNORECASE)
_HIGHEST = 12
# Lines of a head that hold titles and units without standing above their columns (Yokogawa, Hioki, LabChart).
_NAMES = (
    "tag", "tracename", "trace name", "signal", "channeltitle", "channel title", "channel titles", "channel names",
)  # fmt: skip
_UNIT_ROWS = ("vunit", "v unit", "unit", "units", "vert units", "vertical units", "unitname", "channel units")
# what stands in brackets is no unit, but says what something is
_REMARK = ": "
_REMARKS = ("comment", "comments", "remark", "remarks")
_SCOPE_UNITS = "vertical units"
_LIST, _SIDE_BY_SIDE = "[header]", "[column names]"
# what Graphtec writes below a number of rows and below alarms: NO., A1234567890
_LABELS = re.compile(r"No\.|[A-Z]{1,2}12\d+", re.IGNORECASE)
_TOA5, _TOA5_ROWS = ("TOA5", "TOB1"), 4


def titles_and_units(lines: Sequence[str], table: Table) -> tuple[list[str], list[str]]:
    """Return the titles above a table, one a column, and their units where those stand in a row of their own.

    Both are empty where there are none.
    """
    above = [line for line in lines[: table.first] if line.strip() and _SECTION.fullmatch(line.strip()) is None]
    if above and split_row(above[0].lstrip("\ufeff"), table.delimiter)[0] in _TOA5 and len(above) >= _TOA5_ROWS:
        return _padded(_fields(above[1], table), table), [
            _unit(field) for field in _padded(_fields(above[2], table), table)
        ]
    listed = _listed(lines[: table.first], table)
    if listed is not None:
        return listed
    export = titles_of_export(above, table)
    if export is not None:
        return export
    named = _named_rows(above, table)
    if named is not None:
        return named
    rows = []
    for line in reversed(above[-_HIGHEST:]):
        fields = _as_wide(_fields(line, table), table)
        if fields is None:
            break
        rows.append(fields)
    if not rows:
        return [_fields(above[-1], table), []] if above else [[], []]  # type: ignore[return-value]
    place = _place_of_titles(rows)
    # words may stand between titles and units
    units = next((row for row in reversed(rows[:place]) if _are_units(row, rows[place])), _of_scope(above, table))
    has_units = any(row is units for row in rows[:place])
    between = [row for row in rows[1 : place if has_units else 1] if row is not units]
    if len(between) == 1 and _are_names(between[0], rows[place]):
        return _joined(rows[place], between[0]), [_unit(field) for field in units]
    return _with_words(rows[place], [row for row in rows[:place] if row is not units]), [
        _unit(field) for field in units
    ]


def _are_names(row: Sequence[str], titles: Sequence[str]) -> bool:
    """Return whether a row between titles and units says what each channel is: its place above, its quantity below."""
    words = [word for word, title in zip(row, titles, strict=True) if title and word and not is_time_title(title)]
    channels = sum(bool(title) and not is_time_title(title) for title in titles)
    is_word = all(len(word) > 1 and not is_number(word) for word in words)
    return is_word and len(words) > 1 and len(set(words)) == len(words) >= channels - 1


def _joined(titles: Sequence[str], words: Sequence[str]) -> list[str]:
    return [
        title if is_time_title(title) else f"{title} {word}".strip() for title, word in zip(titles, words, strict=True)
    ]


def _listed(lines: Sequence[str], table: Table) -> tuple[list[str], list[str]] | None:
    """Return the names that a log of Racelogic's lists one a line, where those side by side have blanks within."""
    rows = [line.strip().lstrip("\ufeff") for line in lines]
    if table.delimiter != WHITE_SPACE or _LIST not in rows or _SIDE_BY_SIDE not in rows:
        return None
    beside = next((row for row in rows[rows.index(_SIDE_BY_SIDE) + 1 :] if row), "")
    names = list(takewhile(bool, rows[rows.index(_LIST) + 1 :]))
    return None if len(beside.split()) == table.width or len(names) != table.width else (names, [""] * len(names))


def _of_scope(above: Sequence[str], table: Table) -> list[str]:
    """Return the units that Tektronix' oscilloscopes state far above the titles; none of other files."""
    rows = (_fields(line, table) for line in above)
    row = next((row for row in rows if plain_key(row[0] if row else "") == _SCOPE_UNITS), [])
    return ["", *row[1:]] if len(row) == table.width else []


def _with_words(titles: list[str], below: Sequence[Sequence[str]]) -> list[str]:
    """Return titles, of which several are equal with the words of a row below them: device above, quantity below."""
    for row in below if len(set(titles)) < len(titles) else ():
        joined = _joined(titles, row)
        if len(set(joined)) == len(joined) and not any(map(is_number, row)):
            return joined
    return titles


def of_pairs(titles: list[str], table: Table) -> list[str]:
    """Return titles, of which those above dates belong to the values behind, as historians lay out one tag each."""
    dated = [place for place, kind in enumerate(table.kinds) if kind in (DATE, DAY_TIME)]
    pairs = all(titles[place] and not is_time_title(titles[place]) for place in dated)
    if not dated or not pairs or any("".join([*titles, "-"][place + 1 : place + 2]) for place in dated):
        return titles
    moved = list(titles)
    for place in dated:
        moved[place : place + 2] = ["time", titles[place]]
    return moved


def _named_rows(above: Sequence[str], table: Table) -> tuple[list[str], list[str]] | None:
    """Return titles and units where lines of the head say what they are, as "TraceName","CH1","CH2" does."""
    rows: dict[str, list[str]] = {}
    for line in above:
        key, *fields = _fields(line, table) or [""]
        word, _, first = key.partition("=")
        fields = [one for one in ([first] if first else []) + fields if one]
        rows.setdefault(plain_key(word), fields)
    # a separator may stand in front of the rows, and behind them
    filled = [place for place, kind in enumerate(table.kinds) if kind != GAP]
    names = next((rows[key] for key in _NAMES if len(rows.get(key, [])) >= len(filled) - 1 > 0), None)
    if names is None or len(names) > len(filled):
        return None
    units = next((rows[key] for key in _UNIT_ROWS if len(rows.get(key, [])) == len(names)), [""] * len(names))
    if len(names) < len(filled):
        names, units = ["time", *names], ["s", *units]
    if is_time_title(names[0]):
        units = [units[0].lower(), *units[1:]]
    named = dict(zip(filled, zip(names, units, strict=True), strict=True))
    names, units = ([named.get(place, ("", ""))[which] for place in range(table.width)] for which in (0, 1))
    return names, [_unit(unit) for unit in units]


def _place_of_titles(rows: Sequence[Sequence[str]]) -> int:
    """Return which of the rows above the numbers, the lowest first, holds the titles."""
    timed = next(
        (place for place, row in enumerate(rows) if any(map(is_time_title, row)) or begins_as_time(row[0])), None
    )
    if timed is not None and (timed > 0 or len(rows) == 1 or not _are_units(rows[0], rows[1])):
        return timed
    place = 1 if len(rows) > 1 and _are_units(rows[0], rows[1]) else 0
    # numbers of channels may stand below their names
    return place + (len(rows) > place + 1 and all(map(is_number, rows[place])))


def _are_units(row: Sequence[str], above: Sequence[str]) -> bool:
    """Return whether a row below titles holds their units."""
    time = next((column for column, title in enumerate(above) if is_time_title(title)), 0)
    if time >= len(row) or any(
        is_number(field) and len(field) > 1 and not above[place].strip() for place, field in enumerate(row)
    ):
        return False
    bracketed = [field for field in row if field[:1] in "[(" and field[-1:] in "])"]
    words = [
        field
        for place, field in enumerate(row)
        if field and place != time and not is_number(field) and _LABELS.fullmatch(field) is None
    ]
    units = [field for field in words if field in bracketed or _is_unit(field)]
    of_time = row[time].strip("[]() ")
    is_of_time = seconds_in(of_time) is not None
    if is_of_time and not is_time_title(row[time]):
        return True
    may_be_time = is_of_time or of_time in ("", "-") or _TIME_FORMATS.fullmatch(of_time) is not None
    return (may_be_time or bool(units)) and 2 * len(units) >= len(words) > 0


def _is_unit(text: str) -> bool:
    """Return whether a word is a unit."""
    plain = text.strip("[]() ")
    return plain_unit(plain) != plain or plain in _UNITS or plain in _LETTER_UNITS


def _unit(field: str) -> str:
    plain = field.strip("[]() ")
    return "" if plain == "-" else plain_unit(plain)


def _fields(line: str, table: Table) -> list[str]:
    """Return the titles of a line; with white space between columns those that are as many as the columns."""
    line = line.lstrip("\ufeff").lstrip("#%")
    if table.delimiter != WHITE_SPACE or '"' in line:
        return [csv_cell_text(field) for field in split_row(line, table.delimiter)]
    spaced = [title.strip() for title in _SPACED_TITLE.findall(line)]
    # units in brackets, apart by one space, are no parts of titles
    others = (re.split(r"\s{2,}", line.strip()), line.split())
    return next((fields for fields in (spaced, *others) if len(fields) == table.width), spaced)


def _as_wide(fields: list[str], table: Table) -> list[str] | None:
    """Return fields as many as columns, where they differ by separators at the end, remarks, or a count of the rows."""
    width = table.width
    while len(fields) > width and (not fields[-1] or is_fact(fields[-1])):
        fields = fields[:-1]
    if len(fields) == width + 1 and fields[-1].lower() in _REMARKS:
        fields = fields[:-1]
    if len(fields) < width and not set(table.kinds[len(fields) :]) - {GAP} and len(fields) > 1:
        fields = _padded(fields, table)
    if len(fields) == width - 1 and counts_rows([row[0] for row in table.rows]):
        fields = ["", *fields]
    return fields if len(fields) == width else None


def _padded(fields: list[str], table: Table) -> list[str]:
    return (fields + [""] * table.width)[: table.width]


def counts_rows(fields: Sequence[str]) -> bool:
    """Return whether fields are whole numbers that step by one."""
    numbers = [int(field) if field.isdecimal() else -1 for field in fields]
    return len(numbers) > 1 and numbers[0] >= 0 and numbers == list(range(numbers[0], numbers[0] + len(numbers)))


def told_apart_by_remarks(titles: Sequence[str], names: Sequence[str]) -> list[str]:
    """Return names, of which several are equal with what only one of their titles says in brackets.

    ``titles``, ``names``: of each column, as `name_and_unit` gives the name: of ``Temp, °C (S/N: 1, LBL: 5)`` and
    ``Temp, °C (S/N: 1, LBL: 25)`` come ``Temp (LBL: 5)`` and ``Temp (LBL: 25)``.
    """
    remarks = []
    for title in titles:
        match = IN_BRACKETS.fullmatch(printable(title).strip())
        remarks.append(match["unit"].split(", ") if match is not None and _REMARK in match["unit"] else [])
    told = []
    for name, remark in zip(names, remarks, strict=True):
        alike = [other for other, of_name in zip(remarks, names, strict=True) if of_name == name]
        own = [part for part in remark if not all(part in other for other in alike)]
        told.append(f"{name} ({', '.join(own)})" if own else name)
    return told


def name_and_unit(title: str) -> tuple[str, str]:
    """Return the name and the unit of a title that may hold both."""
    text = printable(title).strip()
    match = IN_BRACKETS.fullmatch(text)
    if match is not None:
        inside = match["unit"].strip()
        if inside.isdecimal():
            # one of several: Y[0]
            return text, ""
        if _REMARK in inside:
            # behind the unit: Temp, °C (LGR S/N: 1)
            return name_and_unit(match["name"])
        return match["name"].strip(), "" if _OF_A_VARIABLE.fullmatch(inside) else plain_unit(inside)
    scope = _OF_A_SCOPE.fullmatch(text)
    if scope is not None:
        return scope["name"], scope["unit"]
    behind = _BEHIND_A_WORD.fullmatch(text)
    if behind is not None and behind["unit"].strip() not in _LETTER_UNITS and _is_unit(behind["unit"]):
        return behind["name"].strip(), plain_unit(behind["unit"])
    return text, ""
