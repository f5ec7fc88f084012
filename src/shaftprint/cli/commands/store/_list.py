"""``shaftprint store list``: all lines with their newest test."""

from __future__ import annotations

from datetime import UTC, tzinfo

import click

from shaftprint.cli._store_options import opened_store, shown_zone_option, store_option
from shaftprint.cli._store_tables import line_table
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.store._history import newest


@click.command("list")
@store_option
@click.option("--number", metavar="NAME", help="A number of each newest test, such as K_Q.")
@shown_zone_option
def command(url: str, *, number: str | None, zone: tzinfo | None) -> None:
    """List the shaft lines with their newest test."""
    with opened_store(url) as store:
        lines = newest(store, number=number)
    ships = {(one.line.ship.imo_number, one.line.ship.name) for one in lines}
    answer(f"Ships: {len(ships)}; shaft lines: {len(lines)}; tests: {sum(one.tests for one in lines)}.")
    give("lines", lines)
    print_tables([line_table(lines, zone or UTC, number)])
