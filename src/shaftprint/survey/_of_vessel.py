"""Which structure fits a ship, and how it is fitted for one: free is also what its sensors leave open."""

from shaftprint.catalogue import CLOSED_LOOPS, ShipRole
from shaftprint.models import Structure
from shaftprint.vessel import Vessel

_OF_SENSORS = {ShipRole.LOAD_SLOPE: (1.0, 3.0), ShipRole.LOG_LATENCY: (-2.0, 2.0)}
# A ship with way on answers its shafts; only engines drive the free-sailing structures.
_UNDERWAY, _UNDERWAY_WITH_LOG = "FREE-CLOSED", "FREE-LOG"


def default_structure(vessel: Vessel) -> str:
    """Return the name of the closed loop that a vessel file asks for: by what drives the line, and where it is tested.

    At the quay it is GAUGE-CLOSED, GAUGE-MOTOR where a motor drives the line, or GAUGE-HYBRID where an electric machine
    is on the gearbox of an engine; underway FREE-LOG, or FREE-CLOSED
    where no log is in the recording.
    """
    if vessel.is_underway and vessel.motor is None:
        return _UNDERWAY if vessel.sensors.ship_speed is None else _UNDERWAY_WITH_LOG
    return CLOSED_LOOPS[vessel.drive]


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
