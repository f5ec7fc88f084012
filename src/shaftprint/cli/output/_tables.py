"""Tables on the terminal."""

from collections.abc import Sequence
from itertools import compress, pairwise

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table as Drawn
from rich.text import Text

from shaftprint.cli._terminal import echo, on_terminal
from shaftprint.escape import printable
from shaftprint.tables import Table

# A table that goes into a file or a pipe must not be folded to the width of a terminal that is not there.
WIDTH_WITHOUT_TERMINAL = 200
WIDEST = 10_000


def print_tables(tables: Sequence[Table]) -> None:
    """Print those tables that have rows; a note that several have in common comes once, after the last of them."""
    shown = [table for table in tables if table.rows]
    for table, following in pairwise([*shown, None]):
        if table is not None:
            print_table(table, noted=following is None or following.note != table.note)


def print_table(table: Table, *, noted: bool = True) -> None:
    """Print a table with its title and, where it is ``noted``, its note; spare columns only where there is room."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDTH_WITHOUT_TERMINAL)
    drawn = _drawn(table, spare=True)
    unbounded = console.options.update(max_width=WIDEST)
    if console.measure(drawn, options=unbounded).maximum > console.width:
        drawn = _drawn(table, spare=False)
    console.print(literal(on_terminal(table.title), style="bold"), soft_wrap=True)
    console.print(drawn)
    if noted and table.note:
        echo(f"{on_terminal(table.note)}\n")


def _drawn(table: Table, *, spare: bool) -> Drawn:
    shown = [spare or not column.spare for column in table.columns]
    drawn = Drawn(box=SIMPLE_HEAD, pad_edge=False)
    for column in compress(table.columns, shown):
        drawn.add_column(literal(on_terminal(column.heading)), justify="right" if column.number else "left")
    for row in table.rows:
        drawn.add_row(*(literal(on_terminal(cell)) for cell in compress(row, shown)))
    return drawn


def literal(text: str, *, style: str = "") -> Text:
    """Return text for rich that stands for itself: no brackets are markup in it, no words between colons pictures."""
    return Text(printable(text), style=style)
