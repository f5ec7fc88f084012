"""What a vessel file lets be expected of a ship beside its line, for those who plan or predict its test.

A test is to find these numbers, and no fit knows them beforehand: they say where a prediction is made.
"""

import numpy as np

from shaftprint.card._series import open_water_curve
from shaftprint.catalogue._known_propeller import sailing_values
from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._structure import Structure
from shaftprint.survey._known_propeller import known_propeller
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel


def expected_of_ship(structure: Structure, vessel: Vessel) -> dict[str, float]:
    """Return the values of a structure by hull, propeller and pitch of the vessel file, by name.

    Underway the exponent of the resistance, and the time of the ship by its mass, speed and resistance; slopes of
    thrust and torque by the curves of the propeller at the wake fraction, where the file states one and a series that
    is known. At the quay with a controllable pitch its lag and delay, the slope of its combinator, and the slope of the
    torque that its series has, where the file does not state it. Raises StructureError if the propeller of a ship
    underway does not pull at its working point.
    """
    return _sailing(structure, vessel) if vessel.is_underway else _pitched(structure, vessel)


def _sailing(structure: Structure, vessel: Vessel) -> dict[str, float]:
    hull, speed_m_s = vessel.hull, vessel.working_point.ship_speed_m_s
    if hull is None or speed_m_s is None:
        return {}
    time_s, _ = hull.surge_time_s(speed_m_s)
    slopes = _slopes(vessel, speed_m_s)
    return sailing_values(structure, exponent=hull.resistance_exponent, time_s=time_s, slopes=slopes)


def _slopes(vessel: Vessel, ship_speed_m_s: float) -> tuple[float, float] | None:
    """Return the slopes of thrust and torque; None where wake or propeller are not known."""
    wake = None if vessel.hull is None else vessel.hull.wake_fraction
    shaft_speed = rev_s_from_rpm(vessel.working_point.engine_speed_rpm) / vessel.gearbox.ratio
    propeller = known_propeller(vessel, shaft_speed_rev_s=shaft_speed, ship_speed_m_s=ship_speed_m_s)
    if wake is None or propeller is None or wake < propeller.lowest_wake():
        return None
    thrust, torque = propeller.slopes(np.asarray(wake))
    return float(thrust), float(torque)


def _pitched(structure: Structure, vessel: Vessel) -> dict[str, float]:
    pitch = vessel.pitch
    if pitch is None:
        return {}
    known = {
        ShipRole.PITCH_LAG: pitch.lag_s,
        ShipRole.PITCH_DELAY: pitch.delay_s,
        ShipRole.PITCH_SLOPE: _torque_over_pitch(vessel),
        ShipRole.COMBINATOR_SLOPE: _combinator_slope(vessel),
    }
    named = {structure.named_as(role): value for role, value in known.items()}
    return {name: value for name, value in named.items() if name is not None and value is not None}


def _combinator_slope(vessel: Vessel) -> float | None:
    combinator = vessel.combinator
    return None if combinator is None else combinator.combinator_slope(vessel.working_point.engine_speed_rpm)


def _torque_over_pitch(vessel: Vessel) -> float | None:
    """Return ``d ln K_Q / d ln (P/D)`` at zero advance by the series of the propeller; None where it is not known."""
    curve, theta = open_water_curve(vessel.propeller), np.asarray(vessel.propeller.pitch_ratio)
    if curve is None:
        return None
    at_rest = np.asarray(0.0)
    return float(theta * curve.torque.pitch_slope(at_rest, theta) / curve.torque.value(at_rest, theta))
