"""Ships and their lines in a store that is written: found by IMO number or name, put in where they are new."""

from collections.abc import Mapping
from typing import Any

import sqlalchemy as sa

from shaftprint.errors import StoreError
from shaftprint.store._nouns import Line, Ship
from shaftprint.store.database._rows import ship_of_row
from shaftprint.store.database._seal import sealed
from shaftprint.store.database._tables import LINE, SHIP


class Fleet:
    """The ships and lines that are there, with what is put in."""

    def __init__(self, connection: sa.Connection) -> None:
        self.connection = connection
        self.ships = {row.id: ship_of_row(row) for row in connection.execute(sa.select(SHIP))}
        self.by_number = {ship.imo_number: key for key, ship in self.ships.items() if ship.imo_number is not None}
        self.by_name: dict[str, set[int]] = {}
        for key, ship in self.ships.items():
            self.by_name.setdefault(ship.name, set()).add(key)
        self.lines = {row.id: (row.ship_id, row.position) for row in connection.execute(sa.select(LINE))}
        self.by_position = {place: key for key, place in self.lines.items()}

    def line(self, line_id: int) -> Line:
        """Return a line by its number."""
        ship_id, position = self.lines[line_id]
        return Line(ship=self.ships[ship_id], position=position)

    def ship_id(self, ship: Ship, *, named: str) -> int:
        """Return the number of a ship: by its IMO number, else by its name; a new one is put in.

        A ship that had no IMO number gets it when it is first stated.

        Raises
        ------
        StoreError
            If several ships have the name and no IMO number says which.
        """
        alike = self.by_name.get(ship.name, set())
        if ship.imo_number is None:
            if len(alike) > 1:
                numbers = ", ".join(sorted(f"IMO {self.ships[key].imo_number or 'unknown'}" for key in alike))
                raise StoreError(f"{named}: expected one ship of the name {ship.name!r}, found {numbers}; state --imo.")
            return next(iter(alike)) if alike else self._new_ship(ship)
        same = self.by_number.get(ship.imo_number)
        without = [key for key in alike if self.ships[key].imo_number is None]
        if same is None and without:
            self.change_ship(without[0], ship)
            return without[0]
        return self._new_ship(ship) if same is None else same

    def line_id(self, ship_id: int, position: str) -> int:
        """Return the number of a line of a ship; a new one is put in."""
        found = self.by_position.get((ship_id, position))
        if found is None:
            found = max(self.lines, default=0) + 1
            self._insert(LINE, {"id": found, "ship_id": ship_id, "position": position})
            self.lines[found] = (ship_id, position)
            self.by_position[ship_id, position] = found
        return found

    def change_ship(self, number: int, ship: Ship) -> None:
        """Let a ship have another name or class, and an IMO number if it had none."""
        known = self.ships[number]
        changed = Ship(
            name=ship.name,
            imo_number=known.imo_number or ship.imo_number,
            class_name=ship.class_name or known.class_name,
        )
        if changed != known:
            row = _row(number, changed)
            self.connection.execute(SHIP.update().where(SHIP.c.id == number).values(**sealed(SHIP, row)))
            self.by_name[known.name].discard(number)
            self._remember(number, changed)

    def _new_ship(self, ship: Ship) -> int:
        number = max(self.ships, default=0) + 1
        self._insert(SHIP, _row(number, ship))
        self._remember(number, ship)
        return number

    def _remember(self, number: int, ship: Ship) -> None:
        self.ships[number] = ship
        self.by_name.setdefault(ship.name, set()).add(number)
        if ship.imo_number is not None:
            self.by_number[ship.imo_number] = number

    def _insert(self, table: sa.Table, row: Mapping[str, Any]) -> None:
        self.connection.execute(table.insert(), sealed(table, row))


def _row(number: int, ship: Ship) -> dict[str, Any]:
    return {"id": number, "imo": ship.imo_number, "name": ship.name, "class_of": ship.class_name}
