"""What the pick-up of a recording does to the speed, as a structure takes it."""

from typing import Protocol

from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._structure import Structure


class PickUpReading(Protocol):
    """Data whose speed comes from a pick-up: a frequency response, or a record."""

    @property
    def averaging_s(self) -> float:
        """Length of the window over which a value is a mean [s]."""

    @property
    def hold_s(self) -> float:
        """Time for which a value is held [s]."""

    @property
    def pick_up_delay_s(self) -> float:
        """Delay of a value behind the true speed [s]."""


def with_sensor(structure: Structure, data: PickUpReading) -> Structure:
    """Return the structure with the pick-up's held parameters at the values of the data."""
    values = pick_up_values(structure, averaging_s=data.averaging_s, hold_s=data.hold_s, delay_s=data.pick_up_delay_s)
    return structure.held_at(**values) if values else structure


def pick_up_values(structure: Structure, *, averaging_s: float, hold_s: float, delay_s: float) -> dict[str, float]:
    """Return mean, hold and delay of a pick-up [s] by the names of the held parameters that stand for them."""
    by_role = {
        ShipRole.PICK_UP_AVERAGE: averaging_s,
        ShipRole.PICK_UP_HOLD: hold_s,
        ShipRole.PICK_UP_DELAY: delay_s,
    }
    return {p.name: by_role[p.role] for p in structure.parameters if p.held and p.role in by_role}
