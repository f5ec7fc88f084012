"""``shaftprint store init``: an empty store."""

from __future__ import annotations

import click

from shaftprint.cli._store_options import store_option
from shaftprint.cli._terminal import answer
from shaftprint.late import late

with late():
    from shaftprint.store._store import create_store


@click.command("init")
@store_option
def command(url: str) -> None:
    """Make an empty store.

    In PostgreSQL the database must be there; its tables are made.
    """
    with create_store(url) as store:
        answer(f"{store.name} is an empty store; `shaftprint store add RESULT` puts a fingerprint into it.")
