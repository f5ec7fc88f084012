"""What the pick-up of a recording does to the speed, as a structure takes it."""

from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse


def with_sensor(structure: Structure, response: FrequencyResponse) -> Structure:
    """Return the structure with the pick-up's held parameters at the values of the data."""
    sensor = {
        "T_average": response.averaging_s,
        "T_hold": response.hold_s,
        "t_pickup": response.pick_up_delay_s,
    }
    held = {p.name: sensor[p.name] for p in structure.parameters if p.held and p.name in sensor}
    return structure.held_at(**held) if held else structure
