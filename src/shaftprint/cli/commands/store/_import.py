"""``shaftprint store import``: the records of an export into the store."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._json import give
from shaftprint.late import late

with late():
    from shaftprint.store._import import import_store


@click.command("import")
@click.argument("file", type=click.Path(path_type=Path))
@store_option
def command(file: Path, url: str) -> None:
    """Put the records of an export into the store.

    All of FILE is put in or nothing; what is in the store already is not kept twice.
    """
    with opened_store(url) as store:
        imported = import_store(store, file)
        answer(
            f"{store.name}. New fingerprints: {imported.fingerprints}; new events: {imported.events}; new jobs: "
            f"{imported.jobs}; fingerprints that were there: {imported.known}."
        )
    give("imported", imported)
