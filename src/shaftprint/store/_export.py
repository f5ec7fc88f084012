"""The whole store in one file, as it is at one instant, and the same file whichever database it is in."""

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.files import reason, written_whole
from shaftprint.store._check import line_faults
from shaftprint.store._document import SHOWN_HASH, document_sha256, inflated
from shaftprint.store._job import JOB_STATES, Job
from shaftprint.store._job_lines import job_content
from shaftprint.store._lines import HEADER, event_content, line_of, ship_content
from shaftprint.store._nouns import Fault, Line
from shaftprint.store._stated import utc_iso
from shaftprint.store._store import Store

if TYPE_CHECKING:
    from shaftprint.store.database._ledger import Ledger
    from shaftprint.store.database._reader import Reader

_AT_A_TIME = 500


@refusing_none(StoreError)
def export_store(
    store: Store, path: str | Path, *, overwrite: bool = False, report: Callable[[Fault], None] | None = None
) -> int:
    """Write all records of a store as JSON lines, whole or not at all, and return how many.

    Others may write into the store meanwhile: the file holds what was there when it was begun.

    Parameters
    ----------
    store
        The store.
    path
        File to write.
    overwrite
        Whether an existing file may be replaced.
    report
        Is told of each record that is not as it was written and whose document is whole: the file holds documents, and
        the numbers follow from them. Without it such a record is refused.

    Raises
    ------
    StoreError
        If the file cannot be written, or a record is damaged.
    """
    file, digest, count = Path(path), hashlib.sha256(), 0
    try:
        with written_whole(file, overwrite=overwrite) as part, part.open("wb") as opened:
            for line in _lines(store, report or _refuse):
                opened.write(line)
                digest.update(line)
                count += 1
            # the header is no record
            count -= 1
            opened.write(line_of({"kind": "end", "records": count, "sha256": digest.hexdigest()}))
    except FileExistsError:
        raise StoreError(f"{file}: it exists already; choose another name.") from None
    except OSError as refusal:
        raise StoreError(f"{file}: the store cannot be written there: {reason(refusal)}.") from None
    return count


def _refuse(fault: Fault) -> None:
    raise StoreError(f"{fault.record}: {fault.found}; shaftprint store check says what else is.")


def _lines(store: Store, report: Callable[[Fault], None]) -> Iterator[bytes]:
    yield line_of(HEADER)
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        ships = reader.ships()
        for one in ships:
            yield line_of({"kind": "ship", "class_name": one.ship.class_name} | ship_content(one.ship))
        lines = reader.lines(ships)
        for line in lines.values():
            yield line_of({"kind": "line", "ship": ship_content(line.ship), "position": line.position})
        for key, line in lines.items():
            events = sorted(reader.events({key: line}), key=lambda event: (event.at, event.kind))
            yield from (line_of(event_content(event)) for event in events)
        for key, line in lines.items():
            yield from _fingerprints(reader, {key: line}, report)
        # after what they have given
        yield from (line_of(job_content(job)) for job in _jobs(store.database.ledger(connection)))


def _jobs(ledger: "Ledger") -> Iterator[Job]:
    """Give all jobs in the order of their numbers, not all at once."""
    last = 0
    while some := ledger.all(JOB_STATES, after=last, most=_AT_A_TIME):
        yield from some
        last = some[-1].id


def _fingerprints(reader: "Reader", line: Mapping[int, Line], report: Callable[[Fault], None]) -> Iterator[bytes]:
    """Give the fingerprints of a line by time; those of one recording in the order of their chain."""
    found = reader.fingerprints(line, superseded=True)
    # here, for databases put letters and missing ones in different orders
    keys = sorted(
        found,
        key=lambda key: (
            found[key].trial.tested_at,
            found[key].trial.recording_sha256 or "",
            found[key].made_at,
            key,
        ),
    )
    stated = reader.stated(keys)
    for key, kept in reader.documents(keys):
        one = found[key]
        named = f"fingerprint {one.sha256[:SHOWN_HASH]}"
        content = inflated(kept, named=named)
        if document_sha256(content) != one.sha256:
            raise StoreError(f"{named}: its document is not as it was written: shaftprint store check.")
        yield line_of(
            {
                "kind": "fingerprint",
                "ship": ship_content(one.line.ship),
                "line": one.line.position,
                "stated": json.loads(stated[key]),
                "added_at": utc_iso(one.added_at),
                "sha256": one.sha256,
                "document": content.decode(),
            }
        )
    # after the documents: one of them that is damaged is refused by itself
    for fault in line_faults(reader, list(line), found):
        report(fault)
