"""Jobs of the ledger as records of an export: what was asked for, and what has become of it."""

import json
import re
from collections.abc import Mapping
from typing import Any

from shaftprint.errors import StoreError
from shaftprint.store._fields import moment_of, short_text
from shaftprint.store._job import JOB_STATES, MOST_TRIES, Job
from shaftprint.store._stated import utc_iso
from shaftprint.store._text import LONGEST_TEXT

_SHA256 = re.compile(r"[0-9a-f]{64}")


def job_content(job: Job) -> dict[str, Any]:
    """Return a job as a record; one that a worker has now waits, and has not been tried by that."""
    is_running = job.state == "running"
    return {
        "kind": "job",
        "key": job.key,
        "what": job.kind,
        # as text: names of files may hold what is no letter
        "args": json.dumps(job.args, sort_keys=True),
        "version": job.version,
        "state": "waiting" if is_running else job.state,
        "tries": job.tries - is_running,
        "enqueued_at": utc_iso(job.enqueued_at),
        "ended_at": None if job.ended_at is None else utc_iso(job.ended_at),
        "owner": job.owner,
        "sentence": job.sentence,
        "result": job.result,
    }


def job_of_content(content: Mapping[str, Any]) -> Job:
    """Return the job of a record; its number is that of the store into which it is put.

    Raises StoreError if it is in no state that a job of an export may have; KeyError, TypeError, ValueError if a field
    is missing or of another kind.
    """
    state, args, tries, result = content["state"], _args(content["args"]), content["tries"], content["result"]
    if type(tries) is not int:
        raise TypeError("tries")
    if state not in JOB_STATES or state == "running":
        raise StoreError(f"expected a job that is waiting, done or refused, found {str(state)[:40]!r}")
    if not 0 <= tries <= MOST_TRIES:
        raise StoreError(f"expected a job that was tried at most {MOST_TRIES} times, found {tries}")
    has = {"an end": content["ended_at"], "a sentence": content["sentence"], "a result": result}
    belongs = {"an end": state != "waiting", "a sentence": state == "refused", "a result": state == "done"}
    for what, there in has.items():
        if (there is not None) != belongs[what]:
            raise StoreError(f"expected {what} of a job exactly where it belongs to its state, found it {state}")
    if result is not None and not _SHA256.fullmatch(result):
        raise StoreError(f"expected the SHA-256 of a fingerprint, found {result[:40]!r}")
    return Job(
        id=0,
        key=short_text(content["key"], "key of a job"),
        kind=short_text(content["what"], "kind of job"),
        args=args,
        version=short_text(content["version"], "version"),
        state=state,
        tries=tries,
        enqueued_at=moment_of(content["enqueued_at"]),
        ended_at=None if content["ended_at"] is None else moment_of(content["ended_at"]),
        owner=None if content["owner"] is None else short_text(content["owner"], "name of a worker"),
        sentence=None if state != "refused" else short_text(content["sentence"], "sentence", longest=LONGEST_TEXT),
        result=result,
    )


def _args(text: str) -> dict[str, Any]:
    try:
        args = json.loads(text)
    except RecursionError:
        args = None
    if not isinstance(args, dict):
        raise TypeError("args")
    return args
