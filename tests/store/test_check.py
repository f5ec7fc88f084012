"""A changed byte is found, wherever something is kept."""

import random
import sqlite3
import struct

import pytest

from shaftprint.errors import StoreError
from shaftprint.store import check, create_store, export_store, history, import_store, open_store, record_event

PLACES = {
    "document": [("document", "content")],
    "value": [("value", name) for name in ("value", "std", "low", "high")],
    "text": [
        *(("ship", name) for name in ("name", "class_of", "imo", "seal")),
        ("line", "position"),
        *(("event", name) for name in ("at", "kind", "numbers_affected", "note")),
        *(("trial", name) for name in ("tested_at", "place", "recording_sha256", "draught_m")),
        *(("fingerprint", name) for name in ("sha256", "made_at", "added_at", "structure", "version", "stated")),
        *(("quantity", name) for name in ("kind", "name", "unit")),
    ],
}


@pytest.fixture
def path(tmp_path, put):
    """A store with something in every column."""
    from datetime import UTC, datetime

    path = tmp_path / "fleet.db"
    with create_store(str(path)) as store:
        for place in range(4):
            put(store, recording=f"{place:064x}", place="Quay 12", draught_m=1.5, filling=50, seed=place)
        at = datetime(2026, 5, 1, tzinfo=UTC)
        record_event(store, "Meander", "docking", at=at, numbers=["K_Q"], note="new paint")
        assert check(store) == ()
    return path


def flipped(value, rng):
    """Return a cell with one bit of one byte changed."""
    if isinstance(value, float):
        raw = bytearray(struct.pack("<d", value))
        raw[rng.randrange(8)] ^= 1 << rng.randrange(8)
        return struct.unpack("<d", raw)[0]
    if isinstance(value, int):
        return value ^ (1 << rng.randrange(20))
    raw = bytearray(value if isinstance(value, bytes) else value.encode())
    # seven bits, so that a text stays one
    raw[rng.randrange(len(raw))] ^= 1 << rng.randrange(8 if isinstance(value, bytes) else 7)
    return bytes(raw) if isinstance(value, bytes) else raw.decode()


@pytest.mark.slow
@pytest.mark.parametrize("kind", PLACES)
def test_one_flipped_byte_of_a_hundred_is_found_each_time(path, kind):
    rng = random.Random(7)  # noqa: S311
    found = 0
    for _ in range(100):
        table, column = rng.choice(PLACES[kind])
        with open_store(str(path)) as store, store.database.unlocked() as raw:
            raw.execute("PRAGMA foreign_keys=OFF")
            key = "fingerprint_id || ' ' || quantity_id" if table == "value" else "rowid"
            rows = raw.execute(f"SELECT {key}, {column} FROM {table} WHERE {column} IS NOT NULL").fetchall()  # noqa: S608
            row, before = rng.choice(rows)
            after = flipped(before, rng)
            while (after,) in {one[1:] for one in rows}:
                # what is unique would refuse it
                after = flipped(before, rng)
            change = f"UPDATE {table} SET {column} = ? WHERE {key} = ?"  # noqa: S608
            raw.execute(change, (after, row))
            faults = check(store)
            found += bool(faults)
            assert faults, (table, column, before, after)
            # what changed is named: its table, or the fingerprint whose number it is
            assert any(table in fault.record or "fingerprint" in fault.record for fault in faults), (table, faults)
            raw.execute(change, (before, row))
    assert found == 100


@pytest.mark.long
def test_a_flipped_byte_of_the_file_is_found_or_changes_nothing_that_is_kept(path, tmp_path, put):
    """A page has room that nothing uses; a byte there is neither found nor missed."""
    with open_store(str(path)) as store:
        for place in range(10, 25):
            put(store, recording=f"{place:064x}", filling=500, seed=place)
    rng = random.Random(8)  # noqa: S311
    with open_store(str(path)) as store:
        export_store(store, tmp_path / "whole.jsonl")
        with store.database.unlocked() as raw:
            raw.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    whole, kept = path.read_bytes(), (tmp_path / "whole.jsonl").read_bytes()
    found = 0
    for _ in range(100):
        changed = bytearray(whole)
        changed[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        path.write_bytes(changed)
        for name in ("fleet.db-wal", "fleet.db-shm"):
            path.with_name(name).unlink(missing_ok=True)
        try:
            with open_store(str(path)) as store:
                faults = check(store)
                if not faults:
                    export_store(store, tmp_path / "again.jsonl", overwrite=True)
                    assert (tmp_path / "again.jsonl").read_bytes() == kept
                found += bool(faults)
        except StoreError:
            found += 1
    # most of the file is used
    assert found > 40


def test_a_lost_number_and_a_lost_document_are_found(path):
    with sqlite3.connect(path) as connection:
        connection.execute("DELETE FROM value WHERE fingerprint_id = 2 AND quantity_id = 3")
        connection.execute("DELETE FROM document WHERE fingerprint_id = 3")
        connection.execute("UPDATE value SET quantity_id = 999 WHERE fingerprint_id = 4 AND quantity_id = 3")
    connection.close()
    with open_store(str(path)) as store:
        faults = {fault.record.rpartition(", ")[0]: fault.found for fault in check(store) if "Meander" in fault.record}
        found = [fault.found for fault in check(store)]
    assert len(faults) >= 1
    assert sum("is not that of its document" in words for words in found) >= 1
    assert sum("its document cannot be inflated" in words for words in found) == 1
    assert any("refers to a quantity that is not there" in words for words in found)


def test_the_command_names_the_record_and_ends_with_one(path, run):
    assert run("store", "check", "--store", path).exit_code == 0
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE value SET value = value * 1.01 WHERE fingerprint_id = 2 AND quantity_id = 3")
    connection.close()
    result = run("store", "check", "--store", path)
    assert result.exit_code == 1
    assert "Meander, port, fingerprint " in result.stdout
    assert "is not that of its document" in result.stdout
    document = run("store", "check", "--store", path, "--json")
    assert document.exit_code == 1
    assert '"faults"' in document.stdout


@pytest.mark.slow
def test_a_changed_row_of_the_server_is_found(server, put):
    import sqlalchemy as sa

    url = server.new_database()
    changes = (
        "UPDATE value SET std = std * 2 WHERE quantity_id = 3",
        "UPDATE trial SET tested_at = tested_at + interval '1 hour'",
        "UPDATE document SET content = set_byte(content, 40, get_byte(content, 40) # 1)",
        "UPDATE ship SET name = 'Rhine'",
        "UPDATE fingerprint SET trustworthy = NOT trustworthy",
    )
    with create_store(url) as store:
        put(store)
        assert check(store) == ()
        for change in changes:
            with store.database.engine.connect() as connection:
                transaction = connection.begin()
                connection.execute(sa.text(change))
                transaction.commit()
            assert len(check(store)) == changes.index(change) + 1 - (changes.index(change) > 1), change


@pytest.mark.parametrize(
    ("table", "column", "words"),
    [
        ("value", "value", "is not that of its document"),
        ("value", "low", "is not that of its document"),
        ("document", "content", "its document"),
        ("trial", "draught_m", "it is not as it was written"),
        ("event", "note", "it is not as it was written"),
    ],
)
def test_history_and_export_say_it_too(path, tmp_path, table, column, words):
    with sqlite3.connect(path) as connection:
        query = f"select rowid, {column} from {table} where {column} is not null"  # noqa: S608
        if table == "value":
            query = query.replace("rowid", "fingerprint_id, quantity_id")
        *key, value = connection.execute(query).fetchone()
        where = "rowid = ?" if table != "value" else "fingerprint_id = ? and quantity_id = ?"
        changed = flipped(value, random.Random(3))  # noqa: S311
        connection.execute(f"update {table} set {column} = ? where {where}", (changed, *key))  # noqa: S608
    told = []
    with open_store(str(path)) as store:
        faults = history(store, "Meander").faults
        assert len(faults) == 1
        assert words in faults[0].found
        if table == "document":
            with pytest.raises(StoreError, match="document"):
                export_store(store, tmp_path / "x.jsonl", report=told.append)
            return
        with pytest.raises(StoreError, match=words):
            export_store(store, tmp_path / "x.jsonl")
        export_store(store, tmp_path / "x.jsonl", report=told.append)
    assert tuple(told) == faults
    if table != "event":
        # numbers and tests follow from the documents, which are whole
        with create_store(str(tmp_path / "new.db")) as new:
            import_store(new, tmp_path / "x.jsonl")
            assert (check(new), history(new, "Meander").faults) == ((), ())
