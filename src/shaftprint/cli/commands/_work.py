"""``shaftprint work``: the jobs of a store, done on this computer."""

import click

from shaftprint.cli._fleet_options import say_what_was_done, work_here, work_options
from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli.output._progress import no_progress_option


@click.command("work")
@store_option
@work_options
@click.option("--wait", is_flag=True, help="Wait for further jobs when none is left, until it is interrupted.")
@no_progress_option
def command(url: str, *, processes: int, minutes: float, wait: bool, no_progress: bool) -> None:
    """Do the jobs of a store on this computer.

    It works until none is left, and as many computers as reach the store may do so at one time; each must see the
    recordings under the same paths. A worker that is killed loses nothing: others take its jobs after a minute.
    """
    with opened_store(url) as store:
        worked = work_here(store, processes=max(processes, 1), wait=wait, minutes=minutes, hidden=no_progress)
        say_what_was_done(store, worked)
