"""What is put into a store. Rows get their numbers here: the one connection that writes knows which are free."""

import json
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, Literal

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._document import deflated
from shaftprint.store._nouns import Added, Event, Line, Ship, StoredNumber
from shaftprint.store._record import Record
from shaftprint.store.database._chains import Chains, Link
from shaftprint.store.database._fleet import OTHER_SHIP, Fleet
from shaftprint.store.database._rows import WITHDRAWN
from shaftprint.store.database._seal import sealed
from shaftprint.store.database._tables import DOCUMENT, EVENT, FINGERPRINT, LINE, QUANTITY, TRIAL, VALUE


class Writer:
    """The one connection that writes."""

    def __init__(self, connection: sa.Connection) -> None:
        self.connection = connection
        self.fleet = Fleet(connection)
        self._quantities = {(row.kind, row.name, row.unit): row.id for row in connection.execute(sa.select(QUANTITY))}
        highest = ((table, connection.execute(sa.select(sa.func.max(table.c.id))).scalar()) for table in _NUMBERED)
        self._last = {table.name: last or 0 for table, last in highest}

    def event(self, event: Event, line_id: int) -> bool:
        """Put in what was done to a line; return whether it was not there.

        Raises StoreError if the same was done at that time with another note or other numbers.
        """
        numbers = json.dumps(event.numbers)
        same = sa.and_(EVENT.c.line_id == line_id, EVENT.c.at == event.at, EVENT.c.kind == event.kind)
        found = self.connection.execute(sa.select(EVENT).where(same)).first()
        if found is not None and (found.numbers_affected, found.note) != (numbers, event.note):
            raise StoreError(
                f"expected no {event.kind} of {event.line.ship.name!r} at that time, found one with another note or "
                "other numbers, which stays as it is; state another time."
            )
        if found is None:
            row = {
                "line_id": line_id,
                "at": event.at,
                "kind": event.kind,
                "numbers_affected": numbers,
                "note": event.note,
            }
            self._insert(EVENT, [{"id": self._number(EVENT)} | row])
        return found is None

    def withdraw(self, event: Event, line_id: int, *, why: str) -> bool:
        """Let an event count no more; return whether it did until now.

        Raises StoreError if there is none of that time and kind.
        """
        same = sa.and_(EVENT.c.line_id == line_id, EVENT.c.at == event.at, EVENT.c.kind == event.kind)
        if self.connection.execute(sa.select(EVENT.c.id).where(same)).first() is None:
            raise StoreError(
                f"expected a {event.kind} of {event.line.ship.name!r}, {event.line.position}, at that time, found "
                "none; shaftprint store history shows what was done and when."
            )
        if self.is_withdrawn(event, line_id):
            return False
        row = {"line_id": line_id, "at": event.at, "kind": f"{WITHDRAWN}{event.kind}", "note": why}
        self._insert(EVENT, [{"id": self._number(EVENT), "numbers_affected": "[]"} | row])
        return True

    def is_withdrawn(self, event: Event, line_id: int) -> bool:
        """Return whether an event of that time and kind was withdrawn."""
        kind = f"{WITHDRAWN}{event.kind}"
        same = sa.and_(EVENT.c.line_id == line_id, EVENT.c.at == event.at, EVENT.c.kind == kind)
        return self.connection.execute(sa.select(EVENT.c.id).where(same)).first() is not None

    def put(
        self, records: Sequence[tuple[Record, Ship, datetime]], *, newest_names: bool, only: Line | None = None
    ) -> list[Added]:
        """Put in fingerprints, and say of each what became of it.

        ``records``: the fingerprints, with the ship of each and when each was added. ``newest_names``: whether a ship
        takes name and class of its newest test. ``only``: the line to which they belong; None where each says it by
        itself. Raises StoreError if one belongs to another line than that.
        """
        chains = Chains.of(self.connection, [record for record, _, _ in records])
        added_at: dict[str, datetime] = {}
        outcomes = []
        for record, ship, when in records:
            outcomes.append(self._added(chains, record, ship, newest_names=newest_names, only=only))
            added_at.setdefault(record.sha256, when)
        new = [(one, one.record) for one in chains.new if one.record is not None]
        rows = (_row(one, record, chains.trial_of[one.id], added_at[one.sha256]) for one, record in new)
        self._insert(TRIAL, chains.new_trials)
        self._insert(FINGERPRINT, list(rows))
        for row in chains.restated.values():
            self._update(TRIAL, row)
        self._relink(chains.changed)
        self._keep(DOCUMENT, [{"fingerprint_id": one.id, "content": deflated(record.document)} for one, record in new])
        self._keep_values([value for one, record in new for value in self._values(one.id, record.numbers)])
        return outcomes

    def _added(self, chains: Chains, record: Record, ship: Ship, *, newest_names: bool, only: Line | None) -> Added:
        named = f"fingerprint {record.sha256[:12]}"
        if only is not None:
            _expect_line(only, ship, record.ship.line, named=named)
        known = chains.known.get(record.sha256)
        if known is not None:
            there = self.fleet.line(known)
            if only is not None:
                _expect_line(only, there.ship, there.position, named=named)
            return Added(line=there, sha256=record.sha256, outcome="known")
        ship_id = self.fleet.ship_id(ship, named=named, exactly=only is not None)
        if newest_names and self._is_newest(ship_id, record.trial.tested_at):
            self.fleet.change_ship(ship_id, ship)
        line_id = self.fleet.line_id(ship_id, record.ship.line)
        link = Link(id=self._number(FINGERPRINT), made_at=record.made_at, sha256=record.sha256, record=record)
        before, after = chains.add(link, line_id, trial_id=self._number(TRIAL))
        outcome: Literal["added", "supersedes", "superseded"] = "added"
        if before is not None or after is not None:
            outcome = "supersedes" if after is None else "superseded"
        other = after or before
        return Added(
            line=self.fleet.line(line_id),
            sha256=record.sha256,
            outcome=outcome,
            other=None if other is None else other.sha256,
        )

    def _is_newest(self, ship_id: int, tested_at: datetime) -> bool:
        """Return whether no later test of a ship is there."""
        newest = sa.select(sa.func.max(TRIAL.c.tested_at)).join(LINE, LINE.c.id == TRIAL.c.line_id)
        found = self.connection.execute(newest.where(LINE.c.ship_id == ship_id)).scalar()
        return found is None or tested_at >= found

    def _relink(self, changed: Sequence[Link]) -> None:
        """Say of fingerprints whose place they took; at no time do two of them say the same."""
        for one in changed:
            if one.was is not None:
                self.connection.execute(FINGERPRINT.update().where(FINGERPRINT.c.id == one.id).values(supersedes=None))
        for one in changed:
            found = self.connection.execute(sa.select(FINGERPRINT).where(FINGERPRINT.c.id == one.id)).one()
            self._update(FINGERPRINT, dict(found._mapping) | {"supersedes": one.supersedes})

    def _values(self, fingerprint_id: int, numbers: Sequence[StoredNumber]) -> list[tuple[Any, ...]]:
        """Return rows for numbers, in the order of the columns."""
        return [
            (fingerprint_id, self._quantity_id(one), one.value, one.std, one.low, one.high, one.trusted)
            for one in numbers
        ]

    def _keep_values(self, rows: Sequence[tuple[Any, ...]]) -> None:
        """Put in numbers. They are most of all rows: handed to the driver as they are, they cost a third."""
        if rows:
            mark = "?" if self.connection.dialect.paramstyle == "qmark" else "%s"
            names = ", ".join(column.name for column in VALUE.columns)
            marks = ", ".join(mark for _ in VALUE.columns)
            self.connection.exec_driver_sql(f"INSERT INTO value ({names}) VALUES ({marks})", list(rows))  # noqa: S608

    def _quantity_id(self, number: StoredNumber) -> int:
        key = (number.kind, number.name, number.unit)
        found = self._quantities.get(key)
        if found is None:
            found = self._quantities[key] = self._number(QUANTITY)
            self._insert(QUANTITY, [{"id": found, "kind": number.kind, "name": number.name, "unit": number.unit}])
        return found

    def _number(self, table: sa.Table) -> int:
        self._last[table.name] += 1
        return self._last[table.name]

    def _insert(self, table: sa.Table, rows: Sequence[Mapping[str, Any]]) -> None:
        self._keep(table, [sealed(table, row) for row in rows])

    def _keep(self, table: sa.Table, rows: Sequence[Mapping[str, Any]]) -> None:
        if rows:
            self.connection.execute(table.insert(), rows)

    def _update(self, table: sa.Table, row: Mapping[str, Any]) -> None:
        self.connection.execute(table.update().where(table.c.id == row["id"]).values(**sealed(table, row)))


def _expect_line(only: Line, ship: Ship, position: str, *, named: str) -> None:
    """Refuse what belongs to another line than the one that it was asked for."""
    number = only.ship.imo_number
    is_same = ship.imo_number == number and (number is not None or ship.name == only.ship.name)
    if not is_same or position != only.position:
        raise StoreError(f"{named}: {OTHER_SHIP}.")


_NUMBERED = (EVENT, TRIAL, FINGERPRINT, QUANTITY)


def _row(link: Link, record: Record, trial_id: int, added_at: datetime) -> dict[str, Any]:
    return {
        "id": link.id,
        "trial_id": trial_id,
        "made_at": record.made_at,
        "added_at": added_at,
        "sha256": record.sha256,
        "structure": record.structure,
        "version": record.version,
        "vessel_sha256": record.vessel_sha256,
        "trustworthy": record.trustworthy,
        "supersedes": link.was,
        "stated": json.dumps(record.stated, sort_keys=True),
    }
