"""Tables on the terminal."""

from collections.abc import Sequence

from shaftprint.cli._terminal import output, print_lines_of_table, say, width
from shaftprint.cli.output._json import table_json
from shaftprint.cli.output._layout import table_lines
from shaftprint.digits import plain_letters
from shaftprint.plain_table import Table


def print_tables(tables: Sequence[Table]) -> None:
    """Print those tables that have rows; a note that several have in common comes once, after the last of them."""
    shown = [table for table in tables if table.rows]
    for number, table in enumerate(shown, start=1):
        print_table(table, noted=all(following.note != table.note for following in shown[number:]))


def print_table(table: Table, *, noted: bool = True) -> None:
    """Print a table with its title and, where it is ``noted``, its note; as wide as the terminal at the most."""
    chosen = output()
    if chosen.workbook is not None:
        chosen.workbook.tables.append(table)
    if chosen.document is not None:
        chosen.document.tables.append(table_json(table))
        return
    if chosen.answers_only:
        return
    print_lines_of_table(plain_letters(table.title), table_lines(table, width()))
    if noted and table.note:
        say(f"{plain_letters(table.note)}\n")
