"""``shaftprint store export``: all records in one file."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._store_tables import DAMAGED, print_damage
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._file_to_write import expect_free
from shaftprint.late import late

with late():
    from shaftprint.store._export import export_store
    from shaftprint.store._nouns import Fault


@click.command("export")
@click.argument("file", type=click.Path(path_type=Path))
@store_option
@click.option("--force", is_flag=True, help="Replace an earlier export.")
@click.pass_context
def command(context: click.Context, file: Path, url: str, *, force: bool) -> None:
    """Write all records into one file: a backup, or the way to another database.

    FILE is written whole or not at all, as JSON lines. Others may add records meanwhile: it holds what was there when
    it was begun.
    """
    with opened_store(url) as store:
        if file.exists() and Path(store.name).exists() and file.samefile(store.name):
            raise click.ClickException(f"{file}: expected another file than the store itself; choose another name.")
        expect_free(file, force=force)
        faults: list[Fault] = []
        count = export_store(store, file, overwrite=force, report=faults.append)
    answer(f"{file} holds all records; their number is {count}.")
    if faults:
        answer("Its documents are whole: imported into an empty store they give the numbers as they were.")
        print_damage(faults)
        context.exit(DAMAGED)
