"""Rows of jobs: put in, claimed, renewed, ended. Who calls it holds a connection in a transaction."""

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from datetime import UTC, datetime, timedelta
from typing import Any, Final, TypeVar

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._job import JOB_STATES, MOST_TRIES, Job, JobRequest
from shaftprint.store.database._tables import JOB, OPEN_JOB

DIED: Final = (
    "the worker died three times on this recording: its process was killed, ran out of memory or crashed; try it "
    "alone with shaftprint identify, then shaftprint fleet retry"
)
_AT_A_TIME: Final = 500
_NOW: Final = sa.bindparam("now", type_=JOB.c.lease_until.type)
# Made once: to make it for every job costs as much as to ask it.
_FREE: Final = (
    sa.select(JOB)
    .where(
        OPEN_JOB,
        JOB.c.version == sa.bindparam("version_of_worker"),
        sa.or_(JOB.c.state == "waiting", sa.and_(JOB.c.state == "running", JOB.c.lease_until < _NOW)),
    )
    .order_by(JOB.c.id)
    .limit(1)
    .with_for_update(skip_locked=True)
)
_T = TypeVar("_T")


class Ledger:
    """Jobs through one connection."""

    def __init__(self, connection: sa.Connection) -> None:
        self.connection = connection

    def instant(self) -> datetime:
        """Return the present time by the clock that all workers share: the server's, or this computer's for a file.

        By clocks of several computers that differ a worker would take jobs that others still have.
        """
        if self.connection.dialect.name == "sqlite":
            return datetime.now(UTC)
        instant: datetime = self.connection.execute(sa.select(sa.func.clock_timestamp())).scalar_one()
        return instant

    def enqueue(self, requests: Sequence[JobRequest], *, now: datetime) -> None:
        """Put in jobs that are not there yet."""
        there = {job.key for job in self.by_key([one.key for one in requests])}
        new = {one.key: one for one in requests if one.key not in there}
        last = self.connection.execute(sa.select(sa.func.max(JOB.c.id))).scalar() or 0
        rows = [_row(one, last + place, now) for place, one in enumerate(new.values(), start=1)]
        if rows:
            self.connection.execute(JOB.insert(), rows)

    def by_key(self, keys: Sequence[str]) -> Iterator[Job]:
        """Give the jobs of some keys, in no order."""
        for some in parts(keys):
            yield from map(_job, self.connection.execute(sa.select(JOB).where(JOB.c.key.in_(some))))

    def by_id(self, job_id: int) -> Job | None:
        """Return a job by its number; None if there is none."""
        row = self.connection.execute(sa.select(JOB).where(JOB.c.id == job_id)).first()
        return None if row is None else _job(row)

    def all(self, states: Collection[str], *, after: int, most: int | None) -> tuple[Job, ...]:
        """Return jobs in some states with numbers above one, in the order of their numbers."""
        asked = sa.select(JOB).where(JOB.c.id > after).order_by(JOB.c.id).limit(most)
        if set(states) != set(JOB_STATES):
            asked = asked.where(JOB.c.state.in_(sorted(states)))
        return tuple(map(_job, self.connection.execute(asked)))

    def counts(self, *, version: str | None) -> dict[str, int]:
        """Return how many jobs are in which state."""
        asked = sa.select(JOB.c.state, sa.func.count().label("jobs")).group_by(JOB.c.state)
        if version is not None:
            asked = asked.where(JOB.c.version == version)
        return {row.state: row.jobs for row in self.connection.execute(asked)}

    def is_open(self, *, version: str) -> bool:
        """Return whether a job is still to be done by this version of the program."""
        asked = sa.select(JOB.c.id).where(OPEN_JOB, JOB.c.version == version).limit(1)
        return self.connection.execute(asked).first() is not None

    def claim(self, *, owner: str, version: str, now: datetime, lease_s: float) -> Job | None:
        """Give a worker the first job that nobody has, or whose worker is not heard of; None where there is none."""
        asked = {"version_of_worker": version, "now": now}
        while (row := self.connection.execute(_FREE, asked).first()) is not None:
            if row.tries < MOST_TRIES:
                values = {
                    "state": "running",
                    "owner": owner,
                    "lease_until": now + timedelta(seconds=lease_s),
                    "tries": row.tries + 1,
                    "progress": None,
                }
                self._change(row.id, values)
                return _job(row, values)
            self._change(row.id, _ended("refused", now, sentence=DIED))
        return None

    def renew(self, job_id: int, *, owner: str, until: datetime, progress: str | None) -> bool:
        """Let a worker keep its job; return whether it still has it."""
        return self._change(job_id, {"lease_until": until, "progress": progress}, owner=owner)

    def end(
        self,
        job_id: int,
        *,
        owner: str,
        now: datetime,
        sentence: str | None = None,
        result: str | None = None,
    ) -> bool:
        """End a job, done where it has a result, else refused; return whether its worker still had it."""
        state = "refused" if result is None else "done"
        return self._change(job_id, _ended(state, now, sentence=sentence, result=result), owner=owner)

    def give_back(self, job_id: int, *, owner: str, now: datetime, died: bool) -> bool:
        """Let a job wait for another worker, or refuse it when too many died; return whether its worker still had it.

        One that was not worked on to its end by intent does not count as tried.
        """
        job = self.held(job_id, owner=owner)
        if job is None:
            return False
        if died and job.tries >= MOST_TRIES:
            return self.end(job_id, owner=owner, now=now, sentence=DIED)
        values = {"state": "waiting", "lease_until": None, "progress": None, "tries": job.tries - (not died)}
        return self._change(job_id, values, owner=owner)

    def held(self, job_id: int, *, owner: str) -> Job | None:
        """Return a job if a worker has it, and let nobody else take it until the transaction ends."""
        asked = sa.select(JOB).where(JOB.c.id == job_id, JOB.c.owner == owner, JOB.c.state == "running")
        row = self.connection.execute(asked.with_for_update()).first()
        return None if row is None else _job(row)

    def retry(self, ids: Sequence[int] | None) -> int:
        """Let refused jobs wait again, all of them or those with some numbers; return how many."""
        values = {
            "state": "waiting",
            "tries": 0,
            "sentence": None,
            "ended_at": None,
            "owner": None,
            "lease_until": None,
            "progress": None,
        }
        asked = JOB.update().where(JOB.c.state == "refused")
        if ids is None:
            return self.connection.execute(asked.values(values)).rowcount
        changed = (self.connection.execute(asked.where(JOB.c.id.in_(some)).values(values)) for some in parts(ids))
        return sum(one.rowcount for one in changed)

    def _change(self, job_id: int, values: Mapping[str, Any], *, owner: str | None = None) -> bool:
        asked = JOB.update().where(JOB.c.id == job_id)
        if owner is not None:
            asked = asked.where(JOB.c.owner == owner, JOB.c.state == "running")
        return self.connection.execute(asked.values(**values)).rowcount == 1


def parts(values: Sequence[_T]) -> Iterator[Sequence[_T]]:
    """Give values in parts that a query takes."""
    return (values[start : start + _AT_A_TIME] for start in range(0, len(values), _AT_A_TIME))


def _ended(state: str, now: datetime, *, sentence: str | None = None, result: str | None = None) -> dict[str, Any]:
    return {
        "state": state,
        "ended_at": now,
        "lease_until": None,
        "progress": None,
        "sentence": sentence,
        "result": result,
    }


def _row(request: JobRequest, job_id: int, now: datetime) -> dict[str, Any]:
    return {
        "id": job_id,
        "key": request.key,
        "kind": request.kind,
        "args": json.dumps(request.args, sort_keys=True),
        "version": request.version,
        "state": "waiting",
        "tries": 0,
        "enqueued_at": now,
    }


def _job(row: Any, changed: Mapping[str, Any] | None = None) -> Job:
    """Return the job of a row, with what was changed since it was read."""
    values = dict(row._mapping) | dict(changed or {})
    try:
        args = json.loads(values["args"])
    except (TypeError, ValueError):
        args = None
    if not isinstance(args, dict) or values["state"] not in JOB_STATES:
        raise StoreError(f"expected a job, found a damaged row of job {values['id']}; shaftprint store check.")
    return Job(**(values | {"args": args}))
