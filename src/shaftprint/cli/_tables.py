"""Tables on the terminal."""

from collections.abc import Collection, Sequence

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from shaftprint.escape import printable

# A table that goes into a file or a pipe must not be folded to the width of a terminal that is not there.
WIDTH_WITHOUT_TERMINAL = 200
WIDEST = 10_000


def print_table(
    title: str,
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    numbers: Collection[int] = (),
    spare: bool = False,
) -> None:
    """Print a table with a title.

    Parameters
    ----------
    title
        What the table shows.
    columns
        Headings, with units.
    rows
        Cells, a row for each line.
    numbers
        Places of the columns that hold numbers; they are set to the right.
    spare
        Whether the last column may be left out where the terminal is too narrow for it.
    """
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDTH_WITHOUT_TERMINAL)
    table = _table(columns, rows, numbers)
    unbounded = console.options.update(max_width=WIDEST)
    if spare and console.measure(table, options=unbounded).maximum > console.width:
        table = _table(columns[:-1], [row[:-1] for row in rows], numbers)
    console.print(literal(title, style="bold"), soft_wrap=True)
    console.print(table)


def _table(columns: Sequence[str], rows: Sequence[Sequence[str]], numbers: Collection[int]) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for place, heading in enumerate(columns):
        table.add_column(literal(heading), justify="right" if place in numbers else "left")
    for row in rows:
        table.add_row(*(literal(cell) for cell in row))
    return table


def literal(text: str, *, style: str = "") -> Text:
    """Return text for rich that stands for itself: no brackets are markup in it, no words between colons pictures."""
    return Text(printable(text), style=style)
