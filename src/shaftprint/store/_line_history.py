"""The tests of one line as ``drift`` takes them: fingerprints with their times, and what was done between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.store._history import SHOWN_HASH, document, history
from shaftprint.store._late_rooms import drift_room, fingerprint_room
from shaftprint.store._nouns import Line, StoredFingerprint
from shaftprint.store._store import Store

if TYPE_CHECKING:
    from shaftprint.drift import Event
    from shaftprint.fingerprint import Fingerprint


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineHistory:
    """What is known of a line over the years."""

    line: Line
    """The line."""
    fingerprints: "dict[str, Fingerprint]" = field(repr=False)
    """Its fingerprints by the time of their test; of one recording also those of other versions of the program, which
    show whether these find the same."""
    events: "tuple[Event, ...]"
    """What was done to it."""


@refusing_none(StoreError)
def line_history(store: Store, ship: str, *, line: str | None = None) -> LineHistory:
    """Return the fingerprints of one line in the order of time, with the times that the store knows of them.

    Parameters
    ----------
    store
        The store.
    ship
        Name or IMO number of the ship.
    line
        Which of its lines; a ship with one line needs none.

    Raises
    ------
    StoreError
        If there is no such ship or line, it has no test, or it is not said which of several lines.
    """
    found = history(store, ship, lines=() if line is None else (line,), superseded=True)
    lines = list(dict.fromkeys(entry.fingerprint.line.position for entry in found.entries))
    if len(lines) != 1:
        raise StoreError(
            f"{ship}: expected one shaft line, found {', '.join(lines) if lines else 'no test'}; "
            f"{'name it with --line' if lines else 'add its fingerprints with shaftprint store add'}."
        )
    fingerprints: dict[str, Fingerprint] = {}
    parse, event_of = fingerprint_room().parse_fingerprint, drift_room().Event
    for kept in _of_each_version([entry.fingerprint for entry in found.entries]):
        name = f"{kept.trial.tested_at:%Y-%m-%d %H:%M}"
        name = f"{name} {kept.sha256[:SHOWN_HASH]}" if name in fingerprints else name
        fingerprint = parse(document(store, kept.sha256), named=name)
        conditions = fingerprint.conditions.model_copy(update={"tested_at": kept.trial.tested_at})
        fingerprints[name] = fingerprint.model_copy(update={"conditions": conditions})
    events = tuple(
        event_of(kind=event.kind, at=event.at, numbers=event.numbers, note=event.note)
        for event in found.events
        if event.line.position == lines[0]
    )
    return LineHistory(line=found.entries[0].fingerprint.line, fingerprints=fingerprints, events=events)


def _of_each_version(kept: Sequence[StoredFingerprint]) -> Iterator[StoredFingerprint]:
    """Yield the fingerprints that count, before each the last one that every other version made of its recording."""
    by_recording: dict[str, dict[str, StoredFingerprint]] = {}
    for one in kept:
        of_test = by_recording.setdefault(one.trial.recording_sha256 or one.sha256, {})
        of_test.pop(one.version, None)
        of_test[one.version] = one
    for of_test in by_recording.values():
        yield from of_test.values()
