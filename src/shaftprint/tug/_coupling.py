"""An elastic coupling in the line of a simulated ship."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class Coupling:
    """A coupling that twists, upstream of the torque gauge; all values are referred to the propeller shaft."""

    stiffness_nm_rad: float
    """Torsional stiffness [N m/rad]."""
    damping_nm_s_rad: float
    """Viscous damping [N m s/rad]."""
    driven_kg_m2: float = 0.0
    """Part of the inertia upstream of the gauge that the coupling drives, such as a gearbox [kg m2]; 0 where the
    gauge measures what the coupling carries."""
