"""Who asks, and what he may: a role, and the ships that were given to him."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from shaftprint.store._nouns import Ship

ALL: Final = "all"
"""In place of a list of ships: every ship, those to come too."""


class Role(IntEnum):
    """What somebody may do with the ships that he sees; each role may what those before it may."""

    READER = 1
    """Reads."""
    TESTER = 2
    """Uploads recordings, starts jobs, notes what was done to a line."""
    OWNER = 3
    """Reads who did what."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Person:
    """Somebody who asks for pages."""

    name: str
    """Name by which he signs in."""
    role: Role
    """What he may do."""
    ships: tuple[str, ...]
    """IMO numbers of the ships that he sees, and names of those without one; ``all`` for every ship."""
    password: str = ""
    """Hash of his password; empty where nobody signs in."""

    def sees(self, ship: Ship) -> bool:
        """Return whether a ship was given to him.

        A name counts for a ship without IMO number only: names change, and may be taken from another ship. A name
        that could be a number is none that is given.
        """
        if self.sees_all:
            return True
        if ship.imo_number is None:
            return ship.name in self.ships and not is_like_a_number(ship.name)
        return str(ship.imo_number) in self.ships

    @property
    def sees_all(self) -> bool:
        """Whether he sees every ship."""
        return ALL in self.ships


def is_like_a_number(name: str) -> bool:
    """Return whether a name could be taken for an IMO number."""
    digits = name.upper().removeprefix("IMO").strip()
    return digits.isascii() and digits.isdecimal()


LOCAL: Final = Person(name="this computer", role=Role.OWNER, ships=(ALL,))
"""Who asks where nobody signs in: a server that only its own computer reaches."""
NOBODY: Final = Person(name="", role=Role.READER, ships=())
"""Who asks for the page on which one signs in."""
