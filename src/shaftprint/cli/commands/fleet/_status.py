"""``shaftprint fleet status``: what has become of the jobs of a store."""

from __future__ import annotations

import click

from shaftprint import __version__
from shaftprint.cli._fleet_options import recording_of, refused_jobs, say_counts, say_refusals
from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import say
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late
from shaftprint.plain_table import Column, Table
from shaftprint.zones import utc_text

with late():
    from shaftprint.store._job import Job
    from shaftprint.store._ledger import job_counts, jobs


@click.command("status")
@store_option
def command(url: str) -> None:
    """Show how many jobs wait, run, are done or were refused, and why."""
    with opened_store(url) as store:
        counts, own = job_counts(store), job_counts(store, version=__version__)
        running = jobs(store, states=("running",))
        say_counts(store, counts)
        refused = refused_jobs(store)
    give("running", running)
    give("refused", refused)
    if counts.open > own.open:
        say(f"{counts.open - own.open} of them wait for a worker of another version of shaftprint than {__version__}.")
    if running:
        print_tables([_table(running)])
    say_refusals(refused)


def _table(running: tuple[Job, ...]) -> Table:
    headings = ("job", "recording", "worker", "try", "step", "lease until")
    rows = tuple(
        (
            str(one.id),
            recording_of(one),
            one.owner or "–",
            str(one.tries),
            one.progress or "–",
            "–" if one.lease_until is None else utc_text(one.lease_until),
        )
        for one in running
    )
    return Table(title="Running", columns=tuple(Column(heading=one) for one in headings), rows=rows)
