"""``shaftprint store history``: the tests of a ship in the order of time."""

from __future__ import annotations

from datetime import UTC, tzinfo

import click

from shaftprint.cli._store_options import opened_store, shown_zone_option, store_option
from shaftprint.cli._store_tables import (
    DAMAGED,
    event_table,
    number_table,
    physical_history_table,
    print_damage,
    test_table,
)
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.store._history import history


@click.command("history")
@click.argument("ship")
@store_option
@click.option("--number", metavar="NAME", help="One number over time, such as K_Q.")
@click.option("--line", "lines", multiple=True, metavar="NAME", help="Shaft line, such as port; may be repeated.")
@click.option("--all", "superseded", is_flag=True, help="Show fingerprints that were superseded too.")
@shown_zone_option
@click.pass_context
def command(
    context: click.Context,
    ship: str,
    url: str,
    *,
    number: str | None,
    lines: tuple[str, ...],
    superseded: bool,
    zone: tzinfo | None,
) -> None:
    """Show the tests of a ship in the order of time.

    SHIP is its name or its IMO number. Of a recording that was identified several times
    the newest fingerprint is shown.
    """
    with opened_store(url) as store:
        found = history(store, ship, number=number, lines=lines, superseded=superseded)
    answer(f"{found.ship.name}. Fingerprints: {len(found.entries)}; events: {len(found.events)}.")
    give("history", found)
    shown_in = zone or UTC
    numbers = physical_history_table(found.entries, shown_in)
    if number is not None:
        numbers = number_table(found.entries, shown_in, number)
    print_tables([test_table(found.entries, shown_in), numbers, event_table(found.events, shown_in)])
    if found.faults:
        print_damage(found.faults)
        context.exit(DAMAGED)
