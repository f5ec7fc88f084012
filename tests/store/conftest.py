"""Stores in both databases, and a real PostgreSQL that the tests start and stop themselves."""

import itertools
import os
import shutil
import signal
import subprocess
import tempfile
import time
from contextlib import suppress
from datetime import UTC, datetime
from pathlib import Path

import pytest
from benchmarks.store_documents import IMO_NUMBER, document

from shaftprint.store import add_document, create_store

pwd = None
with suppress(ImportError):
    # Windows has none, and starts no server
    import pwd
pytest.importorskip("sqlalchemy", reason="the store is an extra: pip install shaftprint[store]")
pytest.importorskip("alembic", reason="the store is an extra: pip install shaftprint[store]")
NOW = datetime(2026, 11, 24, 12, 0, tzinfo=UTC)
PORT_LINE = {"name": "Meander", "imo_number": IMO_NUMBER, "class_name": "Stan Tug 1205", "line": "port"}
BOTH = ("sqlite", pytest.param("postgresql", marks=pytest.mark.slow))


def binaries():
    """Return the folder of PostgreSQL's own programs; None where they are not."""
    found = shutil.which("initdb")
    folders = [Path(found).resolve().parent] if found else sorted(Path("/usr/lib/postgresql").glob("*/bin"))
    return next((folder for folder in reversed(folders) if (folder / "pg_ctl").exists()), None)


class Server:
    """A cluster of PostgreSQL in a folder of its own, reached by a socket in it."""

    def __init__(self, programs):
        self.programs, self.folder = programs, Path(tempfile.mkdtemp(prefix="pg", dir="/tmp"))
        # the server refuses to run as root
        self.user = "postgres" if os.getuid() == 0 else pwd.getpwuid(os.getuid()).pw_name
        self.names = itertools.count()
        if os.getuid() == 0:
            shutil.chown(self.folder, self.user)
        # the computer is not switched off here: a server that is killed finds all that it wrote, on the disk or not yet
        words = ("-E", "UTF8", "--locale=C.UTF-8", "-A", "trust", "-U", "postgres", "--no-sync")
        self.call("initdb", "-D", self.folder / "data", *words)
        self.start()

    def call(self, program, *arguments):
        user = {"user": self.user} if os.getuid() == 0 else {}
        command = [str(self.programs / program), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, **user)
        assert done.returncode == 0, done.stderr

    def start(self):
        options = f"-k {self.folder} -c listen_addresses= -c fsync=off"
        words = ("pg_ctl", "-D", self.folder / "data", "-w", "-l", self.folder / "log", "-o", options, "start")
        for _ in range(60):
            with suppress(AssertionError):
                return self.call(*words)
            # what was killed a moment ago may still hold its memory
            time.sleep(0.5)
        return self.call(*words)

    def stop(self, mode="fast"):
        self.call("pg_ctl", "-D", self.folder / "data", "-w", "-m", mode, "stop")

    def end(self):
        """Stop the server and remove what it kept; one that somebody else has stopped meanwhile is only removed."""
        if (self.folder / "data" / "postmaster.pid").exists():
            self.stop("immediate")
        shutil.rmtree(self.folder)

    def kill(self):
        """Kill every process of the server at once; what only its memory held is gone."""
        first = int((self.folder / "data" / "postmaster.pid").read_text().split()[0])
        # a child that it begets meanwhile would live on, and hold the memory for ever
        os.kill(first, signal.SIGSTOP)
        children = Path(f"/proc/{first}/task/{first}/children").read_text().split()
        for process in (first, *map(int, children)):
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)

    def url(self, database, password=""):
        return f"postgresql://postgres:{password}@/{database}?host={self.folder}"

    def new_database(self, *, encoding="UTF8"):
        psycopg = pytest.importorskip("psycopg", reason="psycopg reaches PostgreSQL")
        name = f"fleet{next(self.names)}"
        with psycopg.connect(f"host={self.folder} user=postgres dbname=postgres", autocommit=True) as connection:
            connection.execute(f"CREATE DATABASE {name} TEMPLATE template0 ENCODING '{encoding}' LOCALE 'C'")
        return self.url(name)


@pytest.fixture(scope="session")
def server():
    programs = binaries() if os.name == "posix" else None
    if programs is None:
        pytest.skip("there is no PostgreSQL server; apt-get install postgresql")
    if os.getuid() == 0 and "postgres" not in {one.pw_name for one in pwd.getpwall()}:
        pytest.skip("there is no user postgres as which the server could run; apt-get install postgresql")
    running = Server(programs)
    yield running
    running.end()


@pytest.fixture(params=BOTH)
def url(request, tmp_path):
    """Where a store may be made, in each of the two databases."""
    if request.param == "sqlite":
        return str(tmp_path / "fleet.db")
    return request.getfixturevalue("server").new_database()


@pytest.fixture
def store(url):
    """An empty store, in each of the two databases."""
    with create_store(url) as made:
        yield made


@pytest.fixture
def file_store(tmp_path):
    """An empty store in a file."""
    with create_store(str(tmp_path / "fleet.db")) as made:
        yield made


@pytest.fixture
def put():
    """Put a fingerprint that is written by hand into a store; the port line of one ship, where nothing else is said."""

    def put_in(store, *, now=NOW, stated=None, zone=None, ship=PORT_LINE, **content):
        options = {} if stated is None else {"stated": stated}
        return add_document(store, document(ship=ship, **content), named="one.json", now=now, zone=zone, **options)

    return put_in
