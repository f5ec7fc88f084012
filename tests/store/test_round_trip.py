"""A store in one file: the same bytes from every database, at one instant, all or nothing on the way in."""

import hashlib
import json
import threading
import time
from datetime import UTC, datetime

import pytest
from benchmarks.store_documents import IMO_NUMBER, document

from shaftprint.errors import StoreError
from shaftprint.store import check, create_store, export_store, history, import_store, newest, open_store, record_event
from shaftprint.store._stated import Stated

# letters that databases put in different orders, and zones
SHIPS = ("Ægir", "aegir", "Aegir", "Zeeland", "_", "ship 10", "ship 9", "Ship")


@pytest.fixture
def fleet(tmp_path, put):
    """A fleet in a file: ships of many letters, renamed ones, superseded fingerprints, events, what was stated."""
    with create_store(str(tmp_path / "fleet.db")) as store:
        for place, name in enumerate(SHIPS):
            ship = {"name": name, "line": "port"}
            put(store, ship=ship, recording=f"{place:064x}", tested_at=f"2026-01-0{place + 1}T00:00:00+09:30")
        put(store, recording="aa" * 32, created="2026-09-01T00:00:00Z")
        put(store, recording="aa" * 32, created="2026-05-01T00:00:00Z", k_q=0.05)
        put(store, recording="aa" * 32, created="2026-05-01T00:00:00Z", k_q=0.06)
        put(store, recording=None, k_q=0.05)
        put(store, recording=None, k_q=0.06)
        renamed = {"name": "Rhine \x1b[1m", "imo_number": IMO_NUMBER, "line": "port"}
        put(store, recording="bb" * 32, ship=renamed, tested_at="2026-10-01T00:00:00Z", place="Quay\n12")
        stated = Stated(ship="ship 9", line="starboard", tested_at=datetime(2026, 1, 1, tzinfo=UTC))
        put(store, recording="cc" * 32, ship=None, tested_at=None, stated=stated)
        at = datetime(2026, 5, 1, tzinfo=UTC)
        record_event(store, str(IMO_NUMBER), "docking", at=at, note="new\npaint")
        record_event(store, "Zeeland", "other", at=at, numbers=["K_Q", "I_dn"], note="\N{SNOWMAN}")
        yield store


def moved(store, url, path):
    """Return the export of a store, after it went into another one."""
    export_store(store, path)
    with create_store(url) as other:
        import_store(other, path)
        assert check(other) == ()
        export_store(other, path.with_suffix(".again"))
    return path.read_bytes(), path.with_suffix(".again").read_bytes()


def test_a_store_moves_to_another_file_and_is_the_same(fleet, tmp_path):
    first, second = moved(fleet, str(tmp_path / "other.db"), tmp_path / "one.jsonl")
    assert first == second
    kinds = [json.loads(line)["kind"] for line in first.splitlines()]
    # eight ships and the renamed one; a line each, and one more
    assert [kinds.count(kind) for kind in ("ship", "line", "event", "fingerprint")] == [9, 10, 2, 15]


@pytest.mark.slow
def test_a_store_moves_to_the_server_and_back_and_is_the_same(fleet, server, tmp_path):
    url = server.new_database()
    first, second = moved(fleet, url, tmp_path / "one.jsonl")
    with open_store(url) as store:
        third, fourth = moved(store, str(tmp_path / "back.db"), tmp_path / "two.jsonl")
        assert newest(store, number="K_Q") == newest(fleet, number="K_Q")
    assert first == second == third == fourth


def test_the_same_import_twice_changes_nothing(fleet, tmp_path):
    export_store(fleet, tmp_path / "one.jsonl")
    with create_store(str(tmp_path / "other.db")) as other:
        first = import_store(other, tmp_path / "one.jsonl")
        assert (first.fingerprints, first.known, first.events) == (15, 0, 2)
        second = import_store(other, tmp_path / "one.jsonl")
        assert (second.fingerprints, second.known, second.events) == (0, 15, 0)


def resealed(lines):
    """Return lines with an end that belongs to them."""
    end = {"kind": "end", "records": len(lines) - 1, "sha256": hashlib.sha256(b"".join(lines)).hexdigest()}
    return b"".join([*lines, json.dumps(end).encode() + b"\n"])


def changed(line, /, **fields):
    return json.dumps(json.loads(line) | fields).encode() + b"\n"


def test_an_export_that_was_cut_off_or_changed_puts_nothing_in(fleet, tmp_path):
    export_store(fleet, tmp_path / "one.jsonl")
    whole = (tmp_path / "one.jsonl").read_bytes()
    lines = whole.splitlines(keepends=True)
    wrong = {
        "cut off": b"".join(lines[:-1]),
        "is not as it was written": whole.replace(b"Zeeland", b"Zealand", 1),
        "its end states another content": b"".join([*lines[:5], *lines[6:]]),
        "another content: export": whole + b"\n",
        "expected a record of a store's export, found something else": whole[: len(whole) // 2],
        "of format 1, found another file": b'{"kind":"shaftprint store","format":2}\n',
        "found another file": b"",
    }
    with create_store(str(tmp_path / "other.db")) as other:
        for words, content in wrong.items():
            (tmp_path / "two.jsonl").write_bytes(content)
            with pytest.raises(StoreError, match=words.split(":")[0]):
                import_store(other, tmp_path / "two.jsonl")
        with pytest.raises(StoreError, match="cannot be read: No such file"):
            import_store(other, tmp_path / "three.jsonl")
        assert newest(other) == ()


@pytest.mark.parametrize(
    ("kind", "fields", "words"),
    [
        ("ship", {"imo_number": 9074728}, "line 2: .*expected an IMO number, found '9074728'"),
        ("ship", {"name": "a\0b"}, "expected a name of a ship of letters"),
        ("ship", {"name": 7}, "a field that is missing or of another kind"),
        ("ship", {"kind": "sub" * 100}, "expected a ship, line, event, fingerprint or job, found 'subsub"),
        ("event", {"what": "\x1b[2J"}, "expected what was done"),
        ("event", {"at": "yesterday"}, "a field that is missing or of another kind"),
        ("event", {"at": "2026-01-01T00:00:00"}, "a field that is missing or of another kind"),
        ("fingerprint", {"document": "{}"}, "found JSON without a schema_version"),
        ("fingerprint", {"sha256": "00" * 32}, "its document is not as it was written"),
        ("fingerprint", {"stated": {"nonsense": 1}}, "a field that is missing or of another kind"),
        ("fingerprint", {"line": "starboard"}, "is of another ship or line than the record"),
        ("fingerprint", {"ship": {"name": "Meander", "imo_number": 9319466}}, "is of another ship or line"),
        ("fingerprint", {"added_at": None}, "a field that is missing or of another kind"),
    ],
)
def test_a_forged_record_puts_nothing_in(file_store, tmp_path, put, kind, fields, words):
    put(file_store)
    record_event(file_store, "Meander", "docking", at=datetime(2026, 5, 1, tzinfo=UTC))
    export_store(file_store, tmp_path / "one.jsonl")
    *lines, _ = (tmp_path / "one.jsonl").read_bytes().splitlines(keepends=True)
    forged = [changed(line, **fields) if json.loads(line)["kind"] == kind else line for line in lines]
    (tmp_path / "two.jsonl").write_bytes(resealed(forged))
    with create_store(str(tmp_path / "other.db")) as other:
        with pytest.raises(StoreError, match=words):
            import_store(other, tmp_path / "two.jsonl")
        assert newest(other) == ()


def test_an_export_is_written_whole_or_not_at_all(file_store, put, tmp_path):
    put(file_store)
    export_store(file_store, tmp_path / "one.jsonl")
    with pytest.raises(StoreError, match="it exists already"):
        export_store(file_store, tmp_path / "one.jsonl")
    with pytest.raises(StoreError, match="cannot be written there: No such file or directory"):
        export_store(file_store, tmp_path / "no" / "one.jsonl")
    with file_store.database.unlocked() as raw:
        raw.execute("UPDATE document SET content = zeroblob(9)")
    with pytest.raises(StoreError, match="damaged"):
        export_store(file_store, tmp_path / "two.jsonl")
    assert {path.name for path in tmp_path.glob("*.jsonl*")} == {"one.jsonl"}


@pytest.mark.slow
def test_a_backup_that_is_taken_under_load_restores(url, tmp_path, put):
    """Each export holds a whole number of additions, in their order, and goes into an empty store."""
    stop, added = threading.Event(), []

    def write():
        with open_store(url) as own:
            while not stop.is_set():
                place = len(added)
                put(own, recording=f"{place:064x}", filling=100, seed=place)
                added.append(place)

    create_store(url).close()
    writer = threading.Thread(target=write)
    writer.start()
    try:
        with open_store(url) as store:
            counts = []
            for number in range(5):
                while len(added) < 3 * (number + 1) and writer.is_alive():
                    time.sleep(0.01)
                least = len(added)
                export_store(store, tmp_path / f"{number}.jsonl")
                counts.append((least, len(added) + 1))
    finally:
        stop.set()
        writer.join()
    for number, (least, most) in enumerate(counts):
        with create_store(str(tmp_path / f"{number}.db")) as restored:
            import_store(restored, tmp_path / f"{number}.jsonl")
            assert check(restored) == ()
            found = history(restored, "Meander", number="K_Q").entries if newest(restored) else ()
            assert least <= len(found) <= most
            expected = {f"{place:064x}" for place in range(len(found))}
            assert {entry.fingerprint.trial.recording_sha256 for entry in found} == expected
    assert counts[-1][1] > 3


def test_what_was_stated_by_hand_goes_along(file_store, put, tmp_path):
    stated = Stated(ship="Meander", line="port", imo_number=IMO_NUMBER, tested_at=datetime(2026, 1, 1, tzinfo=UTC))
    put(file_store, ship=None, tested_at=None, stated=stated)
    export_store(file_store, tmp_path / "one.jsonl")
    record = json.loads((tmp_path / "one.jsonl").read_bytes().splitlines()[-2])
    assert record["stated"] == stated.content()
    assert record["document"].encode() == document(tested_at=None)
