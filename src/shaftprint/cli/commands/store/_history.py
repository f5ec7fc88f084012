"""``shaftprint store history``: the tests of a ship in the order of time."""

from __future__ import annotations

from collections import Counter
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
from shaftprint.errors import ShaftprintError
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.drift._history import history_of
    from shaftprint.drift._watch import watch
    from shaftprint.drift._words import watch_sentences
    from shaftprint.store._history import history
    from shaftprint.store._line_history import line_history
    from shaftprint.store._nouns import History
    from shaftprint.store._store import Store

SEED = 1
NEWEST = 40
"""Tests that are judged together; `drift` judges all."""


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

    SHIP is its name or its IMO number. What `drift` says of each line stands first: number by number a change is seen
    late. Of a recording that was identified several times
    the newest fingerprint is shown.
    """
    with opened_store(url) as store:
        found = history(store, ship, number=number, lines=lines, superseded=superseded)
        judged = [] if number is not None else _judged(store, found, lines)
    answer(f"{found.ship.name}. Fingerprints: {len(found.entries)}; events: {len(found.events)}.")
    for sentence in judged:
        answer(sentence)
    give("history", found)
    shown_in = zone or UTC
    numbers = physical_history_table(found.entries, shown_in)
    if number is not None:
        numbers = number_table(found.entries, shown_in, number)
    print_tables([test_table(found.entries, shown_in), numbers, event_table(found.events, shown_in)])
    if found.faults:
        print_damage(found.faults)
        context.exit(DAMAGED)


def _judged(store: Store, found: History, lines: tuple[str, ...]) -> list[str]:
    """Return what ``drift`` says of each line with two tests or more."""
    counts = Counter(entry.fingerprint.line.position for entry in found.entries)
    sentences = []
    for position in sorted(name for name, count in counts.items() if count > 1 and (not lines or name in lines)):
        try:
            known = line_history(store, found.ship, line=position, newest=NEWEST)
            tests = history_of(known.fingerprints, known.events)
            words = watch_sentences(watch(tests, rng=np.random.default_rng(SEED)), tests)
        except ShaftprintError as error:
            words = (f"It cannot be told: {error}",)
        sentences.append(f"{position}: has it changed? {' '.join(words)}")
    return sentences
