"""``shaftprint store event``: what was done to a shaft line."""

from __future__ import annotations

from datetime import datetime, tzinfo

import click

from shaftprint.cli._dates import zone_option
from shaftprint.cli._store_options import instant, moment_option, opened_store, store_option
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._json import give
from shaftprint.late import late
from shaftprint.store._nouns import KINDS
from shaftprint.zones import utc_text

with late():
    from shaftprint.store._event import record_event, withdraw_event


@click.command("event")
@click.argument("ship")
@click.argument("kind", type=click.Choice(KINDS))
@store_option
@moment_option("--at", "When it was done.", required=True, any_time=True)
@zone_option("Zone of a time without an offset, such as Europe/Amsterdam.")
@click.option("--line", "lines", multiple=True, metavar="NAME", help="Shaft line, where the ship has several.")
@click.option("--number", "numbers", multiple=True, metavar="NAME", help="A number that it affects, such as K_Q.")
@click.option("--note", default="", metavar="TEXT", help="What else is to be said.")
@click.option("--withdraw", metavar="WHY", help="Let the event of that time count no more, and keep why.")
def command(
    ship: str,
    kind: str,
    url: str,
    *,
    at: datetime,
    zone: tzinfo | None,
    lines: tuple[str, ...],
    numbers: tuple[str, ...],
    note: str,
    withdraw: str | None,
) -> None:
    """Note what was done to a shaft line, such as a docking.

    SHIP is its name or its IMO number. --line and --number may be repeated. What was noted by mistake is withdrawn and
    stays in the record: `shaftprint store history` shows it with the reason.
    """
    when = instant(at, zone, option="--at")
    if withdraw is not None:
        _withdraw(url, ship, kind, when, lines, withdraw)
        return
    with opened_store(url) as store:
        events = record_event(store, ship, kind, at=when, lines=lines, numbers=numbers, note=note)
    give("events", [event for event, _ in events])
    for event, is_new in events:
        kept = "is kept" if is_new else "is in the store already"
        answer(f"{event.line.ship.name}, {event.line.position}: {event.kind} of {utc_text(event.at)} {kept}.")


def _withdraw(url: str, ship: str, kind: str, when: datetime, lines: tuple[str, ...], why: str) -> None:
    with opened_store(url) as store:
        events = withdraw_event(store, ship, kind, at=when, lines=lines, why=why)
    give("events", [event for event, _ in events])
    for event, counted in events:
        now = "counts no more" if counted else "was withdrawn before"
        answer(f"{event.line.ship.name}, {event.line.position}: {event.kind} of {utc_text(event.at)} {now}.")
