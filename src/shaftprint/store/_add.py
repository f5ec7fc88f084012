"""Fingerprints are put into a store: each test once, each identification of it kept."""

from collections.abc import Sequence
from datetime import datetime, tzinfo
from pathlib import Path

from shaftprint.arguments import refusing_none
from shaftprint.errors import ShaftprintError, StoreError
from shaftprint.files import reason
from shaftprint.publication._publish import complete
from shaftprint.spelling import meant_beside
from shaftprint.store._document import MOST_BYTES
from shaftprint.store._nouns import Added, Ship
from shaftprint.store._record import record_of
from shaftprint.store._stated import Stated
from shaftprint.store._store import Store

NOTHING_STATED = Stated()


@refusing_none(StoreError)
def add(
    store: Store,
    path: str | Path,
    *,
    now: datetime,
    stated: Stated = NOTHING_STATED,
    zone: tzinfo | None = None,
) -> Added:
    """Put the fingerprint of a file into a store; when this returns it is on the disk.

    The document is kept byte by byte. The same document is not kept twice; another fingerprint of the same recording
    takes the place of the earlier one, which stays.

    Parameters
    ----------
    store
        The store.
    path
        File of the fingerprint.
    now
        The present time, with its zone.
    stated
        Ship, line and time of the test, where the document does not say them.
    zone
        Zone of times without an offset; None where nobody stated one.

    Raises
    ------
    StoreError
        If it is not known which line was tested when, or the store cannot take it.
    FingerprintError
        If the file holds no fingerprint.
    """
    file = Path(path)
    complete(file.parent)
    return add_document(store, _content(file), named=str(file), now=now, stated=stated, zone=zone)


def refusals(
    paths: Sequence[Path], *, now: datetime, stated: Stated = NOTHING_STATED, zone: tzinfo | None = None
) -> list[str]:
    """Return why fingerprints of files could not be put into any store, in sentences.

    ``paths``: files of fingerprints. ``now``, ``stated``, ``zone``: as for ``add``.
    """
    found = []
    for file in paths:
        try:
            record_of(_content(file), stated, zone=zone, named=str(file), now=now)
        except ShaftprintError as refusal:
            found.append(str(refusal))
    return found


def add_document(
    store: Store,
    document: bytes,
    *,
    named: str,
    now: datetime,
    stated: Stated = NOTHING_STATED,
    zone: tzinfo | None = None,
) -> Added:
    """Put the document of a fingerprint into a store, as ``add`` does with a file.

    Parameters
    ----------
    store, now, stated, zone
        As for ``add``.
    document
        Content of a fingerprint's file.
    named
        What it is called in an error.
    """
    record = record_of(document, stated, zone=zone, named=named, now=now)
    ship = Ship(name=record.ship.name, imo_number=record.ship.imo_number, class_name=record.ship.class_name)
    with store.database.writing() as connection:
        (added,) = store.database.writer(connection).put([(record, ship, now)], newest_names=True)
    return added


def _content(file: Path) -> bytes:
    """Return the content of a file, but for what is beyond the longest document."""
    try:
        with file.open("rb") as opened:
            return opened.read(MOST_BYTES + 1)
    except FileNotFoundError:
        raise StoreError(
            f"{file}: expected a fingerprint in JSON, found nothing there; name the file, or the folder in which "
            f"identify or demo has put it.{meant_beside(file)}"
        ) from None
    except OSError as refusal:
        raise StoreError(f"{file}: expected a fingerprint, but it cannot be read: {reason(refusal)}.") from None
