"""A structure as it is fitted for one ship: free is also what its sensors leave open and no test of it shows."""

from shaftprint.catalogue import ShipRole
from shaftprint.models import Structure
from shaftprint.vessel import Vessel

_OF_SENSORS = {ShipRole.LOAD_SLOPE: (1.0, 3.0), ShipRole.LOG_LATENCY: (-2.0, 2.0)}


def of_vessel(structure: Structure, vessel: Vessel) -> Structure:
    """Return a structure with zero of the torque gauge and latency of the log free, where the ship is underway.

    A free-sailing structure holds both, for they go with slopes of the propeller and times of the ship. The vessel file
    knows them with a standard deviation, which belongs into those of what is found.
    """
    if not vessel.is_underway:
        return structure
    roles = structure.roles
    opened = {
        p.name: _OF_SENSORS[roles[p.name]] for p in structure.parameters if p.held and roles.get(p.name) in _OF_SENSORS
    }
    return structure.free_between(**opened)
