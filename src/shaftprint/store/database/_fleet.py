"""Ships and their lines in a store that is written: found by IMO number or name, put in where they are new."""

from collections.abc import Mapping
from typing import Any, Final

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._nouns import Line, Ship
from shaftprint.store.database._rows import ship_of_row
from shaftprint.store.database._seal import sealed
from shaftprint.store.database._tables import LINE, SHIP

OTHER_SHIP: Final = (
    "its ship is not in the store as it was when this was asked for; ask for it again from the page of its line"
)
"""Said where a name has become that of another ship: of that one nothing is told."""


class Fleet:
    """The ships and lines that are there, looked up when they are needed, with what is put in."""

    def __init__(self, connection: sa.Connection) -> None:
        self.connection = connection
        # what was looked up or put in since the transaction began; nobody else writes meanwhile
        self._ships: dict[int, Ship] = {}
        self._by_number: dict[int, int | None] = {}
        self._by_name: dict[str, set[int]] = {}
        self._lines: dict[tuple[int, str], int | None] = {}
        self._places: dict[int, tuple[int, str]] = {}

    def line(self, line_id: int) -> Line:
        """Return a line by its number."""
        if line_id not in self._places:
            row = self.connection.execute(sa.select(LINE).where(LINE.c.id == line_id)).one()
            self._places[line_id] = (row.ship_id, row.position)
        ship_id, position = self._places[line_id]
        return Line(ship=self._ship(ship_id), position=position)

    def ship_id(self, ship: Ship, *, named: str, exactly: bool = False) -> int:
        """Return the number of a ship: by its IMO number, else by its name; a new one is put in.

        A ship that had no IMO number gets it when it is first stated.

        ``named``: what states it, for errors. ``exactly``: whether a name counts among ships without an IMO number
        only, and gives none a number: who may write to a ship that has a name has no right to another one of that name.
        Raises StoreError if several ships have the name and no IMO number says which; or exactly that ship is not
        there, and another one is called so.
        """
        if ship.imo_number is not None:
            same = self._with_number(ship.imo_number)
            if same is not None:
                return same
        alike = self._with_name(ship.name)
        if exactly:
            return self._same_ship(ship, alike, named=named)
        if ship.imo_number is None:
            if len(alike) > 1:
                numbers = ", ".join(sorted(f"IMO {self._ships[key].imo_number or 'unknown'}" for key in alike))
                raise StoreError(f"{named}: expected one ship of the name {ship.name!r}, found {numbers}; state --imo.")
            return next(iter(alike)) if alike else self._new_ship(ship)
        without = [key for key in alike if self._ships[key].imo_number is None]
        if without:
            self.change_ship(without[0], ship)
            return without[0]
        return self._new_ship(ship)

    def _same_ship(self, ship: Ship, alike: set[int], *, named: str) -> int:
        without = [key for key in alike if self._ships[key].imo_number is None]
        if ship.imo_number is None and without:
            return without[0]
        if without if ship.imo_number is not None else alike:
            raise StoreError(f"{named}: {OTHER_SHIP}.")
        return self._new_ship(ship)

    def line_id(self, ship_id: int, position: str) -> int:
        """Return the number of a line of a ship; a new one is put in."""
        key = (ship_id, position)
        if key not in self._lines:
            same = sa.and_(LINE.c.ship_id == ship_id, LINE.c.position == position)
            self._lines[key] = self.connection.execute(sa.select(LINE.c.id).where(same)).scalar()
        found = self._lines[key]
        if found is None:
            found = self._lines[key] = self._free(LINE)
            self._insert(LINE, {"id": found, "ship_id": ship_id, "position": position})
        self._places[found] = key
        return found

    def _ship(self, number: int) -> Ship:
        if number not in self._ships:
            self._ships[number] = ship_of_row(self.connection.execute(sa.select(SHIP).where(SHIP.c.id == number)).one())
        return self._ships[number]

    def _with_number(self, imo_number: int) -> int | None:
        if imo_number not in self._by_number:
            row = self.connection.execute(sa.select(SHIP).where(SHIP.c.imo == imo_number)).first()
            self._by_number[imo_number] = None if row is None else row.id
            if row is not None:
                self._ships[row.id] = ship_of_row(row)
        return self._by_number[imo_number]

    def _with_name(self, name: str) -> set[int]:
        if name not in self._by_name:
            rows = self.connection.execute(sa.select(SHIP).where(SHIP.c.name == name)).all()
            self._ships |= {row.id: ship_of_row(row) for row in rows}
            self._by_name[name] = {row.id for row in rows}
        return self._by_name[name]

    def change_ship(self, number: int, ship: Ship) -> None:
        """Let a ship have another name or class, and an IMO number if it had none."""
        known = self._ship(number)
        changed = Ship(
            name=ship.name,
            imo_number=known.imo_number or ship.imo_number,
            class_name=ship.class_name or known.class_name,
        )
        if changed != known:
            row = _row(number, changed)
            self.connection.execute(SHIP.update().where(SHIP.c.id == number).values(**sealed(SHIP, row)))
            self._with_name(known.name).discard(number)
            self._remember(number, changed)

    def _new_ship(self, ship: Ship) -> int:
        number = self._free(SHIP)
        self._insert(SHIP, _row(number, ship))
        self._remember(number, ship)
        return number

    def _remember(self, number: int, ship: Ship) -> None:
        self._ships[number] = ship
        self._with_name(ship.name).add(number)
        if ship.imo_number is not None:
            self._by_number[ship.imo_number] = number

    def _free(self, table: sa.Table) -> int:
        return (self.connection.execute(sa.select(sa.func.max(table.c.id))).scalar() or 0) + 1

    def _insert(self, table: sa.Table, row: Mapping[str, Any]) -> None:
        self.connection.execute(table.insert(), sealed(table, row))


def _row(number: int, ship: Ship) -> dict[str, Any]:
    return {"id": number, "imo": ship.imo_number, "name": ship.name, "class_of": ship.class_name}
