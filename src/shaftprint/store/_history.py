"""What a store tells: the history of a ship, all lines with their newest test, a document as it was put in."""

import re

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.store._check import line_faults
from shaftprint.store._document import SHOWN_HASH, document_sha256, inflated
from shaftprint.store._find import lines_called, name_of, ship_called
from shaftprint.store._nouns import History, LineSummary, Ship
from shaftprint.store._store import Store


@refusing_none(StoreError)
def history(
    store: Store,
    ship: str | Ship,
    *,
    number: str | None = None,
    lines: tuple[str, ...] = (),
    superseded: bool = False,
    checked: bool = True,
) -> History:
    """Return the tests of a ship in the order of time, with their numbers, and what was done to it.

    Each is held against its document and its seal, where nothing else is asked for: what is not as it was written is
    said.

    Parameters
    ----------
    store
        The store.
    ship
        Name or IMO number of the ship, or the ship itself.
    number
        Name of the number that is wanted, such as ``K_Q``; None for all.
    lines
        Which of its lines; all where none is named.
    superseded
        Whether fingerprints come too whose place a later one of the same recording has taken.
    checked
        Whether all is held against documents and seals, which takes 1.5 ms for each test.

    Raises
    ------
    StoreError
        If there is no such ship or line, or no test of it has that number.
    """
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        found = ship_called(reader, ship)
        wanted = lines_called(reader, found, lines)
        entries = reader.entries(wanted, number=number, superseded=superseded)
        kept = reader.fingerprints(wanted, superseded=superseded) if checked else {}
        faults = line_faults(reader, list(wanted), kept) if checked else ()
        if number is not None and entries and not any(entry.numbers for entry in entries):
            raise StoreError(
                f"{name_of(ship)}: expected the name of a number, such as K_Q, found {number!r} in none of its tests."
            )
        events = tuple(reader.events(wanted))
        return History(ship=found.ship, entries=tuple(entries), events=events, faults=faults)


@refusing_none(StoreError)
def newest(store: Store, *, number: str | None = None) -> tuple[LineSummary, ...]:
    """Return every line of a store with its newest test, by IMO number and name of the ship.

    Parameters
    ----------
    store
        The store.
    number
        Name of a number that is wanted of that test; None for none.
    """
    with store.database.reading() as connection:
        return tuple(store.database.reader(connection).summaries(number=number))


@refusing_none(StoreError)
def document(store: Store, sha256: str) -> bytes:
    """Return the document of a fingerprint, byte by byte as it was put in.

    Parameters
    ----------
    store
        The store.
    sha256
        Its SHA-256, as a history states it.

    Raises
    ------
    StoreError
        If there is none, or it is damaged.
    """
    named = f"fingerprint {sha256[:SHOWN_HASH]}"
    if not re.fullmatch(r"[0-9a-f]{64}", sha256):
        raise StoreError(f"expected the SHA-256 of a fingerprint, 64 digits and letters to f, found {sha256[:80]!r}.")
    with store.database.reading() as connection:
        kept = store.database.reader(connection).document(sha256)
    if kept is None:
        raise StoreError(f"{named}: expected it in the store, found none.")
    content = inflated(kept, named=named)
    if document_sha256(content) != sha256:
        raise StoreError(
            f"{named}: the document is not as it was written; the store is damaged: shaftprint store check."
        )
    return content
