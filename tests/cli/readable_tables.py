"""Whether the tables of a command can be read on terminals of different widths."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import pytest

from shaftprint.cli.output._layout import table_lines
from shaftprint.digits import plain_letters
from shaftprint.tables import Symbol, Table

WIDTHS = (80, 100, 200)


@contextmanager
def printed_tables() -> Iterator[Callable[[str], list[Table]]]:
    """Remember the tables that are made, and return those whose title is in an output.

    A report makes tables too, which no command prints.
    """
    tables: list[Table] = []
    check = Table.__post_init__

    def remembered(table: Table) -> None:
        check(table)
        tables.append(table)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Table, "__post_init__", remembered)
        yield lambda output: [
            table for table in tables if table.rows and _shown(table.title) in " ".join(output.split())
        ]


def expect_all_readable(tables: Sequence[Table]) -> None:
    """Expect that there are tables, and that each can be read on terminals of all widths."""
    assert tables
    for table in tables:
        for width in WIDTHS:
            expect_readable(table, width)


def expect_readable(table: Table, width: int) -> None:
    """Expect that no word is cut and no name lost, and that no line is wider than the terminal for nothing."""
    lines = table_lines(table, width)
    page = [line for line in lines if "─" not in line]
    words = {word for line in page for word in line.split()}
    cells = [cell for row in table.rows for cell in row] + [column.heading for column in table.columns]
    lost = {word for cell in cells for word in _shown(cell).split()} - words
    assert not lost, table.title
    for row in table.rows:
        for cell, column in zip(row, table.columns, strict=True):
            if column.number or isinstance(cell, Symbol):
                assert any(_shown(cell) in line for line in page), (table.title, cell)
    too_long = [line for line in lines if len(line) > width]
    longest_name = max(len(_shown(row[0])) for row in table.rows)
    longest_cell = max(len(word) for cell in cells for word in [_shown(cell)])
    assert not too_long or longest_name + longest_cell > width, (table.title, too_long)


def _shown(text: str) -> str:
    return plain_letters(text).replace("\u00a0", " ")
