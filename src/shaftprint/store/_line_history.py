"""The tests of one line as ``drift`` takes them: fingerprints with their times, and what was done between them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.late import late
from shaftprint.store._document import SHOWN_HASH
from shaftprint.store._find import lines_called, name_of, ship_called
from shaftprint.store._history import document
from shaftprint.store._nouns import Event as StoredEvent
from shaftprint.store._nouns import Line, Ship, StoredFingerprint
from shaftprint.store._store import Store

with late():
    from shaftprint.drift._dated import Event
    from shaftprint.drift._history import history_of
    from shaftprint.fingerprint._json_file import parse_fingerprint

if TYPE_CHECKING:
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineHistory:
    """What is known of a line over the years."""

    line: Line
    """The line."""
    fingerprints: dict[str, LineFingerprint] = field(repr=False)
    """Its fingerprints by the time of their test; of one recording also those of other versions of the program, which
    show whether these find the same."""
    events: tuple[Event, ...]
    """What was done to it."""


@refusing_none(StoreError)
def line_history(store: Store, ship: str | Ship, *, line: str | None = None, newest: int | None = None) -> LineHistory:
    """Return the fingerprints of one line in the order of time, with the times that the store knows of them.

    ``ship``: name or IMO number of the ship, or the ship itself. ``line``: which of its lines; a ship with one line
    needs none. ``newest``: how many tests that can be judged are wanted, the newest ones, with all that tells what was
    done before them: other documents are not read. All when not given. Raises StoreError if there is no such ship or
    line, it has no test, or it is not said which of several lines.
    """
    tested, kept, stated = _records(store, ship, line)
    events = tuple(
        Event(kind=event.kind, at=event.at, numbers=event.numbers, note=event.note)
        for event in stated
        if event.line.position == tested.position and event.withdrawn is None
    )
    names, recordings = _names(kept), list(_of_each_version(kept).values())
    read: dict[str, LineFingerprint] = {}
    count = len(recordings) if newest is None else newest
    while True:
        begin = _tested_at(recordings[-min(count, len(recordings))])
        for one in _wanted(recordings, begin):
            if one.sha256 not in read:
                read[one.sha256] = _read(store, one, names[one.sha256])
        # in the order of time, whatever was read first
        in_order = (one.sha256 for of_test in recordings for one in of_test.values())
        fingerprints = {names[one]: read[one] for one in in_order if one in read}
        if newest is None or count >= len(recordings) or _judged(fingerprints, events, begin) >= newest:
            return LineHistory(line=tested, fingerprints=fingerprints, events=events)
        count *= 2


def _records(
    store: Store, ship: str | Ship, line: str | None
) -> tuple[Line, list[StoredFingerprint], list[StoredEvent]]:
    """Return a line, what is kept of its fingerprints in the order of time, and what was done to its ship."""
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        wanted = lines_called(reader, ship_called(reader, ship), () if line is None else (line,))
        kept = list(reader.fingerprints(wanted, superseded=True).values())
        events = reader.events(wanted)
    lines = list(dict.fromkeys(one.line.position for one in kept))
    if len(lines) != 1:
        raise StoreError(
            f"{name_of(ship)}: expected one shaft line, found {', '.join(lines) if lines else 'no test'}; "
            f"{'name it with --line' if lines else 'add its fingerprints with shaftprint store add'}."
        )
    return kept[0].line, kept, events


def _names(kept: Sequence[StoredFingerprint]) -> dict[str, str]:
    """Return what each fingerprint is called, by its SHA-256, the time of its test, and more where two have it."""
    names: dict[str, str] = {}
    taken: set[str] = set()
    for of_test in _of_each_version(kept).values():
        for one in of_test.values():
            name = f"{one.trial.tested_at:%Y-%m-%d %H:%M}"
            names[one.sha256] = f"{name} {one.sha256[:SHOWN_HASH]}" if name in taken else name
            taken.add(names[one.sha256])
    return names


def _of_each_version(kept: Sequence[StoredFingerprint]) -> dict[str, dict[str, StoredFingerprint]]:
    """Return of each recording the last fingerprint of every version of the program, that which counts last."""
    by_recording: dict[str, dict[str, StoredFingerprint]] = {}
    for one in kept:
        of_test = by_recording.setdefault(one.trial.recording_sha256 or one.sha256, {})
        of_test.pop(one.version, None)
        of_test[one.version] = one
    return by_recording


def _wanted(recordings: Sequence[Mapping[str, StoredFingerprint]], begin: datetime) -> Iterator[StoredFingerprint]:
    """Yield the fingerprints of the recordings since a time, and of those that show whether their versions agree."""
    versions = {version for one in recordings if _tested_at(one) >= begin for version in one}
    for one in recordings:
        if _tested_at(one) >= begin or len(versions & set(one)) > 1:
            yield from one.values()


def _tested_at(of_test: Mapping[str, StoredFingerprint]) -> datetime:
    return next(iter(of_test.values())).trial.tested_at


def _read(store: Store, kept: StoredFingerprint, name: str) -> LineFingerprint:
    return parse_fingerprint(document(store, kept.sha256), named=name).dated(kept.trial.tested_at)


def _judged(fingerprints: dict[str, LineFingerprint], events: tuple[Event, ...], begin: datetime) -> int:
    """Return how many tests since a time can be judged."""
    return sum(test.at >= begin for test in history_of(fingerprints, events).tests)
