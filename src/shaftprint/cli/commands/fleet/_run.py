"""``shaftprint fleet run``: recordings into the ledger, and workers that identify them."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._fleet_options import say_refusals, say_what_was_done, work_here, work_options
from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import no_progress_option
from shaftprint.late import late

with late():
    from shaftprint.fleet._dask import work_on_dask
    from shaftprint.fleet._lists import recordings_in, recordings_of_list
    from shaftprint.fleet._submit import submit
    from shaftprint.fleet._work import Worked
    from shaftprint.store._job import Job
    from shaftprint.store._ledger import jobs
    from shaftprint.store._store import Store


@click.command("run")
@click.argument("recordings", metavar="FOLDER|LIST.csv", type=click.Path(path_type=Path))
@click.option("--vessel", metavar="TEXT", help="Vessel file, or a shipped name such as stan-tug-1205.")
@click.option("--campaign", metavar="TEXT", help="Campaign file, or a shipped name such as thesis.")
@click.option("--structure", metavar="NAME", help="Model structure.  [default: as identify takes it]")
@click.option("--ship", metavar="NAME", help="Name of the ship, where the vessel file does not say it.")
@click.option("--imo", type=int, metavar="NUMBER", help="Its IMO number, where the vessel file does not say it.")
@click.option("--line", metavar="NAME", help="Shaft line, such as port, where the vessel file does not say it.")
@click.option("--class", "class_name", metavar="NAME", help="What sister ships have in common, as `sisters` takes it.")
@click.option("--time-zone", "time_zone", metavar="ZONE", help="Zone of the loggers' clocks, where files state none.")
@store_option
@work_options
@click.option("--dask", "address", metavar="URL", help="Scheduler of a Dask cluster whose workers do it instead.")
@no_progress_option
@click.pass_context
def command(
    context: click.Context,
    /,
    recordings: Path,
    url: str,
    processes: int,
    minutes: float,
    address: str | None,
    *,
    no_progress: bool,
    **facts: Any,
) -> None:
    """Identify the recordings of a folder or a list, and keep their fingerprints.

    The first line of a list names its columns: recording, and where they differ vessel, campaign, ship, imo, line,
    class, tested-at, time-zone, place, draught-m and so on; options hold for rows that say nothing. What is done
    already is not done again, so the same command goes on with a run that was ended. --processes 0 leaves the work to
    others.
    """
    found = recordings_in(recordings, **facts) if recordings.is_dir() else recordings_of_list(recordings, **facts)
    with opened_store(url) as store:
        asked = submit(store, found, now=datetime.now(UTC))
        ids = {one.id for one in asked}
        is_open = [one for one in asked if one.state in ("waiting", "running")]
        give("asked", {"recordings": len(found), "jobs": len(ids), "to_do": len({one.id for one in is_open})})
        answer(f"Recordings: {len(found)}; to be identified: {len({one.id for one in is_open})}.")
        if is_open and processes:
            worked = _worked(store, url, address, processes=processes, minutes=minutes, hidden=no_progress)
            say_what_was_done(store, worked)
        refused = tuple(one for one in _now(store, ids) if one.state == "refused")
    say_refusals(refused)
    if refused:
        context.exit(NOT_REACHED)


def _worked(store: Store, url: str, address: str | None, *, processes: int, minutes: float, hidden: bool) -> Worked:
    if address is None:
        return work_here(store, processes=processes, wait=False, minutes=minutes, hidden=hidden)
    return work_on_dask(address, url, limit_s=60.0 * minutes)


def _now(store: Store, ids: set[int]) -> tuple[Job, ...]:
    """Return jobs as they stand now, with all digits for JSON."""
    found = tuple(one for one in jobs(store) if one.id in ids)
    give("jobs", found)
    return found
