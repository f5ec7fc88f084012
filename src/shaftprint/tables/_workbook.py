"""Tables as the sheets of a workbook: one number a cell, numbers as numbers, and no text is a formula or a link."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import IO, Any, Final

from shaftprint.errors import ShaftprintError
from shaftprint.escape import FORMULA_BEGINS, printable
from shaftprint.plain_table import Column, Table, texts

# What a program for spreadsheets allows: letters of the name of a sheet, and those that may not stand in it.
_MOST_LETTERS: Final = 31
_FORBIDDEN: Final = re.compile(r"[\[\]:*?/\\']")
_WIDEST_PIXELS: Final = 420
_NOTHING: Final = ("", "–", "-")
# A number with a mark, such as the end of an interval that is a bound of the search, stays a text.
_NUMBER: Final = r"([−-]?\d[\d\s]*(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?)"
_REST: Final = r"(\s?%|\s[^\d(*]+)?( \*)?"
_ALONE, _DEVIATION, _INTERVAL = (
    re.compile(f"{pattern}{_REST}") for pattern in (_NUMBER, f"{_NUMBER} ± {_NUMBER}", f"{_NUMBER} to {_NUMBER}")
)
_KINDS: Final = ((_DEVIATION, ("", ", std")), (_INTERVAL, (", from", ", to")))
_PLAIN: Final = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")

Value = str | tuple[float, str]
"""A text, or a number with the format in which it is shown."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Sheet:
    """A table with one number a cell."""

    title: str
    """What it shows."""
    columns: tuple[Column, ...]
    """Its columns."""
    rows: Sequence[Sequence[Value]]
    """Its rows."""
    note: str = ""
    """What is said of it."""


def expect_writer() -> None:
    """Raise ShaftprintError without the package that writes workbooks."""
    if find_spec("xlsxwriter") is None:
        raise ShaftprintError('xlsx: expected the package XlsxWriter, found none; pip install "shaftprint[xlsx]".')


def write_workbook(target: IO[bytes], sheets: Sequence[Sheet]) -> None:
    """Write a workbook (XLSX) with a sheet for each table, and before them one that lists them.

    Raises ShaftprintError without the package that writes it.
    """
    expect_writer()
    names = _names([sheet.title for sheet in sheets])
    contents = [(name, sheet.title, sheet.note) for name, sheet in zip(names, sheets, strict=True)]
    # a text is a text, whatever it looks like
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
    with import_module("xlsxwriter").Workbook(target, options) as book:
        _fill(book, "Contents", texts("sheet", "table", "note"), contents)
        for name, sheet in zip(names, sheets, strict=True):
            _fill(book, name, sheet.columns, sheet.rows)


def sheet_of(table: Table) -> Sheet:
    """Return a table whose columns hold one number each: a value, its deviation, the ends of an interval, its unit."""
    columns: list[Column] = []
    filled: list[Sequence[Value]] = []
    for place, column in enumerate(table.columns):
        cells = [row[place] for row in table.rows]
        if not column.number:
            columns.append(column)
            filled.append(cells)
            continue
        pattern, endings = next(
            (kind for kind in _KINDS if any(kind[0].fullmatch(cell) for cell in cells)), (_ALONE, ("",))
        )
        read = [_values(cell, pattern, len(endings)) for cell in cells]
        heading = column.heading.removesuffix(" ± std")
        columns += [Column(f"{heading}{ending}", number=True) for ending in endings]
        filled += [[values[number] for values, _, _ in read] for number in range(len(endings))]
        for which, title in ((1, "unit"), (2, "not to be used")):
            if any(one[which] for one in read):
                columns.append(Column(f"{heading}, {title}"))
                filled.append([str(one[which]) for one in read])
    rows = [list(row) for row in zip(*filled, strict=True)]
    return Sheet(title=table.title, columns=tuple(columns), rows=rows, note=table.note)


def shown(cell: Value) -> str:
    """Return a cell as text that programs read: no blanks between thousands, powers as ``e``."""
    if isinstance(cell, str):
        return cell
    number, style = cell
    if style == "General":
        return repr(number)
    decimals = len(style.rstrip("%").partition("E")[0].partition(".")[2])
    if style.endswith("%"):
        return f"{100.0 * number:.{decimals}f} %"
    return f"{number:.{decimals}{'e' if 'E' in style else 'f'}}"


def style_for(std: float) -> str:
    """Return the format that shows the second digit of a standard deviation."""
    if not (std > 0.0 and math.isfinite(std)):
        return "General"
    decimals = max(0, 1 - math.floor(math.log10(std)))
    return "0." + "0" * decimals if decimals else "0"


def _values(cell: str, pattern: re.Pattern[str], count: int) -> tuple[list[Value], str, str]:
    """Return the numbers of a cell, their unit and their mark; a cell of another kind as it is, in the first column."""
    match = pattern.fullmatch(cell) or _ALONE.fullmatch(cell)
    if match is None:
        return [cell if cell not in _NOTHING else "", *[""] * (count - 1)], "", ""
    *found, unit, mark = match.groups()
    unit = (unit or "").strip()
    values: list[Value] = [_value(text, percent=unit == "%") for text in found]
    return [*values, *[""] * (count - len(values))], unit if unit != "%" else "", (mark or "").strip()


def _value(text: str, *, percent: bool) -> Value:
    mantissa, _, power = "".join(text.split()).translate(_PLAIN).partition("·10")
    decimals = len(mantissa.partition(".")[2])
    style = f"0.{'0' * decimals}" if decimals else "0"
    number = float(mantissa) * 10.0 ** int(power or 0)
    if percent:
        # a per cent has no power in a spreadsheet: as many decimals as it takes
        decimals = max(0, decimals - int(power or 0))
        return number / 100.0, f"0.{'0' * decimals}%" if decimals else "0%"
    return number, f"{style}E+0" if power else style


def _names(titles: Sequence[str]) -> list[str]:
    """Return names of sheets: short, without what is forbidden, and no two alike."""
    names: list[str] = []
    for title in titles:
        plain = _FORBIDDEN.sub(" ", printable(title)).strip() or "table"
        name, number = plain[:_MOST_LETTERS].strip(), 2
        while name.lower() in ("contents", "history", *map(str.lower, names)):
            name, number = f"{plain[: _MOST_LETTERS - 4].strip()} {number}", number + 1
        names.append(name)
    return names


def _fill(book: Any, name: str, columns: Sequence[Column], rows: Sequence[Sequence[Value]]) -> None:
    """Write one sheet: headings that stay in view, texts as texts, numbers with their format."""
    sheet = book.add_worksheet(name)
    quoted = book.add_format({"quote_prefix": True})
    heads = book.add_format({"bold": True, "bottom": 1, "text_wrap": True})
    formats: dict[str, Any] = {}
    for place, column in enumerate(columns):
        sheet.write_string(0, place, printable(str(column.heading)), heads)
    for number, row in enumerate(rows, start=1):
        for place, cell in enumerate(row):
            if isinstance(cell, tuple):
                value, style = cell
                if style not in formats:
                    formats[style] = book.add_format({"num_format": style})
                if math.isfinite(value):
                    sheet.write_number(number, place, value, formats[style])
            elif cell:
                text = printable(str(cell))
                sheet.write_string(number, place, text, *([quoted] if text[0] in FORMULA_BEGINS else []))
    sheet.freeze_panes(1, 1)
    if rows:
        sheet.autofilter(0, 0, len(rows), len(columns) - 1)
    sheet.autofit(_WIDEST_PIXELS)
