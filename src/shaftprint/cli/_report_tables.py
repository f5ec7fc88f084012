"""Tables and sentences of the report on the terminal."""

from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.report import Table

# What a terminal's code page may lack, as it is written elsewhere on the terminal.
PLAIN = str.maketrans(
    {"−": "-", "±": "+/-", "°": " deg", "–": "-", "∞": "inf", "\u202f": "", "²": "2", "·": " ", "“": '"', "”": '"'}
)


def on_terminal(text: str) -> str:
    """Return a text of the report with letters that every terminal has."""
    return text.translate(PLAIN)


def print_report_table(table: Table) -> None:
    """Print a table of the report with its note."""
    rows = [[on_terminal(cell) for cell in row] for row in table.rows]
    print_table(on_terminal(table.caption), [on_terminal(cell) for cell in table.header], rows)
    if table.note:
        echo(f"{on_terminal(table.note)}\n")
