"""The schema of a store: made, looked at, and brought up to that of this version of the program."""

import contextlib
import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store.database._database import Database
from shaftprint.store.database._tables import HEAD, METADATA, VERSION_TABLE

MIGRATIONS: Final = Path(__file__).parents[1] / "migrations"
"""Folder with a file for each step from one schema to the next."""
_VERSION = sa.table(VERSION_TABLE, sa.column("version_num"))


def create(database: Database) -> None:
    """Make the tables of a store, all or none.

    Raises StoreError if there is a store already, or tables of another program are in the way.
    """
    path = database.location.path
    is_new = path is not None and not path.exists()
    try:
        with database.reading() as connection:
            _expect_room(database, connection)
        _keep_a_log(database)
        with database.writing() as connection:
            # another one may have made it in between
            _expect_room(database, connection)
            _migrate(connection)
    except BaseException:
        # what another one made in between is a store, and stays
        if is_new and path is not None and _is_empty(database):
            database.close()
            _take_away(path)
        raise


def expect_current(database: Database) -> None:
    """Check that a database holds a store of the schema that this version of the program knows.

    Raises StoreError if it holds none, or one of an earlier or a later schema.
    """
    with database.reading() as connection:
        version = _version(database, connection)
    if version != HEAD:
        raise StoreError(
            f"{database.location.shown}: expected a store of schema {HEAD}, found the earlier {version}; bring it "
            "up to date with shaftprint store upgrade."
        )
    _keep_a_log(database)


def upgrade(database: Database) -> tuple[str, str]:
    """Bring a store up to the schema of this version of the program, wholly or not at all.

    Returns
    -------
    before, after
        Its schema before and now.
    """
    with database.reading() as connection:
        before = _version(database, connection)
    with _references_unchecked(database), database.writing() as connection:
        _migrate(connection)
    return before, HEAD


@contextlib.contextmanager
def _references_unchecked(database: Database) -> Iterator[None]:
    """Let SQLite put a new table in the place of one that others refer to; it checks all of them at the end."""
    if not database.is_file:
        yield
        return
    with database.unlocked() as raw:
        raw.execute("PRAGMA foreign_keys=OFF")
    try:
        yield
    finally:
        with database.unlocked() as raw:
            raw.execute("PRAGMA foreign_keys=ON")


def _migrate(connection: sa.Connection) -> None:
    # only who makes or upgrades a store loads it
    config = importlib.import_module("alembic.config").Config()
    # a percent sign begins a variable there
    config.set_main_option("script_location", str(MIGRATIONS).replace("%", "%%"))
    config.attributes |= {"connection": connection, "version_table": VERSION_TABLE}
    importlib.import_module("alembic.command").upgrade(config, "head")


def _version(database: Database, connection: sa.Connection) -> str:
    """Return the schema of a store that this version of the program can read or upgrade."""
    shown = database.location.shown
    versions = []
    if sa.inspect(connection).has_table(VERSION_TABLE):
        versions = list(connection.execute(sa.select(_VERSION.c.version_num)).scalars())
    if len(versions) != 1 or not str(versions[0]).isdecimal():
        raise StoreError(
            f"{shown}: expected a store of fingerprints, found a database without one; make one elsewhere with "
            "shaftprint store init, or name another."
        )
    if int(versions[0]) > int(HEAD):
        raise StoreError(
            f"{shown}: expected a store of schema {HEAD}, found the later {versions[0]}; use the version of shaftprint "
            "that upgraded it, or a newer one."
        )
    return str(versions[0])


def _expect_room(database: Database, connection: sa.Connection) -> None:
    """Check that no store and no table of another program is there."""
    shown, found = database.location.shown, set(sa.inspect(connection).get_table_names())
    if VERSION_TABLE in found:
        raise StoreError(f"{shown}: expected no store yet, found one; it is as it was.")
    foreign = sorted(found if database.is_file else found & set(METADATA.tables))
    if foreign:
        raise StoreError(
            f"{shown}: expected an empty database, found the table {foreign[0]!r} of another program; choose "
            "another one."
        )
    if not database.is_file:
        encoding = connection.exec_driver_sql("SHOW server_encoding").scalar()
        if encoding != "UTF8":
            raise StoreError(f"{shown}: expected a database in UTF8, found {encoding}; make one with ENCODING 'UTF8'.")


def _keep_a_log(database: Database) -> None:
    """Let a file be read while it is written (WAL); it says so itself from then on."""
    if not database.is_file or database.is_read_only:
        return
    with database.unlocked() as raw:
        mode = raw.execute("PRAGMA journal_mode=WAL").fetchone()[0]
    if mode != "wal":
        raise StoreError(
            f"{database.location.shown}: its disk does not let readers and a writer share a file (SQLite keeps its log "
            f"as {mode!r}, not 'wal'); choose a local folder, or PostgreSQL by its URL."
        )


def _is_empty(database: Database) -> bool:
    with database.reading() as connection:
        return not sa.inspect(connection).get_table_names()


def _take_away(path: Path) -> None:
    for name in (path.name, f"{path.name}-wal", f"{path.name}-shm"):
        with contextlib.suppress(OSError):
            path.with_name(name).unlink()
