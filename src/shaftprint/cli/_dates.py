"""How a time is typed in an option, and the zone in which it is meant or shown."""

from collections.abc import Callable
from datetime import datetime, tzinfo
from typing import Any

import click

from shaftprint.zones import possible, time_zone

DATE_FORMATS = [
    "%Y-%m-%d",
    "%Y-%m-%dT%H:%M",
    "%Y-%m-%d %H:%M",
    "%Y-%m-%dT%H:%M:%S",
    "%Y-%m-%dT%H:%M%z",
    "%Y-%m-%dT%H:%M:%S%z",
]


class Moment(click.DateTime):
    """A time at which something can have been recorded or done."""

    def __init__(self) -> None:
        super().__init__(DATE_FORMATS)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> datetime:
        """Return the time that was typed."""
        shown: datetime = super().convert(value, param, ctx)
        try:
            return possible(shown)
        except ValueError as error:
            self.fail(f"{error}.", param, ctx)


def _zone(context: click.Context, parameter: click.Parameter, name: str | None) -> tzinfo | None:
    try:
        return None if name is None else time_zone(name)
    except ValueError as error:
        raise click.BadParameter(f"{error}.") from None


def zone_option(words: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Return a decorator that adds the option ``--time-zone``, handed over as ``zone``."""
    return click.option("--time-zone", "zone", callback=_zone, metavar="ZONE", help=words)
