"""A worker: processes for the arithmetic beside each other, and a heartbeat that keeps their jobs."""

import os
import secrets
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from shaftprint.arguments import refusing_none
from shaftprint.choices import WORK_LIMIT_S
from shaftprint.errors import DatabaseError, ShaftprintError, StoreError
from shaftprint.fleet._computer import Limits
from shaftprint.fleet._lane import Event, Lane
from shaftprint.store._job import Job
from shaftprint.store._store import Store

# Each beat may write the step of every job that has gone on.
_BEAT_S: Final = 5.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Worked:
    """What a worker has done."""

    done: int = 0
    """Jobs whose fingerprints it has put into the store."""
    refused: int = 0
    """Jobs that cannot be done."""
    died: int = 0
    """How often a process of the arithmetic died."""
    lost: int = 0
    """Jobs that another worker had taken by the time they were computed."""


@refusing_none(StoreError)
def work(
    store: Store,
    *,
    processes: int = 1,
    wait: bool = False,
    report: Callable[[Event], None] | None = None,
    stop: threading.Event | None = None,
    limit_s: float = WORK_LIMIT_S,
    most_file: int | None = None,
    forbidden: Callable[[Job], str | None] | None = None,
) -> Worked:
    """Do the jobs of a store until none is left, each in one of some processes.

    A process that dies takes its job along for a try only; when this one dies, others take its jobs when their leases
    have ended. Interrupted, it gives its jobs back.

    Parameters
    ----------
    store
        The store.
    processes
        How many recordings are identified at one time.
    wait
        Whether further jobs are waited for when none is left.
    report
        Is told what is done, from several threads.
    stop
        Ends the work when it is set.
    limit_s
        How long one recording may take [s].
    most_file
        Bytes of the largest file that may be written for one recording; None for as many as the disk has.
    forbidden
        Says why a job must not be done, or None; asked when it is begun and again before its result is kept.

    Raises
    ------
    DatabaseError
        If the database cannot be reached for minutes.
    """
    stop = threading.Event() if stop is None else stop
    counts = {"begun": 0, "done": 0, "refused": 0, "died": 0, "lost": 0}
    lock, failures = threading.Lock(), list[ShaftprintError]()

    def count(event: Event) -> None:
        with lock:
            counts[event.what] += 1
        if report is not None:
            report(event)

    def run(lane: Lane) -> None:
        try:
            lane.run()
        except ShaftprintError as error:
            failures.append(error)
            stop.set()

    name = f"{socket.gethostname()}:{os.getpid()}:{secrets.token_hex(4)}"
    lanes = [
        Lane(
            store,
            owner=f"{name}:{place}",
            wait=wait,
            stop=stop,
            report=count,
            forbidden=forbidden or _nothing,
            limits=Limits(longest_s=limit_s, most_file=most_file),
        )
        for place in range(processes)
    ]
    threads = [threading.Thread(target=run, args=(lane,), daemon=True) for lane in lanes]
    _run_with_heartbeat(lanes, threads, stop)
    if failures:
        raise failures[0]
    return Worked(**{what: number for what, number in counts.items() if what != "begun"})


def _nothing(job: Job) -> None:
    """Forbid nothing."""


def _run_with_heartbeat(lanes: list[Lane], threads: list[threading.Thread], stop: threading.Event) -> None:
    ended = threading.Event()
    heart = threading.Thread(target=_beat, args=(lanes, ended), daemon=True)
    for thread in (*threads, heart):
        thread.start()
    try:
        for thread in threads:
            # with an end to the waiting: Windows hears an interruption in between only
            while thread.is_alive():
                thread.join(0.5)
                if stop.is_set():
                    _kill(lanes)
    finally:
        stop.set()
        while any(thread.is_alive() for thread in threads):
            _kill(lanes)
            threads[0].join(0.2)
        ended.set()
        heart.join()


def _kill(lanes: list[Lane]) -> None:
    for lane in lanes:
        lane.computer.kill()


def _beat(lanes: list[Lane], ended: threading.Event) -> None:
    while not ended.wait(_BEAT_S):
        for lane in lanes:
            try:
                lane.renew()
            except DatabaseError:
                # busy for a while: the lease is long enough for the next beats
                continue
