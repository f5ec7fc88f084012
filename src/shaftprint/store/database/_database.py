"""The connection to a store: how SQLite and PostgreSQL are asked to keep what they have acknowledged."""

import contextlib
import os
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._mounts import network_file_system
from shaftprint.store.database._hashes import Hashes
from shaftprint.store.database._ledger import Ledger
from shaftprint.store.database._location import Location
from shaftprint.store.database._reader import Reader
from shaftprint.store.database._refusals import refusals_in_words
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

        Parameters
        ----------
        alone
            Whether other writers wait. In PostgreSQL those do not need to that lock single rows; SQLite has one anyway.
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

    Parameters
    ----------
    location
        Where it is.
    create
        Whether a file that is not there is made.
    busy_s
        How long another writer is waited for [s].
    mounts
        Table of mounts, see ``network_file_system``.

    Raises
    ------
    StoreError
        If it is a file on a network file system, or no file is there.
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
        connection = sqlite3.connect(name, uri=True, timeout=busy_s, isolation_level=None, check_same_thread=False)
        try:
            for pragma in ("foreign_keys=ON", "synchronous=FULL", "trusted_schema=OFF", "cell_size_check=ON"):
                connection.execute(f"PRAGMA {pragma}")
        except BaseException:
            connection.close()
            raise
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
