from ._entrained_water import schwanecke_kg_m2, strip_theory_kg_m2
from ._expected_inertia import expected_inertia
from ._line import TorsionalLine, torsional_line
from ._modes import modes

__all__ = [
    "TorsionalLine",
    "expected_inertia",
    "modes",
    "schwanecke_kg_m2",
    "strip_theory_kg_m2",
    "torsional_line",
]
