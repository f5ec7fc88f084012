"""``shaftprint fleet retry``: refused jobs wait again."""

from __future__ import annotations

import click

from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import answer
from shaftprint.late import late

with late():
    from shaftprint.store._ledger import job, retry


@click.command("retry")
@click.argument("numbers", metavar="[JOB]...", nargs=-1, type=int)
@store_option
def command(numbers: tuple[int, ...], url: str) -> None:
    """Let refused jobs wait again: those with some numbers, or all.

    A file that was changed makes another job: `shaftprint fleet run` asks for that.
    """
    with opened_store(url) as store:
        chosen = [job(store, number) for number in numbers] or None
        count = retry(store, chosen)
    answer(f"Jobs that wait again: {count}; shaftprint work does them.")
