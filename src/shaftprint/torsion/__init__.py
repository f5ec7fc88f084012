"""The line of shafts as masses and springs: modes, forced response, time, two masses; and inertia by calculation.

===================== ============ ====================================================================================
quantity              unit         meaning and sign
===================== ============ ====================================================================================
inertia               kg m2        referred to the propeller shaft: masses on the engine shaft times ``i^2``
stiffness, damping    N m/rad,     of a link, referred to the propeller shaft: links on the engine shaft times ``i^2``
                      N m s/rad
``psi``               1            energy that a link loses in a cycle over its largest elastic energy; the stiffness is
                                   ``k (1 + j psi / (2 pi))``
torque on a mass      N m          referred to the propeller shaft: on the engine shaft times ``i``; positive when it
                                   drives
speed of a mass       rad/s        referred to the propeller shaft: of the engine shaft over ``i``; deviation
torque of a link      N m          at the propeller shaft; positive when its engine side drives its propeller side
``tau``               s            inertia time ``2 pi I n_s0 / M_s0``
===================== ============ ====================================================================================

A gear mesh joins two masses into one body, as does every rigid link. A *body* has the name of its largest mass.
"""

from shaftprint.torsion._coupling import LineCoupling, line_coupling
from shaftprint.torsion._entrained_water import (
    Blades,
    WaterEstimate,
    schwanecke_kg_m2,
    strip_theory_kg_m2,
    water_estimates,
)
from shaftprint.torsion._expected_inertia import (
    ExpectedInertia,
    ExpectedValue,
    InertiaComparison,
    WetLine,
    compare_inertia,
    expected_inertia,
)
from shaftprint.torsion._forced_response import LineResponse, forced_response
from shaftprint.torsion._line import LineLink, TorsionalLine, torsional_line
from shaftprint.torsion._modes import Modes, modes
from shaftprint.torsion._trace import LineTrace, simulate_line
from shaftprint.torsion._two_masses import TwoMasses, two_masses
from shaftprint.torsion._viscous_damper import best_damper_nm_s_rad

__all__ = [
    "Blades",
    "ExpectedInertia",
    "ExpectedValue",
    "InertiaComparison",
    "LineCoupling",
    "LineLink",
    "LineResponse",
    "LineTrace",
    "Modes",
    "TorsionalLine",
    "TwoMasses",
    "WaterEstimate",
    "WetLine",
    "best_damper_nm_s_rad",
    "compare_inertia",
    "expected_inertia",
    "forced_response",
    "line_coupling",
    "modes",
    "schwanecke_kg_m2",
    "simulate_line",
    "strip_theory_kg_m2",
    "torsional_line",
    "two_masses",
    "water_estimates",
]
