"""What goes wrong with a store ends in one sentence, and a password is in none of them."""

import os
import sqlite3
import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks.store_documents import IMO_NUMBER

from shaftprint.errors import StoreError
from shaftprint.store import check, create_store, document, history, open_store

SECRET = "hu sh/42"  # noqa: S105
QUOTED = "hu%20sh%2F42"


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("", "expected a file such as shaftprint.db, or a URL"),
        ("sqlite://", "expected sqlite:///FILE"),
        ("sqlite:///:memory:", "a store is kept"),
        ("sqlite:///fleet.db?mode=memory", "expected sqlite:///FILE"),
        ("a\0b", "expected a file"),
        (f"mysql://me:{QUOTED}@host/fleet", "found a URL of mysql"),
        (f"me:{QUOTED}@host://x", "found a URL of another one"),
        (f"postgresql://me:hu@{QUOTED}@host/fleet", "write that of a password as %40"),
        (f"postgresql://me:{QUOTED}@host:port/fleet", "found a URL that cannot be read|connection|refuses"),
        (f"postgresql://me:{QUOTED}@127.0.0.1:1/fleet", r"^postgresql://me@127\.0\.0\.1:1/fleet: the database refuses"),
        (
            f"postgresql://me@127.0.0.1:1/fleet?password={QUOTED}",
            r"^postgresql://me@127\.0\.0\.1:1/fleet: the database",
        ),
        (f"postgresql://127.0.0.1:1/fleet?nonsense={QUOTED}&passfile={QUOTED}", "the database refuses"),
    ],
)
def test_a_place_that_is_none_is_refused_without_its_password(run, url, words):
    with pytest.raises(StoreError, match=words) as refusal:
        open_store(url)
    said = f"{refusal.value!r}{refusal.value.__cause__!r}"
    if "\0" not in url:
        result = run("store", "list", "--store", url)
        assert result.exit_code == 1
        said += result.output
        said += run("store", "list", "--json", env={"SHAFTPRINT_STORE": url}).output
    assert "sh%2F42" not in said
    assert SECRET not in said
    assert "Traceback" not in said


def test_a_file_is_named_by_its_path_or_by_a_url(tmp_path, run):
    create_store(f"sqlite:///{tmp_path / 'a b#c?d.db'}".replace("?", "_")).close()
    assert (tmp_path / "a b#c_d.db").exists()
    create_store(str(tmp_path / "a b#c?d%41.db")).close()
    assert (tmp_path / "a b#c?d%41.db").exists()
    open_store(str(tmp_path / "a b#c?d%41.db")).close()


@pytest.mark.slow
def test_a_password_is_shown_by_nothing(server, run):
    url = server.new_database().replace("postgres:@", f"postgres:{QUOTED}@")
    with create_store(url) as store:
        shown = f"{store!r}{store.name}{store.database!r}{store.database.location!r}"
        assert QUOTED not in shown
        assert "sh%2F42" not in shown
        assert SECRET not in shown
    for words in (("list",), ("check",), ("init",), ("history", "none"), ("upgrade",)):
        result = run("store", *words, "--store", url, "--json")
        assert "sh%2F42" not in result.output + result.stderr
        assert SECRET not in result.output + result.stderr


def test_what_is_not_there_is_said(tmp_path):
    with pytest.raises(StoreError, match=r"expected a store, found nothing there; make one with shaftprint store init"):
        open_store(str(tmp_path / "fleet.db"))
    with pytest.raises(StoreError, match="expected a file, found a folder"):
        create_store(str(tmp_path))
    with pytest.raises(StoreError, match="it cannot be opened; check that it is there"):
        create_store(str(tmp_path / "no" / "fleet.db"))


@pytest.mark.parametrize("content", [b"{}", b"SQLite format 3\0" + b"\xff" * 4096, b"x" * 10_000])
def test_a_file_of_another_kind_is_refused_and_left_alone(tmp_path, content):
    path = tmp_path / "fleet.db"
    path.write_bytes(content)
    for verb in (open_store, create_store):
        with pytest.raises(StoreError, match=r"fleet\.db: .*(another kind|damaged|without one)"):
            verb(str(path))
    assert path.read_bytes() == content


def test_an_empty_file_holds_no_store_and_may_become_one(tmp_path):
    path = tmp_path / "fleet.db"
    path.touch()
    with pytest.raises(StoreError, match="found a database without one"):
        open_store(str(path))
    create_store(str(path)).close()
    open_store(str(path)).close()


def test_a_file_that_was_cut_off_is_refused(tmp_path, put):
    path = tmp_path / "fleet.db"
    with create_store(str(path)) as store:
        for place in range(20):
            put(store, recording=f"{place:064x}")
    whole = path.read_bytes()
    for share in (0.05, 0.3, 0.7, 0.99):
        path.write_bytes(whole[: int(share * len(whole))])
        assert any("damaged" in words or "disk image" in words for words in faults_of(path)), share


def faults_of(path):
    """Return what is said of a file, whether it can be opened or not."""
    try:
        with open_store(str(path)) as store:
            return [fault.found for fault in check(store)]
    except StoreError as refusal:
        return [str(refusal)]


def test_a_writer_that_does_not_end_is_named(tmp_path, put):
    path = tmp_path / "fleet.db"
    create_store(str(path)).close()
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with open_store(str(path), busy_s=0.1) as store:
        # a reader does not wait
        with pytest.raises(StoreError, match="It has none yet"):
            history(store, "Meander")
        with pytest.raises(StoreError, match=r"another program has been writing to it for more than 0\.1 s; try again"):
            put(store)
        other.execute("ROLLBACK")
        assert put(store).outcome == "added"
    other.close()


@pytest.mark.slow
def test_a_writer_of_the_server_that_does_not_end_is_named(server, put):
    url = server.new_database()
    with create_store(url) as first, open_store(url, busy_s=0.2) as second:
        other = pytest.raises(StoreError, match=r"another program has been writing to it for more than 0\.2 s")
        with first.database.writing(), other:
            put(second)
        assert put(second).outcome == "added"


@pytest.mark.slow
def test_a_server_that_goes_away_is_one_sentence(server, put):
    url = server.new_database()
    with create_store(url) as store:
        put(store)
        server.stop("immediate")
        try:
            with pytest.raises(StoreError, match="the database refuses: "):
                put(store, recording="cd" * 32)
        finally:
            server.start()
        assert len(history(store, "Meander").entries) == 1


def test_a_full_disk_leaves_the_store_as_it_was(file_store, put):
    put(file_store)
    with file_store.database.unlocked() as raw:
        pages = raw.execute("PRAGMA page_count").fetchone()[0]
        raw.execute(f"PRAGMA max_page_count={pages}")
    with pytest.raises(StoreError, match="the disk is full; make room and do it again, for nothing was written"):
        put(file_store, recording="01" * 32, filling=5000)
    with file_store.database.unlocked() as raw:
        raw.execute("PRAGMA max_page_count=1000000")
    assert check(file_store) == ()


LIMITED = """
import resource, signal, sys
from benchmarks.store_documents import document
from datetime import UTC, datetime
from shaftprint.errors import StoreError
from shaftprint.store import add_document, open_store

signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))
ship = {"name": "Meander", "line": "port"}
with open_store(sys.argv[1]) as store:
    try:
        for place in range(100):
            made = document(recording=f"{place:064x}", ship=ship, filling=500, seed=place)
            print(add_document(store, made, named="x", now=datetime.now(UTC)).sha256, flush=True)
    except StoreError as error:
        print(error)
"""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="Windows has no limit on the length of files")
def test_a_file_that_may_grow_no_longer_loses_nothing(tmp_path):
    path = tmp_path / "fleet.db"
    create_store(str(path)).close()
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, str(path)], cwd=root, capture_output=True, text=True, check=True
    )
    *acknowledged, sentence = done.stdout.splitlines()
    assert sentence.startswith(f"{path}: the disk ")
    assert len(acknowledged) > 3
    with open_store(str(path)) as store:
        assert [entry.fingerprint.sha256 for entry in history(store, "Meander").entries] == acknowledged
        assert check(store) == ()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="permissions of folders are those of POSIX")
def test_a_folder_that_may_be_read_only_is_read_and_nothing_is_made_in_it(tmp_path):
    path = tmp_path / "fleet.db"
    create_store(str(path)).close()
    for folder in (path, tmp_path):
        folder.chmod(0o555)
    for folder in list(tmp_path.parents)[:3]:
        folder.chmod(folder.stat().st_mode | 0o055)
    code = (
        "import os, sys\n"
        "from shaftprint.store import create_store, open_store\nfrom shaftprint.errors import StoreError\n"
        # what is loaded late is loaded while the program's own files may be read
        "open_store(sys.argv[1]).close()\n"
        "if os.getuid() == 0:\n    os.setgroups([])\n    os.setgid(65534)\n    os.setuid(65534)\n"
        "for verb, name in ((open_store, sys.argv[1]), (create_store, sys.argv[1] + '2')):\n"
        "    try:\n        print(verb(name).is_read_only)\n    except StoreError as error:\n        print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True)
    first, second = done.stdout.splitlines()
    tmp_path.chmod(0o755)
    assert first == "True"
    assert "it cannot be opened" in second


def test_a_document_that_inflates_without_end_is_not_inflated(file_store, put):
    import zlib

    added = put(file_store)
    bomb = zlib.compress(b"\0" * 2**26, 9)
    with file_store.database.unlocked() as raw:
        raw.execute("UPDATE document SET content = ?", (bomb,))
    with pytest.raises(StoreError, match="at most 16 MiB, found one that is longer"):
        document(file_store, added.sha256)
    assert [fault.found for fault in check(file_store)] == ["its document cannot be inflated"]


def test_a_store_without_its_packages_says_how_to_get_them(monkeypatch, run):
    # a package that is not there
    monkeypatch.setitem(sys.modules, "sqlalchemy", None)
    result = run("store", "list")
    assert result.exit_code == 1
    assert (
        result.stderr == 'Error: store: expected the package sqlalchemy, found none; pip install "shaftprint[store]".\n'
    )


def test_what_a_damaged_file_says_moves_no_cursor(tmp_path, put, run):
    path = str(tmp_path / "fleet.db")
    with create_store(path) as store:
        put(store)
        with store.database.unlocked() as raw:
            raw.execute("UPDATE ship SET name = char(27) || '[2J' || char(10) || 'Error: x'")
            raw.execute("UPDATE trial SET tested_at = char(27) || 'never'")
    for words in (("list",), ("history", str(IMO_NUMBER)), ("check",), ("export", tmp_path / "x.jsonl")):
        result = run("store", *words, "--store", path)
        assert "\x1b" not in result.output
        assert result.exit_code == 1
    assert not (tmp_path / "x.jsonl").exists()


def test_a_store_that_the_system_says_is_read_only_is_read(tmp_path, run, put, monkeypatch):
    path = tmp_path / "fleet.db"
    with create_store(str(path)) as store:
        put(store)
    monkeypatch.setattr(os, "access", lambda *_: False)
    _expect_read_only(path, run)
    assert not list(tmp_path.glob("fleet.db-*"))
    # records that are in a log beside it would not be seen
    path.with_name("fleet.db-wal").write_bytes(b"x")
    with pytest.raises(StoreError, match=r"its newest records are in fleet\.db-wal beside it; copy both"):
        open_store(str(path))


def _expect_read_only(path, run):
    shown = run("store", "list", "--store", str(path))
    assert shown.exit_code == 0
    assert "is read only here" in shown.output
    assert "Meander" in shown.output
    refused = run("store", "event", "Meander", "docking", "--at", "2026-05-01T00:00+00:00", "--store", str(path))
    assert refused.exit_code == 1
    assert "read only" in refused.output
    with open_store(str(path)) as store:
        assert store.is_read_only
        assert check(store) == ()
        assert len(history(store, "Meander").entries) == 1
