"""What a database refuses, in one sentence: what is wrong, and what to do."""

import contextlib
import sqlite3
from collections.abc import Iterator
from typing import Final

import sqlalchemy as sa

from shaftprint.errors import DatabaseError, StoreError
from shaftprint.store.database._location import Location

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
