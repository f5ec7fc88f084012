"""What a page shows of a store: its lines as they stand, all that is kept of one line, and one fingerprint."""

from dataclasses import dataclass, fields, replace

from shaftprint.arguments import refusing_none
from shaftprint.errors import StoreError
from shaftprint.store._find import ship_called
from shaftprint.store._nouns import Event, HistoryEntry, Line, LineSummary, Ship, StoredFingerprint
from shaftprint.store._store import Store, part_with_database


@dataclass(frozen=True, kw_only=True, slots=True)
class LineNow(LineSummary):
    """A line with its newest test, and a word that changes with every test and event of it."""

    ship_id: int
    """Number of the ship in this database."""
    state: str
    """Another word after each fingerprint and event that is put in."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LineRecords:
    """All that a store keeps of a line."""

    ship_id: int
    """Number of the ship in this database."""
    line: Line
    """The line."""
    entries: tuple[HistoryEntry, ...]
    """Its tests, none of which was superseded, in the order of time."""
    events: tuple[Event, ...]
    """What was done to it."""
    state: str
    """Another word after each fingerprint and event that is put in."""


@refusing_none(StoreError)
def lines_now(store: Store, *, number: str | None = None) -> tuple[LineNow, ...]:
    """Return every line of a store as it stands, by IMO number and name of the ship.

    ``number``: name of a number that is wanted of its newest test; None for none.
    """
    part = part_with_database()
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        ships = reader.ships()
        ship_of = {one.ship: one.id for one in ships}
        states = part.line_states(connection)
        keys = list(reader.lines(ships))
        return tuple(
            LineNow(
                **{field.name: getattr(one, field.name) for field in fields(one)},
                ship_id=ship_of[one.line.ship],
                state=states.get(key, ""),
            )
            for key, one in zip(keys, reader.summaries(number=number), strict=True)
        )


@refusing_none(StoreError)
def store_state(store: Store) -> str:
    """Return a word that changes with every fingerprint and event that is put into a store."""
    part = part_with_database()
    with store.database.reading() as connection:
        return str(part.store_state(connection))


@refusing_none(StoreError)
def line_records(store: Store, *, position: str, imo_number: int | None = None, ship_id: int = 0) -> LineRecords | None:
    """Return all that is kept of one line; None where there is no such line.

    ``position``: which line of the ship. ``imo_number``: IMO number of the ship; None for a ship without one.
    ``ship_id``: number of that ship in this database.
    """
    part = part_with_database()
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        ships = reader.ships(imo_number=imo_number)
        ships = [one for one in ships if imo_number is not None or (one.id == ship_id and one.ship.imo_number is None)]
        lines = {key: line for key, line in reader.lines(ships).items() if line.position == position} if ships else {}
        if not lines:
            return None
        states = part.line_states(connection, list(lines))
        (key,) = lines
        return LineRecords(
            ship_id=ships[0].id,
            line=lines[key],
            entries=tuple(reader.entries(lines)),
            events=tuple(reader.events(lines)),
            state=states.get(key, ""),
        )


@refusing_none(StoreError)
def namesakes(store: Store, name: str, *, imo_number: int | None = None) -> tuple[Ship, ...]:
    """Return the ships that have a name now, and the one that has an IMO number."""
    with store.database.reading() as connection:
        reader = store.database.reader(connection)
        found = [] if "\0" in name else reader.ships(name=name)
        found += [] if imo_number is None else reader.ships(imo_number=imo_number)
    return tuple(dict.fromkeys(one.ship for one in found))


@refusing_none(StoreError)
def give_imo_number(store: Store, ship: Ship, imo_number: int) -> Ship:
    """Give a ship without an IMO number its number, and return it with that.

    Raises StoreError if there is no such ship, or another one has that number.
    """
    numbered = replace(ship, imo_number=imo_number)
    with store.database.writing() as connection:
        reader = store.database.reader(connection)
        found = ship_called(reader, replace(ship, imo_number=None))
        if reader.ships(imo_number=imo_number):
            raise StoreError(
                f"IMO {imo_number}: expected a number that no ship in the store has, found one that has it."
            )
        store.database.writer(connection).fleet.change_ship(found.id, numbered)
    return numbered


@refusing_none(StoreError)
def stored_fingerprint(store: Store, sha256: str) -> StoredFingerprint | None:
    """Return what is kept of a fingerprint beside its document; None where there is none."""
    part = part_with_database()
    with store.database.reading() as connection:
        found: StoredFingerprint | None = part.fingerprint_called(store.database.reader(connection), sha256)
    return found
