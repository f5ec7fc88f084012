"""The store in a database: where it is, its tables, what is read from them and put into them.

It needs SQLAlchemy; the room asks for it when a store is opened, and not before.
"""

from shaftprint.store.database._damage import database_faults, line_faults
from shaftprint.store.database._database import Database, connect
from shaftprint.store.database._hashes import Hashes
from shaftprint.store.database._ledger import Ledger
from shaftprint.store.database._lines_now import fingerprint_called, line_states, store_state
from shaftprint.store.database._location import Location, location_of
from shaftprint.store.database._moved_jobs import put_jobs
from shaftprint.store.database._reader import Reader, ShipRow
from shaftprint.store.database._schema import MIGRATIONS, create, expect_current, upgrade
from shaftprint.store.database._tables import HEAD, METADATA
from shaftprint.store.database._writer import Writer

__all__ = [
    "HEAD",
    "METADATA",
    "MIGRATIONS",
    "Database",
    "Hashes",
    "Ledger",
    "Location",
    "Reader",
    "ShipRow",
    "Writer",
    "connect",
    "create",
    "database_faults",
    "expect_current",
    "fingerprint_called",
    "line_faults",
    "line_states",
    "location_of",
    "put_jobs",
    "store_state",
    "upgrade",
]
