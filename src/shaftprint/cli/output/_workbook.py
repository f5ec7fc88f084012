"""What a command prints as a workbook: each table on a sheet, numbers as numbers, the fingerprint with all digits."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import click

from shaftprint.escape import FORMULA_BEGINS, printable
from shaftprint.files import written_whole
from shaftprint.late import late
from shaftprint.plain_table import Column, Table, numbers, texts

with late():
    import xlsxwriter

    from shaftprint.fingerprint import _line_fingerprint
    from shaftprint.tables._fingerprint import limits

ENDING = ".xlsx"
# What a program for spreadsheets allows: letters of the name of a sheet, and those that may not stand in it.
MOST_LETTERS, FORBIDDEN = 31, re.compile(r"[\[\]:*?/\\']")
WIDEST = 60
NOTHING = ("", "–", "-")
# A number with a mark, such as the end of an interval that is a bound of the search, stays a text.
_NUMBER = r"([−-]?\d[\d\u202f]*(?:\.\d+)?(?:·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?)"
_REST = r"(?:\s?%|\s[^\d(]*)?"
_ALONE, _DEVIATION, _INTERVAL = (
    re.compile(f"{pattern}({_REST})") for pattern in (_NUMBER, f"{_NUMBER} ± {_NUMBER}", f"{_NUMBER} to {_NUMBER}")
)
_KINDS = ((_DEVIATION, ("", ", std")), (_INTERVAL, (", from", ", to")))
_POWER = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-", "\u202f")

Value = str | tuple[float, str]
"""A text, or a number with the format in which it is shown."""


@dataclass(kw_only=True, slots=True)
class Workbook:
    """The tables and nouns of a command that end in one file."""

    path: Path
    """The file."""
    tables: list[Table] = field(default_factory=list)
    """Tables as they are printed, those of the details too."""
    nouns: dict[str, Any] = field(default_factory=dict)
    """What the command gives beside them, by name."""

    def write(self) -> None:
        """Write the file, whole or not at all."""
        sheets = [*self._fingerprints(), *((table.title, *_split(table)) for table in self.tables if table.rows)]
        notes = {table.title: table.note for table in self.tables}
        names = _names([title for title, _, _ in sheets])
        contents: list[Sequence[Value]] = [
            (name, title, notes.get(title, "")) for name, (title, _, _) in zip(names, sheets, strict=True)
        ]
        # a text is a text, whatever it looks like
        options = {"strings_to_formulas": False, "strings_to_urls": False, "strings_to_numbers": False}
        with written_whole(self.path) as part, xlsxwriter.Workbook(str(part), options) as book:
            _fill(book, "Contents", texts("sheet", "table", "note"), contents)
            for name, (_, columns, rows) in zip(names, sheets, strict=True):
                _fill(book, name, columns, rows)

    def _fingerprints(self) -> Iterator[tuple[str, tuple[Column, ...], Sequence[Sequence[Value]]]]:
        """Return numbers and sources of each fingerprint that the command gives."""
        for name, noun in self.nouns.items():
            if isinstance(noun, _line_fingerprint.LineFingerprint):
                yield f"Numbers of {name}", NUMBER_COLUMNS, list(_numbers(noun))
                sources: list[Sequence[Value]] = [(one.name, one.role, one.sha256) for one in noun.sources]
                yield f"Sources of {name}", texts("file", "what it is", "SHA-256"), sources


NUMBER_COLUMNS = (
    *texts("quantity"),
    *numbers("value", "std", "95 % from", "95 % to"),
    *texts("bound of the search", "unit"),
    *numbers("vessel file", "vessel file, std"),
    *texts("usable", "why not", "meaning"),
)


def workbook_at(path: Path) -> Workbook:
    """Return an empty workbook that will be written to a file.

    Raises click.ClickException if the file cannot be one, is there already, or the library is not installed.
    """
    if path.suffix.lower() != ENDING:
        raise click.ClickException(f"--xlsx {path}: expected a file that ends in {ENDING}.")
    if path.exists() or not path.resolve().parent.is_dir():
        words = "exists already; choose another name" if path.exists() else "expected an existing folder; make it first"
        raise click.ClickException(f"--xlsx {path}: {words}.")
    if find_spec("xlsxwriter") is None:
        raise click.ClickException('--xlsx: expected the package XlsxWriter; pip install "shaftprint[xlsx]".')
    return Workbook(path=path)


def _numbers(fingerprint: _line_fingerprint.LineFingerprint) -> Iterator[Sequence[Value]]:
    """Return all numbers of a fingerprint with all digits, shown to the second digit of their deviation."""
    verdict = fingerprint.verdict
    for group in ("parameters", "combinations", "physical", "margins"):
        for one in getattr(fingerprint, group, ()):
            std = one.std if one.stated_std is not None else math.nan
            doubt = verdict.not_trusted.get(one.name, "") if verdict.trustworthy else "the fit is not trustworthy"
            shown = _format_for(one.std)
            cells = [(number, shown) for number in (one.value, std, *limits(one))]
            expected = [("" if e is None else (e, shown)) for e in (one.expected, one.expected_std)]
            bound = " and ".join(end for end, is_open in zip(("from", "to"), one.interval_open, strict=True) if is_open)
            yield (one.name, *cells, bound, one.unit, *expected, "no" if doubt else "yes", doubt, one.meaning)


def _format_for(std: float) -> str:
    """Return the format that shows the second digit of a standard deviation."""
    if not (std > 0.0 and math.isfinite(std)):
        return "General"
    decimals = max(0, 1 - math.floor(math.log10(std)))
    return "0." + "0" * decimals if decimals else "0"


def _split(table: Table) -> tuple[tuple[Column, ...], list[list[Value]]]:
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
        filled += [[values[number] for values, _ in read] for number in range(len(endings))]
        if any(unit for _, unit in read):
            columns.append(Column(f"{heading}, unit"))
            filled.append([unit for _, unit in read])
    return tuple(columns), [list(row) for row in zip(*filled, strict=True)]


def _values(cell: str, pattern: re.Pattern[str], count: int) -> tuple[list[Value], str]:
    """Return the numbers of a cell and their unit; a cell of another kind as it is, in the first of its columns."""
    match = pattern.fullmatch(cell) or _ALONE.fullmatch(cell)
    if match is None:
        return [cell if cell not in NOTHING else "", *[""] * (count - 1)], ""
    *found, rest = match.groups()
    values: list[Value] = [_value(text, percent="%" in rest) for text in found]
    return [*values, *[""] * (count - len(values))], rest.strip() if "%" not in rest else ""


def _value(text: str, *, percent: bool) -> Value:
    mantissa, _, power = text.translate(_POWER).partition("·10")
    decimals = len(mantissa.partition(".")[2])
    shown = f"0.{'0' * decimals}" if decimals else "0"
    number = float(mantissa) * 10.0 ** int(power or 0)
    if percent:
        return number / 100.0, f"{shown}%"
    return number, f"{shown}E+0" if power else shown


def _names(titles: Sequence[str]) -> list[str]:
    """Return names of sheets: short, without what is forbidden, and no two alike."""
    names: list[str] = []
    for title in titles:
        plain = FORBIDDEN.sub(" ", printable(title)).strip() or "table"
        name, number = plain[:MOST_LETTERS].strip(), 2
        while name.lower() in ("contents", "history", *map(str.lower, names)):
            name, number = f"{plain[: MOST_LETTERS - 4].strip()} {number}", number + 1
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
                value, shown = cell
                if math.isfinite(value):
                    sheet.write_number(
                        number, place, value, formats.setdefault(shown, book.add_format({"num_format": shown}))
                    )
            elif cell:
                text = printable(str(cell))
                sheet.write_string(number, place, text, *([quoted] if text[0] in FORMULA_BEGINS else []))
    sheet.freeze_panes(1, 1)
    if rows:
        sheet.autofilter(0, 0, len(rows), len(columns) - 1)
    sheet.autofit(7 * WIDEST)
