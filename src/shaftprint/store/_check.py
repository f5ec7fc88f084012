"""Whether every record of a store is as it was written."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from shaftprint.arguments import refusing_none
from shaftprint.errors import FingerprintError, StoreError
from shaftprint.late import late
from shaftprint.store._document import SHOWN_HASH, document_sha256, inflated
from shaftprint.store._nouns import Fault, StoredFingerprint, StoredNumber
from shaftprint.store._record import numbers_of
from shaftprint.store._store import Store, part_with_database

with late():
    from shaftprint.fingerprint._json_file import parse_fingerprint

if TYPE_CHECKING:
    from shaftprint.store.database._reader import Reader


@refusing_none(StoreError)
def check(store: Store, *, report: Callable[[int], None] | None = None) -> tuple[Fault, ...]:
    """Return what in a store is not as it was written; nothing where all is well.

    A file is checked by SQLite, and each row against its seal; each document against its SHA-256, and the numbers of
    each fingerprint against those of its document.

    Parameters
    ----------
    store
        The store.
    report
        Is told how many fingerprints have been looked at.
    """
    faults = list(part_with_database().database_faults(store.database))
    try:
        faults += _documents(store, report or _nobody)
    except StoreError as error:
        faults.append(Fault(record="fingerprints", found=str(error)))
    return tuple(faults)


def _nobody(count: int) -> None:
    """Tell nobody."""


def _documents(store: Store, report: Callable[[int], None]) -> Iterator[Fault]:
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        lines = reader.lines(reader.ships())
        found = reader.fingerprints(lines, superseded=True)
        if (there := reader.count()) != len(found):
            yield Fault(record="fingerprints", found=f"{there - len(found)} of {there} belong to no line")
        yield from document_faults(reader, found, report)


def document_faults(
    reader: Reader, found: Mapping[int, StoredFingerprint], report: Callable[[int], None]
) -> Iterator[Fault]:
    """Give which of some fingerprints, by their number in the database, are not as they were written."""
    keys = list(found)
    numbers = reader.numbers(keys)
    for count, (key, kept) in enumerate(reader.documents(keys)):
        report(count + 1)
        fault = _fault(found[key], kept, next(numbers))
        if fault is not None:
            yield Fault(record=_name(found[key]), found=fault)


def line_faults(reader: Reader, lines: Collection[int], found: Mapping[int, StoredFingerprint]) -> tuple[Fault, ...]:
    """Return what of some lines, and of their fingerprints, is not as it was written."""
    rows = part_with_database().line_faults(reader.connection, lines)
    return (*rows, *document_faults(reader, found, _nobody))


def _name(one: StoredFingerprint) -> str:
    return f"{one.line.ship.name}, {one.line.position}, fingerprint {one.sha256[:SHOWN_HASH]}"


def _fault(one: StoredFingerprint, kept: Any, numbers: list[StoredNumber] | None) -> str | None:
    """Return what is wrong with a fingerprint, or None."""
    try:
        content = inflated(kept, named="document")
    except StoreError:
        return "its document cannot be inflated"
    if document_sha256(content) != one.sha256:
        return "its document has another SHA-256 than it had"
    try:
        expected = numbers_of(parse_fingerprint(content, named="document"), named="document")
    except (FingerprintError, StoreError) as error:
        return f"its document is no fingerprint: {error}"
    if numbers is None:
        return "its numbers are of another kind than numbers"
    stored = {json.dumps([one.kind, one.name, one.unit]): one for one in numbers}
    for number in expected:
        kept_number = stored.pop(json.dumps([number.kind, number.name, number.unit]), None)
        if kept_number != number:
            return f"{number.name} is not that of its document"
    return f"{next(iter(stored.values())).name} is not in its document" if stored else None
