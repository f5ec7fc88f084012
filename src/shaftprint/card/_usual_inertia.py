"""Inertias that are usual for an engine of a power and a propeller of a size."""

import math

from shaftprint.units import rev_s_from_rpm

# Time for which the energy of crankshaft, flywheel, coupling and gears at rated speed would give rated power [s].
_ENERGY_S = 0.3
_BRONZE_KG_M3 = 7600.0
# Blades of 0.028 D mean thickness that fill 0.7 of it, with a radius of gyration of 0.275 D.
_BLADE_INERTIA = 0.7 * 0.25 * math.pi * 0.028 * 0.275**2


def engine_inertia_kg_m2(*, rated_power_kw: float, rated_speed_rpm: float) -> float:
    """Return the inertia of engine, flywheel, coupling and gears at the engine shaft [kg m2].

    Its energy at rated speed is 0.3 s of rated power, ``I = 2 P t / omega^2``; 0.29 s for the table of the Stan Tug.
    """
    omega = 2.0 * math.pi * rev_s_from_rpm(rated_speed_rpm)
    return 2.0 * _ENERGY_S * 1000.0 * rated_power_kw / omega**2


def propeller_inertia_kg_m2(*, diameter_m: float, area_ratio: float) -> float:
    """Return the inertia of the dry propeller [kg m2], blades of bronze, ``0.0012 rho_b D^5 A_E/A_0``."""
    return _BLADE_INERTIA * _BRONZE_KG_M3 * diameter_m**5 * area_ratio


def water_inertia_kg_m2(
    *, diameter_m: float, area_ratio: float, pitch_ratio: float, blades: int, water_density_kg_m3: float
) -> float:
    """Return the inertia of the entrained water [kg m2].

    ``J_w = 0.0703 / (pi Z) (P/D)^2 (A_E/A_0)^2 rho D^5`` (Schwanecke, 1963).
    """
    shape = (pitch_ratio * area_ratio) ** 2 / (math.pi * blades)
    return 0.0703 * shape * water_density_kg_m3 * diameter_m**5
