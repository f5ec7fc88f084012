"""The ledger of jobs: a job has one worker, is done exactly when its fingerprint is there, and is never lost."""

import os
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime, timedelta

import pytest
import sqlalchemy as sa
from benchmarks.store_documents import IMO_NUMBER, document

from shaftprint.errors import RecordingError, StoreError
from shaftprint.store import (
    JobRequest,
    check,
    claim,
    enqueue,
    finish,
    give_back,
    history,
    job,
    job_counts,
    jobs,
    open_store,
    refuse,
    renew,
    retry,
)
from shaftprint.store import document as kept_document
from shaftprint.store._document import document_sha256
from shaftprint.store._hashes import file_hashes
from shaftprint.store._job import Job
from shaftprint.store._ledger import has_open_jobs
from shaftprint.store._stated import Stated

VERSION = "1.0"
BEGIN = datetime(2026, 11, 24, 12, 0, tzinfo=UTC)
PORT = {"name": "Meander", "imo_number": IMO_NUMBER, "class_name": None, "line": "port"}


def at(seconds):
    return BEGIN + timedelta(seconds=seconds)


def requests(*names, version=VERSION):
    return [JobRequest(key=name, args={"recording": f"{name}.nc"}, version=version) for name in names]


def claimed(store, *, owner="a", seconds=0.0, **options):
    return claim(store, owner=owner, version=VERSION, now=at(seconds), **options)


def test_a_job_is_done_when_its_fingerprint_is_there(store):
    (asked,) = enqueue(store, requests("one"), now=at(0))
    assert (asked.state, asked.tries, asked.enqueued_at) == ("waiting", 0, at(0))
    begun = claimed(store)
    assert (begun.state, begun.tries, begun.lease_until) == ("running", 1, at(60))
    content = document(ship=PORT)
    added = finish(store, begun, content, now=at(5))
    assert (added.outcome, added.sha256) == ("added", document_sha256(content))
    done = job(store, begun.id)
    assert (done.state, done.result, done.ended_at, done.lease_until) == ("done", added.sha256, at(5), None)
    assert kept_document(store, done.result) == content
    assert not has_open_jobs(store, version=VERSION)
    assert check(store) == ()


def test_what_was_asked_for_before_is_not_done_again(store):
    enqueue(store, requests("one", "two"))
    finish(store, claimed(store), document(ship=PORT))
    refuse(store, claimed(store), "no torque in it")
    again = enqueue(store, requests("two", "three", "one", "three"))
    assert [(one.id, one.state) for one in again] == [(2, "refused"), (3, "waiting"), (1, "done"), (3, "waiting")]
    assert again[0].sentence == "no torque in it"
    assert job_counts(store).all == 3


def test_no_job_has_two_workers(store, url):
    enqueue(store, requests(*(f"job {place:02}" for place in range(24))))

    def take(owner):
        with open_store(url) as opened:
            taken = []
            while (one := claim(opened, owner=owner, version=VERSION)) is not None:
                taken.append(one.id)
            return taken

    with ThreadPoolExecutor(4) as pool:
        taken = [number for some in pool.map(take, "abcd") for number in some]
    assert sorted(taken) == list(range(1, 25))


def test_jobs_are_begun_in_the_order_in_which_they_were_asked_for(store):
    enqueue(store, requests("z", "y", "x"))
    assert [claimed(store).key for _ in range(3)] == ["z", "y", "x"]
    assert claimed(store) is None


def test_a_worker_that_is_not_heard_of_loses_its_job(store):
    enqueue(store, requests("one"))
    lost = claimed(store, owner="dead")
    assert claimed(store, owner="b", seconds=59) is None
    taken = claimed(store, owner="b", seconds=61)
    assert (taken.id, taken.tries, taken.owner) == (lost.id, 2, "b")
    # the first one was only slow: what it says now counts no more
    assert not renew(store, lost, now=at(62))
    assert not refuse(store, lost, "too late", now=at(62))
    assert not give_back(store, lost, now=at(62))
    assert finish(store, lost, document(ship=PORT, k_q=0.04), now=at(62)) is None
    added = finish(store, taken, document(ship=PORT, k_q=0.05), now=at(63))
    assert [one.fingerprint.sha256 for one in history(store, "Meander").entries] == [added.sha256]


def test_a_worker_that_is_heard_of_keeps_its_job(store):
    enqueue(store, requests("one"))
    begun = claimed(store)
    assert renew(store, begun, progress="Fitting", now=at(50))
    assert claimed(store, owner="b", seconds=100) is None
    assert (job(store, begun.id).progress, job(store, begun.id).lease_until) == ("Fitting", at(110))


def test_a_job_on_which_three_workers_died_is_refused(store):
    enqueue(store, requests("bad", "good"))
    for place in range(3):
        assert claimed(store, owner=f"dead {place}", seconds=100 * place).key == "bad"
    assert claimed(store, owner="d", seconds=300).key == "good"
    (refused,) = jobs(store, states=("refused",))
    assert refused.key == "bad"
    assert refused.sentence.startswith("the worker died three times on this recording")
    assert retry(store) == 1
    assert (job(store, refused.id).state, job(store, refused.id).tries) == ("waiting", 0)


def test_a_job_that_was_given_back_counts_as_tried_only_where_its_process_died(store):
    enqueue(store, requests("one"))
    for _ in range(5):
        give_back(store, claimed(store))
    assert job(store, 1).tries == 0
    for _ in range(3):
        assert job(store, 1).state == "waiting"
        give_back(store, claimed(store), died=True)
    assert job(store, 1).state == "refused"


def test_jobs_of_another_version_are_left_alone(store):
    enqueue(store, requests("older", version="0.9"))
    assert claimed(store) is None
    assert not has_open_jobs(store, version=VERSION)
    assert (job_counts(store).waiting, job_counts(store, version=VERSION).waiting) == (1, 0)


def test_a_fingerprint_that_cannot_be_kept_leaves_its_job_to_be_refused(store):
    enqueue(store, requests("one"))
    begun = claimed(store)
    with pytest.raises(StoreError, match=r"one\.nc: expected the name of its ship, found none"):
        finish(store, begun, document(ship=None), stated=Stated(line="port"))
    assert job(store, begun.id).state == "running"
    assert refuse(store, begun, "nobody says which ship\0\ud800")
    assert job(store, begun.id).sentence == "nobody says which ship?"


def test_a_job_cannot_be_done_without_a_fingerprint(store):
    """The database itself refuses it."""
    enqueue(store, requests("one"))
    with pytest.raises(StoreError), store.database.writing() as connection:
        connection.execute(sa.text("UPDATE job SET state = 'done', result = 'nowhere'"))
    assert job(store, 1).result is None


def test_what_is_no_job_is_refused(store):
    with pytest.raises(StoreError, match="expected a job with the number 7, found none"):
        job(store, 7)
    with pytest.raises(StoreError, match="expected some of waiting, running, done, refused, found 'over'"):
        jobs(store, states=("over",))
    (waiting,) = enqueue(store, requests("one"))
    with pytest.raises(StoreError, match="expected a job that a worker has claimed"):
        renew(store, waiting)
    assert isinstance(waiting, Job)


# ---- files ----


@pytest.fixture
def old_file(tmp_path):
    """A file that was written an hour ago."""
    path = tmp_path / "a.nc"

    def write(content, hours_ago=1.0):
        path.write_bytes(content)
        os.utime(path, ns=(0, int(1e9 * (BEGIN.timestamp() - 3600.0 * hours_ago))))
        return path

    return write


# by sha256sum
ABC = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
EMPTY = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"


def test_a_file_that_has_not_changed_is_not_read_again(store, old_file):
    path = old_file(b"abc")
    assert file_hashes(store, [path], now=BEGIN) == (ABC,)
    # the same length, time and inode: only who reads it sees the difference
    old_file(b"xyz")
    assert file_hashes(store, [path, path], now=BEGIN) == (ABC, ABC)
    old_file(b"", hours_ago=1.0)
    assert file_hashes(store, [path], now=BEGIN) == (EMPTY,)
    old_file(b"abc", hours_ago=0.5)
    assert file_hashes(store, [path], now=BEGIN) == (ABC,)


def test_a_file_that_was_just_written_is_read_again(store, old_file):
    path = old_file(b"xyz", hours_ago=0.0)
    file_hashes(store, [path], now=BEGIN)
    old_file(b"abc", hours_ago=0.0)
    assert file_hashes(store, [path], now=BEGIN) == (ABC,)


def test_a_file_that_is_not_there_is_named(store, tmp_path):
    with pytest.raises(RecordingError, match=r"gone\.nc: expected a recording, but it cannot be read: No such file"):
        file_hashes(store, [tmp_path / "gone.nc"], now=BEGIN)
