"""What the commands have in common that work on the jobs of a store."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
from collections.abc import Callable, Iterator
from typing import Any

import click

from shaftprint.choices import WORK_LIMIT_S
from shaftprint.cli._terminal import answer, print_findings
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import progress
from shaftprint.late import late

with late():
    from shaftprint.fleet._lane import Event
    from shaftprint.fleet._work import Worked, work
    from shaftprint.store._job import Job, JobCounts
    from shaftprint.store._ledger import job_counts, jobs
    from shaftprint.store._store import Store


MOST_SHOWN = 20
"""Refusals that are printed; ``--json`` has all of them."""


def work_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--processes`` and ``--minutes``."""
    processes = click.option(
        "--processes",
        type=click.IntRange(min=0),
        default=lambda: os.cpu_count() or 1,
        show_default="one for each core",
        help="Recordings that are identified at one time, of 0.3 GB each.",
    )
    minutes = click.option(
        "--minutes",
        type=click.FloatRange(min=0.1),
        default=WORK_LIMIT_S / 60.0,
        show_default=True,
        help="How long one recording may take.",
    )
    return processes(minutes(command))


def work_here(store: Store, *, processes: int, wait: bool, minutes: float, hidden: bool) -> Worked:
    """Do the jobs of a store in processes of this computer, with a bar for all of them."""
    total, lock = job_counts(store).open, threading.Lock()
    with _ended_like_ctrl_c(), progress(hidden=hidden) as steps:
        steps.begin("Identifying", total=float(total) or None)

        def report(event: Event) -> None:
            with lock:
                if event.what in ("done", "refused"):
                    steps.advance(1.0)

        return work(store, processes=processes, wait=wait, report=report, limit_s=60.0 * minutes)


def say_what_was_done(store: Store, worked: Worked) -> None:
    """Print what a worker did."""
    give("worked", worked)
    died = f", {worked.died} times a process died" if worked.died else ""
    lost = f", {worked.lost} were done by others meanwhile" if worked.lost else ""
    counts = f"Jobs done here: {worked.done}; refused: {worked.refused}{died}{lost}"
    answer(f"{counts}. The fingerprints are in {store.name}.")


def say_refusals(refused: tuple[Job, ...]) -> None:
    """Print which recordings were refused, and why."""
    if not refused:
        return
    sentences = [_refusal(one) for one in refused[:MOST_SHOWN]]
    if len(refused) > MOST_SHOWN:
        sentences.append(f"and {len(refused) - MOST_SHOWN} more: shaftprint fleet status --json names all.")
    print_findings("Refused", sentences, is_answer=True)


def _refusal(job: Job) -> str:
    recording, sentence = recording_of(job), job.sentence or "nobody said why"
    # most sentences name their file
    return f"job {job.id}, {sentence}" if sentence.startswith(recording) else f"job {job.id}, {recording}: {sentence}"


def say_counts(store: Store, counts: JobCounts) -> None:
    """Print how many jobs are in which state."""
    give("counts", counts)
    answer(
        f"Jobs of {store.name}: {counts.all}; waiting: {counts.waiting}, running: {counts.running}, done: "
        f"{counts.done}, refused: {counts.refused}."
    )


def refused_jobs(store: Store) -> tuple[Job, ...]:
    """Return the jobs that were refused."""
    return jobs(store, states=("refused",))


def recording_of(job: Job) -> str:
    """Return the recording of a job as it is shown."""
    return str(job.args.get("recording", "-"))


@contextlib.contextmanager
def _ended_like_ctrl_c() -> Iterator[None]:
    """Let a request to end be an interruption: jobs that are not done are given back."""

    def interrupt(number: int, frame: object) -> None:
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
