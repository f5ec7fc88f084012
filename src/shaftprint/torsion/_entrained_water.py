"""Inertia of the water that the blades carry along, three ways."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

WATER_SHARE = 0.25
"""Entrained water over dry propeller, as torsional vibration calculations usually take it."""
WATER_SHARE_STD = 0.4 / math.sqrt(12.0)
"""Its standard deviation: wet over dry inertia lies evenly between 1.1 and 1.5."""
FORMULA_STD = 0.2
"""Standard deviation of a formula from blade geometry, as a share: an assumption for a propeller in a nozzle."""
# Chord of the Ka series at r/R from 0.2 to 1 over that at 0.6, and of 0.6 over D A_E/A_0 / Z: van Manen, Wake adapted
# ducted propellers, 1970, table of the Ka screws.
KA_RADIUS = np.linspace(0.2, 1.0, 9)
KA_CHORD = np.array([67.15, 76.59, 85.19, 93.01, 100.0, 105.86, 110.08, 112.66, 112.88]) / 100.0
KA_CHORD_AT_06 = 1.969
STRIPS = 4001


@dataclass(frozen=True, kw_only=True, slots=True)
class Blades:
    """What the formulas need of a propeller."""

    blades: int
    """Number of blades ``Z``."""
    pitch_ratio: float
    """``P / D``."""
    area_ratio: float
    """``A_E / A_0``."""
    diameter_m: float
    """``D`` [m]."""
    water_density_kg_m3: float
    """``rho`` [kg/m3]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class WaterEstimate:
    """Entrained water by one method."""

    method: str
    """Name of the method."""
    water_kg_m2: float
    """Inertia of the water [kg m2]."""
    std_kg_m2: float
    """Its standard deviation [kg m2]."""
    source: str
    """Where the method comes from."""


def schwanecke_kg_m2(propeller: Blades) -> float:
    """Return the entrained water by Schwanecke's formula [kg m2].

    ``J_w = 0.0703 / (pi Z) (P/D)^2 (A_E/A_0)^2 rho D^5`` (Schwanecke, Gedanken zur Frage der hydrodynamisch erregten
    Schwingungen des Propellers und der Wellenleitung, 1963).
    """
    form = propeller.pitch_ratio**2 * propeller.area_ratio**2
    return 0.0703 / (math.pi * propeller.blades) * form * propeller.water_density_kg_m3 * propeller.diameter_m**5


def strip_theory_kg_m2(propeller: Blades) -> float:
    """Return the entrained water by strip theory with the chords of the Ka series [kg m2].

    ``J_w = Z int (pi/4) rho c^2 sin^2(phi) r^2 dr`` from 0.2 R to R, ``tan(phi) = P / (2 pi r)``: each strip of a blade
    carries the water of a flat plate that moves across itself (Lamb, Hydrodynamics, article 71). The nozzle and the
    neighbouring blades are left out.
    """
    share: FloatArray = np.linspace(KA_RADIUS[0], KA_RADIUS[-1], STRIPS)
    radius = 0.5 * propeller.diameter_m * share
    longest = KA_CHORD_AT_06 * propeller.diameter_m * propeller.area_ratio / propeller.blades
    chord = longest * np.interp(share, KA_RADIUS, KA_CHORD)
    pitch = np.arctan(propeller.pitch_ratio * propeller.diameter_m / (2.0 * np.pi * radius))
    strip = 0.25 * np.pi * propeller.water_density_kg_m3 * (chord * np.sin(pitch) * radius) ** 2
    return float(propeller.blades * np.trapezoid(strip, radius))


def water_estimates(vessel: "Vessel") -> tuple[WaterEstimate, ...]:
    """Return the entrained water of a vessel's propeller by each method for which the vessel file has the numbers.

    The formulas need the area ratio of the propeller, the rule of thumb an inertia row with ``part = "propeller"``.
    """
    estimates = []
    screw = vessel.propeller
    if screw.area_ratio is not None:
        blades = Blades(
            blades=screw.blades,
            pitch_ratio=screw.pitch_ratio,
            area_ratio=screw.area_ratio,
            diameter_m=screw.diameter_m,
            water_density_kg_m3=vessel.water_density_kg_m3,
        )
        for method, value, source in (
            ("Schwanecke", schwanecke_kg_m2(blades), "Schwanecke 1963, from pitch and area of the blades"),
            ("strip theory", strip_theory_kg_m2(blades), "flat-plate strips with the chords of the Ka series"),
        ):
            estimates.append(
                WaterEstimate(method=method, water_kg_m2=value, std_kg_m2=FORMULA_STD * value, source=source)
            )
    dry = math.fsum(row.referred_kg_m2(vessel.gearbox.ratio) for row in vessel.inertia if row.part == "propeller")
    if dry > 0.0:
        estimates.append(
            WaterEstimate(
                method="1.25 times dry",
                water_kg_m2=WATER_SHARE * dry,
                std_kg_m2=WATER_SHARE_STD * dry,
                source="rule of torsional vibration calculations; 1.1 to 1.5",
            )
        )
    return tuple(estimates)
