from ._damage import database_faults, line_faults
from ._database import Database, connect
from ._hashes import Hashes
from ._ledger import Ledger
from ._lines_now import fingerprint_called, line_states, store_state
from ._location import Location, location_of
from ._moved_jobs import put_jobs
from ._reader import Reader, ShipRow
from ._schema import MIGRATIONS, create, expect_current, upgrade
from ._tables import HEAD, METADATA
from ._writer import Writer

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
