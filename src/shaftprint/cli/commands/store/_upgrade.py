"""``shaftprint store upgrade``: a store of an earlier version brought up to date."""

from __future__ import annotations

import click

from shaftprint.cli._store_options import store_option
from shaftprint.cli._terminal import answer
from shaftprint.late import late

with late():
    from shaftprint.store._store import upgrade_store


@click.command("upgrade")
@store_option
def command(url: str) -> None:
    """Bring a store of an earlier version up to date.

    It is upgraded wholly or not at all. Make an export before: an earlier version of shaftprint does not read it any
    more.
    """
    before, after = upgrade_store(url)
    if before == after:
        answer(f"The store has schema {after}, the newest; nothing was changed.")
    else:
        answer(f"The store had schema {before}, and has {after} now.")
