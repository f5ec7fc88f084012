"""What the actions of ``shaftprint store`` have in common: which store, and times in a zone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, tzinfo
from typing import Any

import click

from shaftprint.cli._dates import DATE_FORMATS, Moment, zone_option
from shaftprint.cli._terminal import echo
from shaftprint.late import late
from shaftprint.zones import in_zone

with late():
    from shaftprint.store._store import Store, open_store


DEFAULT_STORE = "shaftprint.db"


def store_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--store``, handed over as ``url``."""
    return click.option(
        "--store",
        "url",
        envvar="SHAFTPRINT_STORE",
        default=DEFAULT_STORE,
        metavar="URL",
        help=f"File, or postgresql://USER@HOST/DATABASE; by default SHAFTPRINT_STORE, else {DEFAULT_STORE}.",
    )(command)


@contextmanager
def opened_store(url: str) -> Iterator[Store]:
    """Open a store, and say it where it can only be read."""
    with open_store(url) as store:
        if store.is_read_only:
            echo(f"{store.name} is read only here: it is read as it is, and nothing can be put in.", err=True)
        yield store


def shown_zone_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--time-zone`` of a command that shows times."""
    return zone_option("Zone in which times are shown, such as Europe/Amsterdam; UTC by default.")(command)


def moment_option(
    name: str, words: str, *, required: bool = False, any_time: bool = False
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return a decorator that adds an option with a time; of any time at all, where what is done with it judges it."""
    kind = click.DateTime(DATE_FORMATS) if any_time else Moment()
    return click.option(name, type=kind, metavar="DATE", required=required, help=words)


def instant(shown: datetime, zone: tzinfo | None, *, option: str) -> datetime:
    """Return the instant of a time that was typed.

    Raises click.UsageError if it has no offset and no zone was stated, or clocks of the zone show it twice or never.
    """
    if shown.tzinfo is None and zone is None:
        raise click.UsageError(
            f"{option}: expected an offset such as +02:00 with {shown.isoformat(sep=' ')}, found none; add it, or "
            "state --time-zone."
        )
    try:
        return in_zone(shown, zone or UTC)
    except ValueError as error:
        raise click.UsageError(f"{option}: {error}.") from None
