"""The table: made once, printed on the terminal and in the report."""

from dataclasses import dataclass


class Symbol(str):
    """Name of a parameter or channel, or a formula of such; a page sets its letters slanted and its indices lowered."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table."""

    heading: str
    """What it holds, with the unit in brackets where all cells share one."""
    number: bool = False
    """Whether it holds numbers, which stand to the right on a terminal."""
    spare: bool = False
    """Whether it may be left out where a terminal is too narrow."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """A table of plain text; who prints it makes a foreign text harmless for its terminal or page."""

    title: str
    """What the table shows."""
    columns: tuple[Column, ...]
    """Columns; the first names the rows."""
    rows: tuple[tuple[str, ...], ...]
    """Cells, row by row."""
    note: str = ""
    """What a reader must know with it."""
    symbols: bool = False
    """Whether names of parameters stand within its headings and cells, for a page to set as such."""

    def __post_init__(self) -> None:
        """Check that every row fits the columns.

        Raises
        ------
        ValueError
            If a row is longer or shorter.
        """
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"table {self.title}: expected {len(self.columns)} cells in a row, found {len(row)}.")


def texts(*headings: str) -> tuple[Column, ...]:
    """Return columns of text."""
    return tuple(Column(heading) for heading in headings)


def numbers(*headings: str) -> tuple[Column, ...]:
    """Return columns of numbers."""
    return tuple(Column(heading, number=True) for heading in headings)


MEANING = Column("meaning", spare=True)
"""The last column of tables of parameters."""
