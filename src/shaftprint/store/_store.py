"""The store: made, opened, and brought up to date. The packages that it needs are loaded here, and not before."""

import importlib
from dataclasses import dataclass, field
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Self

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.files import kept_open

if TYPE_CHECKING:
    from shaftprint.store.database._database import Database

DATABASE = "shaftprint.store.database"
_NEEDED = ("sqlalchemy", "alembic")


@dataclass(frozen=True, kw_only=True, slots=True)
class Store:
    """A store of fingerprints that is open; it closes with its ``with`` block."""

    name: str
    """Where it is: a file, or the URL of a database without its password."""
    database: "Database" = field(repr=False)
    """The database that holds it."""

    @property
    def is_read_only(self) -> bool:
        """Whether it lies where nothing can be written, such as on a read-only disk: it is read as it is."""
        return self.database.is_read_only

    def close(self) -> None:
        """Close its connections."""
        self.database.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def part_with_database() -> Any:
    """Return the part of the room that needs SQLAlchemy."""
    missing = [name for name in _NEEDED if find_spec(name) is None]
    if missing:
        raise StoreError(f'store: expected the package {missing[0]}, found none; pip install "shaftprint[store]".')
    return importlib.import_module(DATABASE)


def _connected(url: str, *, create: bool, busy_s: float = 30.0) -> Store:
    rooms = part_with_database()
    database = rooms.connect(rooms.location_of(url), create=create, busy_s=busy_s)
    return Store(name=database.location.shown, database=database)


@refusing_none(StoreError)
def create_store(url: str, *, busy_s: float = 30.0) -> Store:
    """Make an empty store, and open it.

    Parameters
    ----------
    url
        Path of a file, or URL of a database of PostgreSQL, such as ``postgresql://user@host/database``.
    busy_s
        How long another writer is waited for [s].

    Raises
    ------
    StoreError
        If there is one already, or the place cannot hold one.
    """
    with kept_open(_connected(url, create=True, busy_s=busy_s)) as store:
        part_with_database().create(store.database)
    return store


@refusing_none(StoreError)
def open_store(url: str, *, busy_s: float = 30.0) -> Store:
    """Open a store that is there.

    Parameters
    ----------
    url
        Path of its file, or URL of its database.
    busy_s
        How long another writer is waited for [s].

    Raises
    ------
    StoreError
        If there is none, or it is of an earlier or a later schema.
    """
    with kept_open(_connected(url, create=False, busy_s=busy_s)) as store:
        part_with_database().expect_current(store.database)
    return store


@refusing_none(StoreError)
def upgrade_store(url: str) -> tuple[str, str]:
    """Bring a store of an earlier version of the program up to date, wholly or not at all.

    ``url``: path of its file, or URL of its database. Returns its
    schema before and now. Raises StoreError if there is none, or it is of a later version.
    """
    with _connected(url, create=False) as store:
        before, after = part_with_database().upgrade(store.database)
    return before, after
