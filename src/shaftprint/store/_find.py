"""A ship and its lines, found by what a user calls them."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.errors import StoreError
from shaftprint.spelling import meant
from shaftprint.store._nouns import Line, Ship

if TYPE_CHECKING:
    from shaftprint.store.database._reader import Reader, ShipRow

_MOST_NAMED = 12


def ship_called(reader: "Reader", name: str | Ship) -> "ShipRow":
    """Return the ship of a name or an IMO number.

    ``reader``: a connection that reads. ``name``: what a user calls it; or the ship itself, found by its number, and by
    its name among those without one only. Raises StoreError if there is none, or several ships have the name.
    """
    if isinstance(name, Ship):
        return _same_ship(reader, name)
    number = re.fullmatch(r"(?:IMO ?)?([0-9]{7})", name)
    found = [] if number is None else reader.ships(imo_number=int(number[1]))
    # PostgreSQL takes no NUL, and no ship has one
    found = found or ([] if "\0" in name else reader.ships(name=name))
    if len(found) == 1:
        return found[0]
    if found:
        numbers = ", ".join(f"IMO {one.ship.imo_number or 'unknown'}" for one in found)
        raise StoreError(f"{name}: expected one ship of that name, found {numbers}; name the ship by its IMO number.")
    names = [one.ship.name for one in reader.ships()]
    advice = meant(name, names) or (
        f" It has {_listed(names)}." if names else " It has none yet: shaftprint store add."
    )
    raise StoreError(f"{name}: expected the name or IMO number of a ship in the store, found none.{advice}")


def name_of(ship: str | Ship) -> str:
    """Return what a ship is called in an error."""
    return ship.name if isinstance(ship, Ship) else ship


def _same_ship(reader: "Reader", ship: Ship) -> "ShipRow":
    if ship.imo_number is not None:
        found = reader.ships(imo_number=ship.imo_number)
    else:
        found = [one for one in reader.ships(name=ship.name) if one.ship.imo_number is None]
    if not found:
        # who asks may not know of the others: none of them is named
        raise StoreError(f"{ship.name}: expected it in the store as it was a moment ago, found it changed; try again.")
    return found[0]


def lines_called(reader: "Reader", ship: "ShipRow", names: Sequence[str]) -> dict[int, Line]:
    """Return lines of a ship by their number in the database; all where none is named.

    Raises StoreError if it has no line of a name.
    """
    lines = reader.lines([ship])
    there = [line.position for line in lines.values()]
    for name in names:
        if name not in there:
            raise StoreError(f"{ship.ship.name}: expected one of its lines, {_listed(there)}, found {name!r}.")
    return {key: line for key, line in lines.items() if not names or line.position in names}


def _listed(names: Sequence[str]) -> str:
    more = len(names) - _MOST_NAMED
    return ", ".join(names[:_MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
