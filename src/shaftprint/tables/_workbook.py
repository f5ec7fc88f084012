"""Tables as the sheets of a workbook: numbers are numbers there, and no text is a formula or a link."""

import io
import re
from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from itertools import count
from typing import Final

from shaftprint.errors import ShaftprintError
from shaftprint.escape import printable
from shaftprint.plain_table import Column, Table

_LONGEST_NAME: Final = 31
_FORBIDDEN: Final = re.compile(r"[\[\]:*?/\\']")
_WITH_DEVIATION: Final = re.compile(r"(?P<value>[^±]+) ± (?P<std>[^±]+?)(?P<mark> \*)?")
_THOUSANDS: Final = re.compile(r"(?<=\d)\s(?=\d{3})")
_NONE: Final = frozenset({"", "–"})


def workbook(tables: Sequence[Table]) -> bytes:
    """Return a workbook (XLSX) with a sheet for each table.

    Raises ShaftprintError without the package that writes it.
    """
    if find_spec("xlsxwriter") is None:
        raise ShaftprintError('xlsx: expected the package xlsxwriter, found none; pip install "shaftprint[xlsx]".')
    xlsxwriter = import_module("xlsxwriter")
    content = io.BytesIO()
    options = {"in_memory": True, "strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
    with xlsxwriter.Workbook(content, options) as book:
        bold = book.add_format({"bold": True})
        names: set[str] = set()
        for table in tables:
            sheet = book.add_worksheet(_sheet_name(table.title, names))
            for place, column in enumerate(table.columns):
                cells = [row[place] for row in table.rows]
                sheet.write_string(0, place, printable(column.heading), bold)
                sheet.set_column(place, place, min(max(len(one) for one in (column.heading, *cells)) + 2, 60))
                for line, cell in enumerate(cells, start=1):
                    number = number_in(cell) if column.number else None
                    if number is None:
                        sheet.write_string(line, place, printable(cell))
                    else:
                        sheet.write_number(line, place, number)
            sheet.freeze_panes(1, 1)
    return content.getvalue()


def with_deviations_apart(table: Table) -> Table:
    """Return a table whose columns of ``value ± deviation`` are two columns each, for programs that calculate."""
    columns: list[Column] = []
    cells: list[list[str]] = []
    for place, column in enumerate(table.columns):
        whole = [row[place] for row in table.rows]
        parts = [_WITH_DEVIATION.fullmatch(one) for one in whole]
        if not any(parts) or not all(part or one in _NONE for part, one in zip(parts, whole, strict=True)):
            columns.append(column)
            cells.append(whole)
            continue
        columns += [Column(column.heading, number=True), Column(f"± {column.heading}", number=True)]
        cells += [[part[name] if part else "" for part in parts] for name in ("value", "std")]
        if any(part and part["mark"] for part in parts):
            columns.append(Column(f"{column.heading}, not to be used"))
            cells.append([part["mark"].strip() if part and part["mark"] else "" for part in parts])
    return Table(title=table.title, columns=tuple(columns), rows=tuple(zip(*cells, strict=True)), note=table.note)


def number_in(text: str) -> float | None:
    """Return the number that a cell shows; None where it shows something else."""
    plain = _THOUSANDS.sub("", text.replace("\u2212", "-"))
    try:
        number = float(plain)
    except ValueError:
        return None
    return number if abs(number) < float("inf") else None


def _sheet_name(title: str, names: set[str]) -> str:
    """Return a name for a sheet that no other sheet of the workbook has, and that a spreadsheet takes."""
    plain = _FORBIDDEN.sub(" ", printable(title)).strip()[:_LONGEST_NAME] or "table"
    for at in count(2):
        if plain.lower() not in names:
            break
        plain = f"{plain[: _LONGEST_NAME - 4].rstrip()} {at}"
    names.add(plain.lower())
    return plain
