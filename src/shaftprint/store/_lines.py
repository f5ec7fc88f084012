"""The store as JSON lines: a header, a record a line in an order that depends on nothing but the records, and an end.

The end states how many records there are and the SHA-256 of all before it: a file that was cut off is no store.
"""

import json
from typing import Any, Final

from shaftprint.errors import StoreError
from shaftprint.store._document import MOST_BYTES
from shaftprint.store._nouns import Event, Ship
from shaftprint.store._stated import utc_iso

FORMAT: Final = 1
"""Number of the layout."""
HEADER: Final = {"kind": "shaftprint store", "format": FORMAT}
# a letter of a document is at most six in JSON
LONGEST_LINE: Final = 6 * MOST_BYTES + 2**20


def line_of(record: dict[str, Any]) -> bytes:
    """Return a record as a line."""
    return (
        json.dumps(record, ensure_ascii=False, separators=(",", ":"), sort_keys=True, allow_nan=False).encode() + b"\n"
    )


def record_of_line(line: bytes, *, named: str) -> dict[str, Any]:
    """Return the record of a line.

    Raises StoreError if it is none.
    """
    try:
        record = json.loads(line)
    except (ValueError, RecursionError):
        record = None
    if not isinstance(record, dict) or not isinstance(record.get("kind"), str):
        raise StoreError(f"{named}: expected a record of a store's export, found something else; export it once more.")
    return record


def ship_content(ship: Ship) -> dict[str, Any]:
    """Return what tells a ship from all others."""
    return {"imo_number": ship.imo_number, "name": ship.name}


def event_content(event: Event) -> dict[str, Any]:
    """Return an event as a record; why it was withdrawn stands in that of one that was."""
    withdrawn = {} if event.withdrawn is None else {"withdrawn": event.withdrawn}
    return withdrawn | {
        "kind": "event",
        "ship": ship_content(event.line.ship),
        "line": event.line.position,
        "at": utc_iso(event.at),
        "what": event.kind,
        "numbers": list(event.numbers),
        "note": event.note,
    }
