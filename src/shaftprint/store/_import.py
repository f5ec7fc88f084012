"""The records of an export are put into a store, all of them or none; what is there already is not put in twice."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from shaftprint.arguments import refusing_none
from shaftprint.errors import FingerprintError, StoreError
from shaftprint.files import reason
from shaftprint.late import late
from shaftprint.store._fields import moment_of, short_text
from shaftprint.store._job import Job
from shaftprint.store._job_lines import job_of_content
from shaftprint.store._lines import HEADER, LONGEST_LINE, record_of_line
from shaftprint.store._nouns import KINDS, Event, Line, Ship
from shaftprint.store._record import Record, record_of
from shaftprint.store._stated import Stated, possible_time
from shaftprint.store._store import Store, part_with_database
from shaftprint.store._text import LONGEST_TEXT

with late():
    from shaftprint.vessel._ship import is_imo_number

if TYPE_CHECKING:
    from shaftprint.store.database._ledger import Ledger
    from shaftprint.store.database._writer import Writer

_AT_A_TIME = 200


@dataclass(frozen=True, kw_only=True, slots=True)
class Imported:
    """What an import has put in."""

    fingerprints: int
    """Fingerprints that were not there."""
    known: int
    """Fingerprints that were there already."""
    events: int
    """Events that were not there."""
    jobs: int
    """Jobs that were not there."""


@refusing_none(StoreError)
def import_store(store: Store, path: str | Path, *, now: datetime | None = None) -> Imported:
    """Put all records of an export into a store, or none.

    Parameters
    ----------
    store
        The store.
    path
        The file.
    now
        The present time; by the clock of this computer where it is not given.

    Raises
    ------
    StoreError
        If the file cannot be read, was cut off or changed, or a record cannot be kept.
    """
    file = Path(path)
    try:
        with store.database.writing() as connection:
            return _put(store.database.writer(connection), store.database.ledger(connection), file, now)
    except OSError as refusal:
        raise StoreError(f"{file}: expected an export of a store, but it cannot be read: {reason(refusal)}.") from None


def _put(writer: Writer, ledger: Ledger, file: Path, now: datetime | None) -> Imported:
    put_jobs = part_with_database().put_jobs
    waiting: list[tuple[Record, Ship, datetime]] = []
    asked: list[Job] = []
    counts = {"added": 0, "known": 0, "events": 0, "jobs": 0}

    def settle() -> None:
        for one in writer.put(waiting, newest_names=False):
            counts["known" if one.outcome == "known" else "added"] += 1
        # after them: which jobs are done the fingerprints say that are there by now
        counts["jobs"] += put_jobs(ledger, asked)
        waiting.clear()
        asked.clear()

    for named, record in _records(file):
        try:
            match record["kind"]:
                case "ship":
                    writer.fleet.ship_id(_ship(record, record.get("class_name")), named=named)
                case "line":
                    ship_id = writer.fleet.ship_id(_ship(record["ship"]), named=named)
                    writer.fleet.line_id(ship_id, short_text(record["position"], "shaft line"))
                case "event":
                    counts["events"] += _put_event(writer, record, named, now)
                case "fingerprint":
                    waiting.append(_fingerprint(record, named, now))
                case "job":
                    asked.append(job_of_content(record))
                case kind:
                    raise StoreError(f"expected a ship, line, event, fingerprint or job, found {kind[:40]!r}")
            if len(waiting) + len(asked) == _AT_A_TIME:
                settle()
        except (
            KeyError,
            TypeError,
            ValueError,
            OverflowError,
            AttributeError,
            StoreError,
            FingerprintError,
        ) as fault:
            raise StoreError(_sentence(named, fault)) from None
    settle()
    return Imported(fingerprints=counts["added"], known=counts["known"], events=counts["events"], jobs=counts["jobs"])


def _sentence(named: str, fault: Exception) -> str:
    if isinstance(fault, StoreError | FingerprintError):
        words = str(fault)
        return words if words.startswith(named) else f"{named}: {words}"
    return f"{named}: expected a record of a store's export, found one with a field that is missing or of another kind."


def _records(file: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Give the records of a file with the name of each; the end of the file is held against what was read."""
    digest, count = hashlib.sha256(), 0
    with file.open("rb") as opened:
        first = opened.readline(LONGEST_LINE)
        if not first or record_of_line(first, named=f"{file}, line 1") != HEADER:
            raise StoreError(f"{file}: expected an export of a store of format 1, found another file.")
        digest.update(first)
        while line := opened.readline(LONGEST_LINE):
            named = f"{file}, line {count + 2}"
            record = record_of_line(line, named=named)
            if record["kind"] == "end":
                if (record.get("records"), record.get("sha256")) != (count, digest.hexdigest()) or opened.read(1):
                    raise StoreError(
                        f"{file}: it is not as it was written: its end states another content; export it again."
                    )
                return
            digest.update(line)
            count += 1
            yield named, record
    raise StoreError(f"{file}: expected a record that ends the file, found none: it was cut off; export it once more.")


def _ship(content: Mapping[str, Any], class_name: object = None) -> Ship:
    number = content["imo_number"]
    if number is not None and (type(number) is not int or not is_imo_number(number)):
        raise StoreError(f"expected an IMO number, found {str(number)[:40]!r}")
    of_class = None if class_name is None else short_text(class_name, "class of ships")
    return Ship(name=short_text(content["name"], "name of a ship"), imo_number=number, class_name=of_class)


def _put_event(writer: Writer, record: Mapping[str, Any], named: str, now: datetime | None) -> bool:
    ship = _ship(record["ship"])
    line_id = writer.fleet.line_id(writer.fleet.ship_id(ship, named=named), short_text(record["line"], "shaft line"))
    if record["what"] not in KINDS:
        raise StoreError(f"expected what was done, one of {', '.join(KINDS)}, found {str(record['what'])[:40]!r}")
    event = Event(
        line=Line(ship=ship, position=record["line"]),
        at=moment_of(record["at"]),
        kind=record["what"],
        numbers=tuple(short_text(name, "name of a number") for name in record["numbers"]),
        note=short_text(record["note"], "note", longest=LONGEST_TEXT),
    )
    is_withdrawn = writer.is_withdrawn(event, line_id)
    if record.get("withdrawn") is None:
        possible_time(event.at, now=now, named=f"{named}: {event.kind}; withdraw it in the store that it comes from")
        # withdrawn is withdrawn, whatever an older export says
        return not is_withdrawn and writer.event(event, line_id)
    is_new = not is_withdrawn and writer.event(event, line_id)
    writer.withdraw(event, line_id, why=short_text(record["withdrawn"], "reason", longest=LONGEST_TEXT))
    return is_new


def _fingerprint(content: Mapping[str, Any], named: str, now: datetime | None) -> tuple[Record, Ship, datetime]:
    said = dict(content["stated"])
    if "tested_at" in said:
        said["tested_at"] = moment_of(said["tested_at"])
    record = record_of(content["document"].encode(), Stated(**said), named=named, now=now)
    if record.sha256 != content["sha256"]:
        raise StoreError(f"{named}: its document is not as it was written; export it once more.")
    ship = _ship(content["ship"])
    if record.ship.line != content["line"] or record.ship.imo_number not in (None, ship.imo_number):
        raise StoreError(f"{named}: its document is of another ship or line than the record; export it once more.")
    return record, ship, moment_of(content["added_at"])
