"""Times at which nothing can have been done are refused wherever they come in; an event is withdrawn, not deleted."""

import hashlib
import json
import sqlite3
from datetime import UTC, datetime

import pytest
from benchmarks.store_documents import IMO_NUMBER

from shaftprint.errors import DatabaseError, StoreError
from shaftprint.store import check, create_store, export_store, history, import_store, record_event
from shaftprint.store._event import withdraw_event
from shaftprint.store._line_history import line_history
from shaftprint.store._nouns import Ship
from shaftprint.store._stated import Stated

EXTREME = (
    "0001-01-01T00:00:00+14:00",
    "9999-12-31T23:59:00-14:00",
    "9999-12-31T23:59:00+00:00",
    "1949-12-31T00:00:00Z",
)
AT = datetime(2026, 5, 1, tzinfo=UTC)


@pytest.mark.parametrize("text", EXTREME)
def test_an_extreme_time_is_refused_and_nothing_is_damaged(file_store, put, text):
    put(file_store)
    moment = datetime.fromisoformat(text)
    with pytest.raises(StoreError, match="expected a time from 1950-01-01") as refusal:
        record_event(file_store, "Meander", "docking", at=moment)
    assert not isinstance(refusal.value, DatabaseError)
    with pytest.raises(StoreError, match="expected a time from 1950-01-01"):
        put(file_store, recording="01" * 32, tested_at=text)
    with pytest.raises(StoreError, match="expected a time from 1950-01-01"):
        put(file_store, recording="01" * 32, tested_at=None, stated=Stated(tested_at=moment))
    if not text.startswith("1949"):
        with pytest.raises(StoreError, match="created: expected a time"):
            put(file_store, recording="02" * 32, created=text)
    assert check(file_store) == ()


@pytest.mark.parametrize("text", EXTREME[1:])
def test_an_export_with_an_extreme_time_is_refused(file_store, put, tmp_path, text):
    put(file_store)
    record_event(file_store, "Meander", "docking", at=AT)
    path = tmp_path / "x.jsonl"
    export_store(file_store, path)
    # as an earlier version would have written it
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    (event,) = [one for one in lines if one["kind"] == "event"]
    event["at"] = text
    _write(path, lines)
    with create_store(str(tmp_path / "new.db")) as new, pytest.raises(StoreError, match="expected a time"):
        import_store(new, path)


def _write(path, lines):
    """Write an export with another content and the end that belongs to it."""
    body = b"".join(json.dumps(one).encode() + b"\n" for one in lines[:-1])
    end = lines[-1] | {"sha256": hashlib.sha256(body).hexdigest()}
    path.write_bytes(body + json.dumps(end).encode() + b"\n")


def test_what_was_withdrawn_stays_in_the_record_and_counts_no_more(store, put, tmp_path):
    put(store, recording="01" * 32, tested_at="2026-01-01T00:00:00Z")
    put(store, recording="02" * 32, tested_at="2026-06-01T00:00:00Z")
    record_event(store, "Meander", "propeller-changed", at=AT, note="wrong ship")
    assert len(line_history(store, "Meander").events) == 1
    for counted in (True, False):
        ((event, did),) = withdraw_event(store, "Meander", "propeller-changed", at=AT, why="it was the Rhine")
        assert (event.withdrawn, did) == ("it was the Rhine", counted)
    (kept,) = history(store, "Meander").events
    assert (kept.note, kept.withdrawn) == ("wrong ship", "it was the Rhine")
    assert line_history(store, "Meander").events == ()
    with pytest.raises(StoreError, match="which stays withdrawn; state another minute"):
        record_event(store, "Meander", "propeller-changed", at=AT)
    # it goes along in an export, and an older one does not bring it back
    export_store(store, tmp_path / "x.jsonl")
    with create_store(str(tmp_path / "new.db")) as new:
        import_store(new, tmp_path / "x.jsonl")
        assert history(new, "Meander").events == (kept,)
        export_store(new, tmp_path / "y.jsonl")
        assert check(new) == ()
    assert (tmp_path / "x.jsonl").read_bytes() == (tmp_path / "y.jsonl").read_bytes()


def test_only_what_is_there_is_withdrawn_and_with_a_reason(file_store, put):
    put(file_store)
    with pytest.raises(StoreError, match="at that time, found none"):
        withdraw_event(file_store, "Meander", "docking", at=AT, why="x")
    record_event(file_store, "Meander", "docking", at=AT)
    with pytest.raises(StoreError, match="expected a reason"):
        withdraw_event(file_store, "Meander", "docking", at=AT, why="")


def test_an_event_of_the_last_minute_of_the_calendar_is_shown_and_withdrawn(run, file_store, put):
    put(file_store)
    record_event(file_store, "Meander", "docking", at=AT)
    path = file_store.name
    # an earlier version took it; its seal is of no matter here
    with sqlite3.connect(path) as connection:
        connection.execute("update event set at = '9999-12-31T23:59:00.000000Z'")
    shown = run("store", "history", "Meander", "--time-zone", "+14:00", "--store", path)
    assert "9999-12-31 23:59" in shown.output
    done = run(
        "store", "event", "Meander", "docking", "--at", "9999-12-31T23:59+00:00", "--withdraw", "typo", "--store", path
    )
    assert done.exit_code == 0, done.output
    assert "withdrawn: typo" in run("store", "history", "Meander", "--store", path).output


def test_a_ship_itself_is_found_by_its_number_and_a_name_among_those_without(file_store, put):
    put(file_store, ship={"name": "Meander", "line": "port"}, recording="03" * 32)
    other = {"name": "once", "imo_number": IMO_NUMBER, "line": "port"}
    put(file_store, ship=other, recording="04" * 32)
    put(file_store, ship=other | {"name": "Meander"}, recording="05" * 32, tested_at="2026-08-01T00:00:00Z")
    with pytest.raises(StoreError, match="expected one ship of that name"):
        history(file_store, "Meander")
    assert len(history(file_store, Ship(name="Meander")).entries) == 1
    assert len(history(file_store, Ship(name="whatever", imo_number=IMO_NUMBER)).entries) == 2
    with pytest.raises(StoreError, match="found it changed") as refusal:
        history(file_store, Ship(name="nobody"))
    assert "Meander" not in str(refusal.value)
