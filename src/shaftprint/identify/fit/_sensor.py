"""What the pick-up of a recording does to the speed, as a structure takes it."""

from typing import Protocol

from shaftprint.models import Structure


class PickedUp(Protocol):
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


def with_sensor(structure: Structure, data: PickedUp) -> Structure:
    """Return the structure with the pick-up's held parameters at the values of the data."""
    sensor = {
        "T_average": data.averaging_s,
        "T_hold": data.hold_s,
        "t_pickup": data.pick_up_delay_s,
    }
    held = {p.name: sensor[p.name] for p in structure.parameters if p.held and p.name in sensor}
    return structure.held_at(**held) if held else structure
