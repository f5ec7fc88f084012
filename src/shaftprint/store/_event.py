"""What was done to a line between two tests: from then on its numbers may differ, and not by wear."""

from collections.abc import Sequence
from datetime import datetime
from typing import TYPE_CHECKING

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.spelling import meant
from shaftprint.store._find import lines_called, name_of, ship_called
from shaftprint.store._nouns import KINDS, Event, Line, Ship
from shaftprint.store._stated import possible_time
from shaftprint.store._store import Store
from shaftprint.store._text import LONGEST_TEXT, expect_short

if TYPE_CHECKING:
    from shaftprint.store.database._reader import Reader

MOST_NUMBERS = 100


@refusing_none(StoreError)
def record_event(
    store: Store,
    ship: str | Ship,
    kind: str,
    *,
    at: datetime,
    lines: Sequence[str] = (),
    numbers: Sequence[str] = (),
    note: str = "",
    now: datetime | None = None,
) -> tuple[tuple[Event, bool], ...]:
    """Keep what was done to lines of a ship.

    Parameters
    ----------
    store
        The store.
    ship
        Name or IMO number of the ship, or the ship itself.
    kind
        What was done, one of ``KINDS``.
    at
        When, with its offset from UTC.
    lines
        To which of its lines; a ship with one line needs none.
    numbers
        Names of the numbers that it affects.
    note
        What else is to be said.
    now
        The present time; by the clock of this computer where it is not given.

    Returns
    -------
    events
        The event of each line, and whether it is new; the same event is not kept twice.

    Raises
    ------
    StoreError
        If the kind is none, there is no such ship or line, or it is not said which of several lines.
    """
    _expect_kind(kind)
    if kind == "other" and not note:
        raise StoreError("other: expected a note that says what was done, found none; state --note.")
    if at.tzinfo is None:
        raise StoreError(f"expected a time with its offset from UTC, found {at.isoformat(sep=' ')}; state --time-zone.")
    possible_time(at, now=now, named=kind)
    _expect_storable(numbers, note)
    with store.database.writing() as connection:
        reader, writer = store.database.reader(connection), store.database.writer(connection)
        found = _lines_of(reader, ship, lines)
        events = {
            key: Event(line=line, at=at, kind=kind, numbers=tuple(numbers), note=note) for key, line in found.items()
        }
        for key, event in events.items():
            if writer.is_withdrawn(event, key):
                raise StoreError(
                    f"{kind}: expected one that was not withdrawn, found that of {event.line.position} at that time, "
                    "which stays withdrawn; state another minute."
                )
        return tuple((event, writer.event(event, key)) for key, event in events.items())


@refusing_none(StoreError)
def withdraw_event(
    store: Store, ship: str | Ship, kind: str, *, at: datetime, why: str, lines: Sequence[str] = ()
) -> tuple[tuple[Event, bool], ...]:
    """Let what was noted of lines of a ship count no more; it stays in the record, with the reason.

    ``store``, ``ship``, ``kind``, ``at``, ``lines``: as for ``record_event``. ``why``: the reason. Returns the event of
    each line, and whether it counted until now. Raises StoreError if there is no such event, or no reason.
    """
    _expect_kind(kind)
    expect_short(why, "reason for which it is withdrawn", named=kind, longest=LONGEST_TEXT)
    with store.database.writing() as connection:
        reader, writer = store.database.reader(connection), store.database.writer(connection)
        events = {
            key: Event(line=line, at=at, kind=kind, withdrawn=why)
            for key, line in _lines_of(reader, ship, lines).items()
        }
        return tuple((event, writer.withdraw(event, key, why=why)) for key, event in events.items())


def _expect_kind(kind: str) -> None:
    if kind not in KINDS:
        raise StoreError(f"expected {', '.join(KINDS[:-1])} or {KINDS[-1]}, found {kind!r}.{meant(kind, KINDS)}")


def _lines_of(reader: "Reader", ship: str | Ship, lines: Sequence[str]) -> dict[int, Line]:
    found = lines_called(reader, ship_called(reader, ship), lines)
    if len(found) > 1 and not lines:
        names = ", ".join(line.position for line in found.values())
        raise StoreError(
            f"{name_of(ship)}: expected which of its lines, {names}, found none; state --line, also several times."
        )
    return found


def _expect_storable(numbers: Sequence[str], note: str) -> None:
    if len(numbers) > MOST_NUMBERS:
        raise StoreError(f"expected at most {MOST_NUMBERS} numbers that an event affects, found {len(numbers)}.")
    for name in numbers:
        expect_short(name, "name of a number", named="event")
    expect_short(note or None, "note", named="event", longest=LONGEST_TEXT)
