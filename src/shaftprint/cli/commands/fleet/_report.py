"""``shaftprint fleet report``: the report of one job, made when somebody wants it."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._store_options import opened_store, store_option
from shaftprint.cli._terminal import say
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.errors import StoreError
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.fingerprint._json_file import fingerprint_sha256, parse_fingerprint
    from shaftprint.fleet._arguments import arguments_of
    from shaftprint.fleet.computing._identify import survey_of_job
    from shaftprint.store._history import document
    from shaftprint.store._job import Job
    from shaftprint.store._ledger import job
    from shaftprint.store._store import Store
    from shaftprint.survey._survey import judged


@click.command("report")
@click.argument("number", metavar="JOB", type=int)
@store_option
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="Folder for the results.")
@force_option
@no_progress_option
def command(number: int, url: str, output: Path, *, force: bool, no_progress: bool) -> None:
    """Write the report of one job, as identify does.

    The recording is identified once more, and what comes out is held against the fingerprint in the store.
    """
    with opened_store(url) as store:
        done = job(store, number)
        kept = _document(store, done)
    made_at = parse_fingerprint(kept, named=f"job {number}").created
    arguments = arguments_of(done.args, named=f"job {number}")
    rng = np.random.default_rng(arguments.seed)
    with output_folder(output, of="identify", force=force) as folder, progress(hidden=no_progress) as steps:
        survey = survey_of_job(arguments, tell=steps.begin, now=made_at, rng=rng)
        is_same = fingerprint_sha256(survey.fingerprint) == done.result
        survey = judged(survey, rng=rng, progress=steps)
        write_results(folder, Path(arguments.recording), survey, steps=steps)
    if not is_same:
        say("The fingerprint in the store is of the same files, but not equal bit by bit: another computer made it.")
    print_paths(output)


def _document(store: Store, done: Job) -> bytes:
    if done.result is None:
        raise StoreError(f"job {done.id}: expected one that is done, found it {done.state}; shaftprint work does it.")
    return document(store, done.result)
