"""``shaftprint store check``: whether every record is as it was written."""

from __future__ import annotations

import click

from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._store_tables import DAMAGED
from shaftprint.cli._terminal import answer, print_document, print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.store._check import check


@click.command("check")
@store_option
@no_progress_option
@click.pass_context
def command(context: click.Context, url: str, *, no_progress: bool) -> None:
    """Check that every record is as it was written.

    Documents are held against their SHA-256, numbers against their documents, and every row against its seal. A record
    that is not as it was written is named, and the command ends with 1.
    """
    with opened_store(url) as store, progress(hidden=no_progress) as steps:
        steps.begin("Checking the records")
        faults = check(store, report=steps.reach)
        name = store.name
    give("faults", faults)
    if not faults:
        answer(f"{name}: every record is as it was written.")
        return
    title = f"{name}: not as it was written; put a backup in its place"
    print_findings(title, [f"{fault.record}: {fault.found}" for fault in faults], is_answer=True)
    print_document()
    context.exit(DAMAGED)
