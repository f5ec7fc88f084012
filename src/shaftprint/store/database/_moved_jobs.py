"""Jobs of another store: those that are not there yet get rows, and none is done without its fingerprint."""

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sqlalchemy as sa

from shaftprint.store._job import Job
from shaftprint.store.database._ledger import Ledger, parts
from shaftprint.store.database._tables import FINGERPRINT, JOB


def put_jobs(ledger: Ledger, jobs: Sequence[Job]) -> int:
    """Put in jobs of another store in their order, and return how many were not there.

    A job that is there stays as it is. One that is done and whose fingerprint is not here is refused.
    """
    there = {one.key for one in ledger.by_key([one.key for one in jobs])}
    new = {one.key: one for one in jobs if one.key not in there}
    kept: set[str] = set()
    for some in parts([one.result for one in new.values() if one.result is not None]):
        asked = sa.select(FINGERPRINT.c.sha256).where(FINGERPRINT.c.sha256.in_(some))
        kept.update(ledger.connection.execute(asked).scalars())
    last = ledger.connection.execute(sa.select(sa.func.max(JOB.c.id))).scalar() or 0
    rows = [
        _row(one if one.result is None or one.result in kept else _refused(one, one.result), last + place)
        for place, one in enumerate(new.values(), start=1)
    ]
    if rows:
        ledger.connection.execute(JOB.insert(), rows)
    return len(rows)


def _refused(job: Job, result: str) -> Job:
    sentence = (
        f"its fingerprint {result[:12]} is in neither the export with which the job came nor this store; "
        "shaftprint fleet retry identifies the recording again"
    )
    return replace(job, state="refused", result=None, sentence=sentence)


def _row(job: Job, job_id: int) -> dict[str, Any]:
    row = {name: getattr(job, name) for name in Job.__slots__}
    return row | {"id": job_id, "args": json.dumps(job.args, sort_keys=True)}
