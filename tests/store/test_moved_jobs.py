"""Jobs in an export: what was done or refused stays so, what somebody works on waits in the other store."""

import json
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from benchmarks.store_documents import IMO_NUMBER, document
from tests.store.test_round_trip import changed, moved, resealed

from shaftprint.errors import StoreError
from shaftprint.store import (
    JobRequest,
    check,
    claim,
    create_store,
    enqueue,
    export_store,
    finish,
    give_back,
    import_store,
    job_counts,
    jobs,
    newest,
    open_store,
    refuse,
    retry,
)
from shaftprint.store._document import document_sha256

BEGIN = datetime(2026, 11, 24, 12, 0, tzinfo=UTC)
SENTENCE = "day.nc: expected 0.2 s of the campaign, found «nothing» \N{SNOWMAN}\nlook at it"
DOCUMENT = document(ship={"name": "Meander", "imo_number": IMO_NUMBER, "class_name": None, "line": "port"})


def at(seconds):
    return BEGIN + timedelta(seconds=seconds)


def begun(store, seconds, version="1.0"):
    return claim(store, owner=f"worker {seconds}", version=version, now=at(seconds))


def fill(store):
    """Put in one job of each kind: done, refused, given back after a death, running, waiting for another version."""
    # a file may be called by what is no letter
    names = ("done", "refused", "died", "running", "w\udce4iting")
    asked = [JobRequest(key=f"{place:064x}", args={"recording": name, "seed": place}, version="1.0")
             for place, name in enumerate(names)]  # fmt: skip
    later = replace(asked[-1], key="other", version="2.0", args={"nested": {"a": [1.5, None]}})
    enqueue(store, [*asked, later], now=at(0))
    finish(store, begun(store, 1), DOCUMENT, now=at(10))
    refuse(store, begun(store, 2), SENTENCE, now=at(11))
    died = begun(store, 3)
    # while that one is held another is begun
    running = begun(store, 4)
    give_back(store, died, died=True, now=at(12))
    return running


@pytest.fixture
def filled(file_store):
    fill(file_store)
    return file_store


def states(store):
    return [(one.state, one.tries) for one in jobs(store)]


def test_jobs_keep_what_became_of_them_and_one_that_runs_waits_again(filled, tmp_path):
    assert states(filled) == [
        ("done", 1),
        ("refused", 1),
        ("waiting", 1),
        ("running", 1),
        ("waiting", 0),
        ("waiting", 0),
    ]
    export_store(filled, tmp_path / "one.jsonl")
    with create_store(str(tmp_path / "other.db")) as other:
        imported = import_store(other, tmp_path / "one.jsonl")
        assert (imported.fingerprints, imported.jobs) == (1, 6)
        before, after = jobs(filled), jobs(other)
        running = before[3]
        # its worker goes on in the other store, and nobody has tried it here
        waits = replace(running, state="waiting", tries=0, lease_until=None, progress=None)
        assert after == (*before[:3], waits, *before[4:])
        assert (after[0].result, after[1].sentence) == (document_sha256(DOCUMENT), SENTENCE)
        assert check(other) == ()
        # the ledger goes on where it was: the one that died once has two more tries
        assert [begun(other, seconds).args["recording"] for seconds in (20, 21, 22)] == [
            "died",
            "running",
            "w\udce4iting",
        ]
        assert begun(other, 23) is None
        assert begun(other, 23, version="2.0").args == {"nested": {"a": [1.5, None]}}


def test_a_job_that_is_there_stays_as_it_is(filled, tmp_path):
    export_store(filled, tmp_path / "one.jsonl")
    with create_store(str(tmp_path / "other.db")) as other:
        own = [JobRequest(key=key, args={}, version="1.0") for key in ("own", f"{1:064x}")]
        enqueue(other, own, now=at(0))
        assert import_store(other, tmp_path / "one.jsonl").jobs == 5
        assert import_store(other, tmp_path / "one.jsonl").jobs == 0
        assert [one.id for one in jobs(other)] == list(range(1, 8))
        assert jobs(other)[1].state == "waiting"
        assert job_counts(other).done == 1


def test_a_done_job_without_its_fingerprint_is_refused_and_can_be_asked_for_again(filled, tmp_path):
    export_store(filled, tmp_path / "one.jsonl")
    *lines, _ = (tmp_path / "one.jsonl").read_bytes().splitlines(keepends=True)
    left = [line for line in lines if json.loads(line)["kind"] != "fingerprint"]
    (tmp_path / "two.jsonl").write_bytes(resealed(left))
    with create_store(str(tmp_path / "other.db")) as other:
        assert import_store(other, tmp_path / "two.jsonl").jobs == 6
        refused = jobs(other)[0]
        assert (refused.state, refused.result, refused.ended_at) == ("refused", None, at(10))
        assert refused.sentence.startswith(f"its fingerprint {document_sha256(DOCUMENT)[:12]} is in neither the export")
        assert retry(other, [refused]) == 1
        assert begun(other, 20).args["recording"] == "done"
    # in a store that has the fingerprint it is done
    with create_store(str(tmp_path / "third.db")) as third:
        import_store(third, tmp_path / "one.jsonl")
        assert import_store(third, tmp_path / "two.jsonl").jobs == 0
        assert jobs(third)[0].state == "done"


def test_a_store_with_jobs_moves_to_another_file_and_is_the_same(filled, tmp_path):
    first, second = moved(filled, str(tmp_path / "other.db"), tmp_path / "one.jsonl")
    assert first == second
    assert [json.loads(line)["kind"] for line in first.splitlines()].count("job") == 6


@pytest.mark.slow
def test_a_store_with_jobs_moves_to_the_server_and_back_and_is_the_same(filled, server, tmp_path):
    url = server.new_database()
    first, second = moved(filled, url, tmp_path / "one.jsonl")
    with open_store(url) as store:
        third, fourth = moved(store, str(tmp_path / "back.db"), tmp_path / "two.jsonl")
        there = jobs(store)
    assert first == second == third == fourth
    with open_store(str(tmp_path / "back.db")) as back:
        assert jobs(back) == there


@pytest.mark.slow
def test_jobs_that_run_on_the_server_wait_in_a_file(server, tmp_path):
    with create_store(server.new_database()) as store:
        fill(store)
        export_store(store, tmp_path / "one.jsonl")
    with create_store(str(tmp_path / "other.db")) as other:
        import_store(other, tmp_path / "one.jsonl")
        assert states(other) == [
            ("done", 1),
            ("refused", 1),
            ("waiting", 1),
            ("waiting", 0),
            ("waiting", 0),
            ("waiting", 0),
        ]


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"state": "running"}, "expected a job that is waiting, done or refused, found 'running'"),
        ({"state": "waiting"}, "expected an end of a job exactly where it belongs to its state, found it waiting"),
        ({"result": None}, "expected a result of a job exactly where it belongs"),
        ({"sentence": "no"}, "expected a sentence of a job exactly where it belongs"),
        ({"result": "../../etc"}, "expected the SHA-256 of a fingerprint, found '../../etc'"),
        ({"tries": 4}, "expected a job that was tried at most 3 times, found 4"),
        ({"tries": True}, "a field that is missing or of another kind"),
        ({"args": "[1]"}, "a field that is missing or of another kind"),
        ({"args": "[" * 100_000}, "a field that is missing or of another kind"),
        ({"args": {"a": 1}}, "a field that is missing or of another kind"),
        ({"key": "a\0b"}, "expected a key of a job of letters"),
        ({"version": ""}, "expected a version of 1 to 200 letters"),
        ({"enqueued_at": "2026-01-01T00:00:00"}, "a field that is missing or of another kind"),
        ({"ended_at": 7}, "a field that is missing or of another kind"),
        ({"owner": 7}, "a field that is missing or of another kind"),
    ],
)
def test_a_forged_job_puts_nothing_in(filled, tmp_path, fields, words):
    export_store(filled, tmp_path / "one.jsonl")
    *lines, _ = (tmp_path / "one.jsonl").read_bytes().splitlines(keepends=True)
    place = next(at for at, line in enumerate(lines) if json.loads(line)["kind"] == "job")
    lines[place] = changed(lines[place], **fields)
    (tmp_path / "two.jsonl").write_bytes(resealed(lines))
    with create_store(str(tmp_path / "other.db")) as other:
        with pytest.raises(StoreError, match=words):
            import_store(other, tmp_path / "two.jsonl")
        assert newest(other) == ()
        assert jobs(other) == ()
