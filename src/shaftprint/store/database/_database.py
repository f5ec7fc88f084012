"""The connection to a store: how SQLite and PostgreSQL are asked to keep what they have acknowledged."""

import contextlib
import os
import re
import sqlite3
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa

from shaftprint.errors import DatabaseError, StoreError
from shaftprint.files import kept_open
from shaftprint.store.database._hashes import Hashes
from shaftprint.store.database._ledger import Ledger
from shaftprint.store.database._location import Location
from shaftprint.store.database._reader import Reader
from shaftprint.store.database._writer import Writer

# Writers of PostgreSQL wait for each other, as those of SQLite do: two that add the same ship at one time are in order.
_WRITERS: Final = 0x73686166
_BEGIN: Final = "shaftprint_begin"


@dataclass(frozen=True, kw_only=True, slots=True)
class Database:
    """A database that is there."""

    location: Location
    """Where it is."""
    engine: sa.Engine
    """Its connections."""
    busy_s: float
    """How long another writer is waited for [s]."""
    is_read_only: bool = False
    """Whether it is a file that nobody can write here."""

    @property
    def is_file(self) -> bool:
        """Whether it is a file of SQLite."""
        return self.location.path is not None

    @contextlib.contextmanager
    def reading(self) -> Iterator[sa.Connection]:
        """Give a connection that sees the store as it is at one instant, whoever writes meanwhile."""
        with refusals_in_words(self.location, busy_s=self.busy_s), self.engine.connect() as connection:
            if not self.is_file:
                connection = connection.execution_options(isolation_level="REPEATABLE READ", postgresql_readonly=True)
            with connection.begin():
                yield connection

    @contextlib.contextmanager
    def writing(self, *, alone: bool = True) -> Iterator[sa.Connection]:
        """Give the one connection that writes; what it wrote is on the disk when the block has ended, or not there.

        ``alone``: whether other writers wait. In PostgreSQL those do not need to that lock single rows; SQLite has one
        anyway.
        """
        with refusals_in_words(self.location, busy_s=self.busy_s), self.engine.connect() as connection:
            connection = connection.execution_options(**{_BEGIN: "BEGIN IMMEDIATE"})
            with connection.begin():
                if not self.is_file:
                    self._prepare_to_write(connection, alone=alone)
                yield connection

    def _prepare_to_write(self, connection: sa.Connection, *, alone: bool) -> None:
        connection.exec_driver_sql(f"SET LOCAL lock_timeout = {round(1000 * self.busy_s)}")
        # an acknowledged record is on the disk of the server, whatever its settings
        connection.exec_driver_sql("SET LOCAL synchronous_commit = on")
        if alone:
            connection.execute(sa.select(sa.func.pg_advisory_xact_lock(_WRITERS)))

    @contextlib.contextmanager
    def unlocked(self) -> Iterator[Any]:
        """Give the driver's own connection to a file, outside of a transaction."""
        with refusals_in_words(self.location, busy_s=self.busy_s):
            pooled = self.engine.raw_connection()
            try:
                yield pooled.driver_connection
            finally:
                pooled.close()

    def reader(self, connection: sa.Connection) -> Reader:
        """Return what reads through a connection."""
        return Reader(connection=connection)

    def writer(self, connection: sa.Connection) -> Writer:
        """Return what writes through a connection."""
        return Writer(connection)

    def ledger(self, connection: sa.Connection) -> Ledger:
        """Return what changes jobs through a connection."""
        return Ledger(connection)

    def hashes(self, connection: sa.Connection) -> Hashes:
        """Return what remembers the SHA-256 of files through a connection."""
        return Hashes(connection)

    def close(self) -> None:
        """End its connections."""
        self.engine.dispose()


def connect(location: Location, *, create: bool = False, busy_s: float = 30.0, mounts: str | None = None) -> Database:
    """Return the database at a place; whether it holds a store is not looked at.

    ``location``: where it is. ``create``: whether a file that is not there is made. ``busy_s``: how long another writer
    is waited for [s]. ``mounts``: table of mounts, see ``network_file_system``. Raises StoreError if it is a file on a
    network file system, or no file is there.
    """
    if location.path is None:
        return Database(location=location, engine=_server(location), busy_s=busy_s)
    kind = network_file_system(location.path, mounts=mounts)
    if kind is not None:
        raise StoreError(
            f"{location.shown}: expected a disk of this computer, found {kind}: over a network the locks of SQLite do "
            "not hold, and records would be lost; choose a local folder, or for several computers PostgreSQL."
        )
    if location.path.is_dir():
        raise StoreError(f"{location.shown}: expected a file, found a folder; add the name of a file.")
    if not create and not location.path.exists():
        raise StoreError(
            f"{location.shown}: expected a store, found nothing there; make one with shaftprint store init."
        )
    is_read_only = not create and not _can_be_written(location.path)
    mode = _reading(location, location.path) if is_read_only else f"mode={'rwc' if create else 'rw'}"
    engine = _file(location.path, mode, busy_s=busy_s)
    return Database(location=location, engine=engine, busy_s=busy_s, is_read_only=is_read_only)


def _can_be_written(path: Path) -> bool:
    """Return whether SQLite can write a file, and its log beside it."""
    return os.access(path, os.W_OK) and os.access(path.resolve().parent, os.W_OK)


def _reading(location: Location, path: Path) -> str:
    """Return how a file is opened that cannot be written.

    Its log cannot be made either, so that SQLite is told that the file does not change. Where a log lies beside it,
    somebody else writes, or the file was copied from a store in use: then SQLite must read that too.

    Raises StoreError if it has records that are in a log that cannot be read here.
    """
    beside = [path.with_name(f"{path.name}-{end}") for end in ("wal", "shm")]
    if not beside[0].exists() or not beside[0].stat().st_size:
        return "mode=ro&immutable=1"
    if not beside[1].exists():
        raise StoreError(
            f"{location.shown}: it can only be read here, and its newest records are in {beside[0].name} beside it; "
            "copy both into a folder that can be written, and open the copy."
        )
    return "mode=ro"


def _file(path: Path, mode: str, *, busy_s: float) -> sa.Engine:
    name = f"{path.resolve().as_uri()}?{mode}"

    def opened() -> sqlite3.Connection:
        # transactions are begun below, not by the driver
        with kept_open(
            sqlite3.connect(name, uri=True, timeout=busy_s, isolation_level=None, check_same_thread=False)
        ) as connection:
            for pragma in ("foreign_keys=ON", "synchronous=FULL", "trusted_schema=OFF", "cell_size_check=ON"):
                connection.execute(f"PRAGMA {pragma}")
        return connection

    engine = sa.create_engine("sqlite://", creator=opened, poolclass=sa.pool.QueuePool, pool_size=1)
    sa.event.listen(engine, "begin", _begin)
    return engine


def _begin(connection: sa.Connection) -> None:
    # A transaction that begins as a reader and goes on as a writer is refused at once where another one writes: the
    # driver's waiting does not apply to it. So a writer says so when it begins.
    connection.exec_driver_sql(connection.get_execution_options().get(_BEGIN, "BEGIN"))


def _server(location: Location) -> sa.Engine:
    if location.url is None:
        raise StoreError("expected the URL of a database, found none.")
    url = (
        location.url
        if "connect_timeout" in location.url.query
        else location.url.update_query_dict({"connect_timeout": "10"})
    )
    try:
        return sa.create_engine(url, connect_args={"application_name": "shaftprint"}, pool_size=1)
    except ModuleNotFoundError:
        raise StoreError(
            'PostgreSQL: expected the package psycopg, found none; pip install "shaftprint[store]".'
        ) from None


NETWORK: Final = frozenset(
    {
        "nfs",
        "nfs4",
        "cifs",
        "smb",
        "smb2",
        "smb3",
        "smbfs",
        "ncpfs",
        "afs",
        "fuse.sshfs",
        "fuse.rclone",
        "fuse.smbnetfs",
    }
)
"""Types of file systems that lie on another computer, as Linux names them."""
_MOUNTS = Path("/proc/self/mountinfo")
_OCTAL = re.compile(r"\\([0-7]{3})")


def network_file_system(path: Path, *, mounts: str | None = None) -> str | None:
    """Return what kind of network file system a path lies on; None for a disk of this computer.

    ``path``: a file, which need not be there. ``mounts``: table of mounts as Linux gives it in
    ``/proc/self/mountinfo``; None for that of this computer, where it has one.
    """
    for text in (str(path), str(path.resolve())):
        if re.match(r"[\\/]{2}(?![?.][\\/])[^\\/]", text) or re.match(r"[\\/]{2}\?[\\/]UNC[\\/]", text, re.IGNORECASE):
            return "a UNC path"
    if mounts is None:
        mounts = _MOUNTS.read_text(encoding="utf-8", errors="surrogateescape") if sys.platform == "linux" else ""
    kind = _type_at(path.resolve(), mounts)
    return kind if kind in NETWORK else None


def _type_at(path: Path, mounts: str) -> str:
    """Return the type of the file system at the longest mount point above a path; a later one covers an earlier."""
    longest, found = -1, ""
    for line in mounts.splitlines():
        # ID, parent, device, root, mount point, options, other fields, a hyphen, type, source, options
        left, hyphen, right = line.partition(" - ")
        fields = left.split(" ")
        if not hyphen or len(fields) <= 4:
            continue
        point = Path(_OCTAL.sub(lambda code: chr(int(code[1], 8)), fields[4]))
        if path.is_relative_to(point) and len(point.parts) >= longest:
            longest, found = len(point.parts), right.split(" ", 1)[0]
    return found


_DAMAGED: Final = "it is damaged; put a backup in its place, and see with shaftprint store check what is wrong"
_BUSY: Final = "another program has been writing to it for more than {busy_s:g} s; try again when it has ended"
# What SQLite says, in the order in which it is looked for, and what it means to a user.
_SAID: Final = {
    "database is locked": _BUSY,
    "database table is locked": "another program is writing to it; try again when it has ended",
    "disk is full": "the disk is full; make room and do it again, for nothing was written",
    "not a database": "expected a store of fingerprints, found a file of another kind; name another file",
    "malformed": _DAMAGED,
    "could not decode": _DAMAGED,
    "disk i/o error": "the disk does not take or give its data; check the disk and the free space",
    "readonly database": "it may be read only; check the permissions of the file and of its folder",
    "unable to open": "it cannot be opened; check that it is there, and the permissions of the file and of its folder",
    "no such table": "expected a store of fingerprints, found another database; name another file",
    "no such column": "expected a store of fingerprints, found another database; name another file",
    # PostgreSQL
    "lock timeout": _BUSY,
    "no space left": "the disk of the server is full; make room and do it again, for nothing was written",
    "permission denied": "the user has no permission for it; ask whoever keeps the server",
    "read-only transaction": "the server may be read only; ask whoever keeps it",
}
_LONGEST: Final = 300


@contextlib.contextmanager
def refusals_in_words(location: Location, *, busy_s: float) -> Iterator[None]:
    """Turn what a database refuses into one sentence, without a password."""
    try:
        yield
    except (sa.exc.SQLAlchemyError, sqlite3.Error, OverflowError, UnicodeError) as error:
        original = getattr(error, "orig", None) or error
        if isinstance(original, OverflowError | UnicodeEncodeError):
            # of what was to be written, not of what is there: neither another try nor a backup would help
            raise StoreError(
                f"{location.shown}: expected times, numbers and letters that a database keeps, found others "
                f"({original}); correct the record; the store is as it was."
            ) from None
        raise DatabaseError(f"{location.shown}: {_in_words(original, location, busy_s)}.") from None


def _in_words(error: BaseException, location: Location, busy_s: float) -> str:
    said = " ".join(str(error).split())
    for sign, words in _SAID.items():
        if sign in said.lower():
            return words.format(busy_s=busy_s)
    if isinstance(error, UnicodeError):
        return _DAMAGED
    return f"the database refuses: {location.redacted(said)[:_LONGEST].rstrip('.')}"
