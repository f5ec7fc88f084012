"""The ledger: which jobs were asked for, who works on them, and what has become of each.

The truth lies in the database, not in the processes that work: a job that is done has its fingerprint in the store, put
there in the same transaction, and a job whose worker is not heard of for the time of its lease is taken by another.
"""

from collections.abc import Collection, Sequence
from datetime import datetime, timedelta, tzinfo

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.store._add import NOTHING_STATED
from shaftprint.store._job import JOB_STATES, LEASE_S, Job, JobCounts, JobRequest
from shaftprint.store._nouns import Added, Line, Ship
from shaftprint.store._record import record_of
from shaftprint.store._stated import Stated
from shaftprint.store._store import Store
from shaftprint.store._text import LONGEST_TEXT

# In every verb ``now`` is the present time; by the clock that all workers share where it is not given.


@refusing_none(StoreError)
def enqueue(store: Store, requests: Sequence[JobRequest], *, now: datetime | None = None) -> tuple[Job, ...]:
    """Ask for jobs, and return each as it stands; one that was asked for before is not asked for twice."""
    keys = [one.key for one in requests]
    with store.database.reading() as connection:
        there = {job.key: job for job in store.database.ledger(connection).by_key(keys)}
    new = [one for one in requests if one.key not in there]
    if new:
        # alone: the next number is free for one writer only
        with store.database.writing() as connection:
            ledger = store.database.ledger(connection)
            ledger.enqueue(new, now=now or ledger.instant())
            there |= {job.key: job for job in ledger.by_key([one.key for one in new])}
    return tuple(there[key] for key in keys)


@refusing_none(StoreError)
def claim(
    store: Store, *, owner: str, version: str, now: datetime | None = None, lease_s: float = LEASE_S
) -> Job | None:
    """Take the first job that nobody has, or whose worker is not heard of; None where there is none.

    A job that three workers have begun without coming to its end is refused on the way.

    Parameters
    ----------
    store
        The store.
    owner
        Name of the worker, which no other has.
    version
        Version of the program; jobs of others are left alone.
    now
        The present time; by the clock that all workers share where it is not given.
    lease_s
        How long the job is kept without ``renew`` [s].
    """
    with store.database.writing(alone=False) as connection:
        ledger = store.database.ledger(connection)
        return ledger.claim(owner=owner, version=version, now=now or ledger.instant(), lease_s=lease_s)


@refusing_none(StoreError)
def renew(
    store: Store,
    job: Job,
    *,
    progress: str | None = None,
    now: datetime | None = None,
    lease_s: float = LEASE_S,
) -> bool:
    """Keep a job, and note the step that it is at; return whether this worker still has it."""
    with store.database.writing(alone=False) as connection:
        ledger = store.database.ledger(connection)
        until = (now or ledger.instant()) + timedelta(seconds=lease_s)
        return ledger.renew(job.id, owner=_owner(job), until=until, progress=progress)


def finish(
    store: Store,
    job: Job,
    document: bytes,
    *,
    now: datetime | None = None,
    stated: Stated = NOTHING_STATED,
    zone: tzinfo | None = None,
    only: Line | None = None,
) -> Added | None:
    """Put the fingerprint of a job into the store and end the job, both or neither.

    Parameters
    ----------
    store
        The store.
    job
        The job, as ``claim`` gave it.
    document
        Content of the fingerprint's file.
    now
        The present time; by the clock that all workers share where it is not given.
    stated, zone
        As for ``add``.
    only
        The line for which the job was asked, and no other; None where the fingerprint says it by itself.

    Returns
    -------
    added
        What became of the fingerprint; None where another worker has the job by now: then nothing is put in.

    Raises
    ------
    DatabaseError
        If the database cannot take it now; the job is as it was.
    StoreError
        If the fingerprint cannot be kept, whoever tries: a reason to refuse the job.
    """
    named = str(job.args.get("recording", f"job {job.id}"))
    record = record_of(document, stated, zone=zone, named=named, now=now)
    ship = Ship(name=record.ship.name, imo_number=record.ship.imo_number, class_name=record.ship.class_name)
    with store.database.writing() as connection:
        ledger = store.database.ledger(connection)
        when = now or ledger.instant()
        if ledger.held(job.id, owner=_owner(job)) is None:
            return None
        (added,) = store.database.writer(connection).put([(record, ship, when)], newest_names=True, only=only)
        ledger.end(job.id, owner=_owner(job), now=when, result=added.sha256)
    return added


@refusing_none(StoreError)
def refuse(store: Store, job: Job, sentence: str, *, now: datetime | None = None) -> bool:
    """End a job that cannot be done, and keep why; return whether this worker still had it."""
    with store.database.writing(alone=False) as connection:
        ledger = store.database.ledger(connection)
        # what PostgreSQL does not keep may come from a file
        plain = sentence.replace("\0", "").encode(errors="replace").decode()[:LONGEST_TEXT]
        return ledger.end(job.id, owner=_owner(job), now=now or ledger.instant(), sentence=plain)


@refusing_none(StoreError)
def give_back(store: Store, job: Job, *, died: bool = False, now: datetime | None = None) -> bool:
    """Let a job wait for another worker; return whether this worker still had it.

    Parameters
    ----------
    store, job, now
        As for ``renew``.
    died
        Whether the process that worked on it has died: that counts as a try, and the third one refuses the job.
    """
    with store.database.writing(alone=False) as connection:
        ledger = store.database.ledger(connection)
        return ledger.give_back(job.id, owner=_owner(job), now=now or ledger.instant(), died=died)


@refusing_none(StoreError)
def jobs(
    store: Store, *, states: Collection[str] = JOB_STATES, after: int = 0, most: int | None = None
) -> tuple[Job, ...]:
    """Return jobs in some states in the order of their numbers, at most so many above a number.

    Raises
    ------
    StoreError
        If a state is unknown.
    """
    unknown = sorted(set(states) - set(JOB_STATES))
    if unknown:
        raise StoreError(f"states: expected some of {', '.join(JOB_STATES)}, found {unknown[0]!r}.")
    with store.database.reading() as connection:
        return store.database.ledger(connection).all(states, after=after, most=most)


@refusing_none(StoreError)
def job(store: Store, job_id: int) -> Job:
    """Return a job by its number.

    Raises
    ------
    StoreError
        If there is none.
    """
    with store.database.reading() as connection:
        found = store.database.ledger(connection).by_id(job_id)
    if found is None:
        raise StoreError(f"{store.name}: expected a job with the number {job_id}, found none; see fleet status.")
    return found


def job_counts(store: Store, *, version: str | None = None) -> JobCounts:
    """Return how many jobs are in which state; those of one version of the program where it is given."""
    with store.database.reading() as connection:
        return JobCounts(**store.database.ledger(connection).counts(version=version))


def has_open_jobs(store: Store, *, version: str) -> bool:
    """Return whether a job is still to be done by a version of the program, whoever has it."""
    with store.database.reading() as connection:
        return store.database.ledger(connection).is_open(version=version)


@refusing_none(StoreError)
def retry(store: Store, refused: Sequence[Job] | None = None) -> int:
    """Let refused jobs wait again, all where none are given; return how many."""
    ids = None if refused is None else [one.id for one in refused]
    with store.database.writing(alone=False) as connection:
        return store.database.ledger(connection).retry(ids)


def _owner(job: Job) -> str:
    if job.owner is None:
        raise StoreError(f"job {job.id}: expected a job that a worker has claimed, found one that nobody has.")
    return job.owner
