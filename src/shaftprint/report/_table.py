"""A table of the report, and names of parameters as HTML."""

import re
from dataclasses import dataclass, replace
from typing import TypeAlias

from markupsafe import Markup, escape

from shaftprint.report._symbols import is_symbol, name_parts

Cell: TypeAlias = str | Markup

_SYMBOL = re.compile(r"\b(?:(?:[A-Za-z]|tau|omega)_[A-Za-z0-9]+|zeta)\b")
_LETTERS = {"tau": "τ", "omega": "ω", "zeta": "ζ", "delta": "δ", "eta": "η", "rho": "ρ"}


@dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """A table with its caption; the first column names the rows."""

    caption: str
    """What the table shows."""
    header: tuple[Cell, ...]
    """Heading of each column."""
    rows: tuple[tuple[Cell, ...], ...]
    """Cells, row by row."""
    note: str = ""
    """What a reader must know beside it."""

    def __post_init__(self) -> None:
        """Check that every row fits the header.

        Raises
        ------
        ValueError
            If a row is longer or shorter.
        """
        for row in self.rows:
            if len(row) != len(self.header):
                raise ValueError(f"table {self.caption}: expected {len(self.header)} cells in a row, found {len(row)}.")


def with_symbols(table: Table) -> Table:
    """Return a table of plain text with the symbols in its heading and cells set as such."""
    rows = tuple(tuple(sentence_html(cell) for cell in row) for row in table.rows)
    return replace(table, header=tuple(sentence_html(cell) for cell in table.header), rows=rows)


def sentence_html(text: str) -> Markup:
    """Return a sentence as HTML, symbols with an index or a Greek name set as such and +/- as ±, all else as it is."""
    text = text.replace("+/-", "±")
    parts, end = Markup(), 0
    for found in _SYMBOL.finditer(text):
        parts += escape(text[end : found.start()]) + symbol_html(found.group())
        end = found.end()
    return parts + escape(text[end:])


def symbol_html(formula: str) -> Markup:
    """Return a parameter name or formula as HTML: letters slanted, indices lowered; ordinary words stay as they are."""
    parts = Markup()
    for before, base, index in name_parts(formula):
        parts += escape(before)
        if not base:
            continue
        if not is_symbol(base, index):
            parts += escape(base)
            continue
        parts += Markup("<i>{}</i>").format(_LETTERS.get(base, base))
        if index:
            parts += Markup("<sub>{}</sub>").format(index)
    return parts
