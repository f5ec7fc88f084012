"""Which structure fits a ship, and how it is fitted for one: free is also what its sensors leave open."""

from collections.abc import Iterable, Sequence

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._bent_line import with_bend
from shaftprint.catalogue._own_structure import TypedName
from shaftprint.catalogue._roles import ShipRole
from shaftprint.choices import CLOSED_LOOPS, COMBINED_LOOP, PITCHED_LOOP
from shaftprint.errors import StructureError
from shaftprint.models._structure import Structure
from shaftprint.normalisation import inertia_time_s
from shaftprint.torsion._coupling import line_coupling
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel

_OF_SENSORS = {ShipRole.LOAD_SLOPE: (1.0, 3.0), ShipRole.LOG_LATENCY: (-2.0, 2.0)}
_PITCH = "pitch_set_point"
# A ship with way on answers its shafts; only engines drive the free-sailing structures.
_UNDERWAY, _UNDERWAY_WITH_LOG = "FREE-CLOSED", "FREE-LOG"
# What is known to some per cent is free up to this multiple.
_WIDE = 2.0
# Share of the inertia upstream of the gauge that a coupling drives at most, as far as nobody says: an engine is the
# larger part.
_MOST_DRIVEN = 0.5
# Legs of one level have speeds that differ by what the load does to them.
_SAME_SPEED = 1.02


def default_structure(vessel: Vessel | None, campaign: Campaign | None = None) -> TypedName:
    """Return the name of the closed loop that a test asks for: by what drives the line, where, and what is moved.

    At the quay it is GAUGE-CLOSED, GAUGE-MOTOR where a motor drives the line, GAUGE-HYBRID where an electric machine is
    on the gearbox of an engine, GAUGE-COMBINATOR where one lever asks for speed and pitch, or GAUGE-PITCH where the
    campaign moves a pitch that is logged; underway FREE-LOG, or FREE-CLOSED where no log is in the recording.

    Parameters
    ----------
    vessel
        The installation; that of an engine at the quay where it is not given.
    campaign
        What is asked of it; without one nothing but the set point of the speed is moved.
    """
    return TypedName(_closed_loop(vessel, campaign))


def _closed_loop(vessel: Vessel | None, campaign: Campaign | None) -> str:
    if vessel is None:
        return CLOSED_LOOPS["engine"]
    if vessel.is_underway and vessel.motor is None:
        return _UNDERWAY if vessel.sensors.ship_speed is None else _UNDERWAY_WITH_LOG
    if vessel.combinator is not None:
        return COMBINED_LOOP
    if vessel.shows_pitch and vessel.motor is None and campaign is not None and _PITCH in campaign.inputs:
        return PITCHED_LOOP
    return CLOSED_LOOPS[vessel.drive]


def expect_one_speed(campaign: Campaign, vessel: Vessel, legs: Sequence[str] = ()) -> None:
    """Refuse a test at several speeds where its numbers belong to one.

    ``campaign``, ``vessel``: what is asked of the ship, and the installation. ``legs``: names of the legs that are
    used; all when not given. Raises StructureError if legs of several levels are used on a ship underway or with a
    combinator.
    """
    levels = {leg.level_v for leg in campaign.legs if not legs or leg.name in legs}
    if vessel.why_one_speed and len(levels) > 1:
        raise StructureError(
            f"campaign {campaign.name}: expected legs of one speed, found {len(levels)} levels; "
            f"{vessel.why_one_speed}, so test each by itself."
        )


def of_vessel(structure: Structure, vessel: Vessel) -> Structure:
    """Return a structure with free what sensors and coupling of the vessel file leave open.

    Underway it is the zero of the torque gauge and the latency of the log. A free-sailing structure holds both, for
    they go with slopes of the propeller and times of the ship. The vessel file knows them with a standard deviation,
    which belongs into those of what is found. So does the inertia between an elastic coupling and the gauge, where the
    links of the vessel file state a coupling ahead of the gauge.
    """
    opened = dict(_driven(structure, vessel))
    if vessel.is_underway:
        roles = structure.roles
        opened |= {
            p.name: _OF_SENSORS[roles[p.name]]
            for p in structure.parameters
            if p.held and roles.get(p.name) in _OF_SENSORS
        }
    return structure.free_between(**opened) if opened else structure


def at_speeds(structure: Structure, speeds: Iterable[float]) -> Structure:
    """Return a structure as a test at these speeds is fitted: at several the line of the set point may bend.

    ``speeds``: mean speeds of the test, or their shares of one of them.
    """
    lowest, highest = min(every := tuple(speeds)), max(every)
    return with_bend(structure) if highest > _SAME_SPEED * lowest else structure


def _driven(structure: Structure, vessel: Vessel) -> dict[str, tuple[float, float]]:
    """Return bounds of the inertia time between coupling and gauge, wide about that of the vessel file."""
    names = [p.name for p in structure.parameters if p.held and p.role == ShipRole.INERTIA_DRIVEN]
    if not names:
        return {}
    coupling, upstream = line_coupling(vessel), vessel.inertia_upstream_kg_m2
    if coupling is not None and coupling.driven_kg_m2 > 0.0:
        most = min(_WIDE * coupling.driven_kg_m2, upstream)
    elif coupling is None and structure.name == "GAUGE-ELASTIC-ENGINE":
        most = _MOST_DRIVEN * upstream
    else:
        return {}
    point = vessel.working_point
    tau = inertia_time_s(
        most,
        shaft_speed_rev_s=rev_s_from_rpm(point.engine_speed_rpm) / vessel.gearbox.ratio,
        shaft_torque_nm=point.driving_torque_nm,
    )
    return dict.fromkeys(names, (0.0, tau))
