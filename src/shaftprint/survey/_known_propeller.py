"""The propeller of a ship underway, where its vessel file names a series that is known."""

from shaftprint.card._series import open_water_curve
from shaftprint.catalogue._known_propeller import KnownPropeller
from shaftprint.vessel._vessel import Vessel


def known_propeller(vessel: Vessel, *, shaft_speed_rev_s: float, ship_speed_m_s: float) -> KnownPropeller | None:
    """Return curves and working point of a ship's propellers; None without a hull, or a series that is known.

    ``vessel``: the installation. ``shaft_speed_rev_s``: mean speed of the propeller shafts [rev/s]. ``ship_speed_m_s``:
    mean speed through the water [m/s].
    """
    curve, hull = open_water_curve(vessel.propeller), vessel.hull
    if curve is None or hull is None:
        return None
    return KnownPropeller(
        curve=curve,
        pitch_ratio=vessel.propeller.pitch_ratio,
        diameter_m=vessel.propeller.diameter_m,
        propellers=hull.shafts,
        water_density_kg_m3=vessel.water_density_kg_m3,
        shaft_speed_rev_s=shaft_speed_rev_s,
        ship_speed_m_s=ship_speed_m_s,
    )
