"""An elastic coupling in the line of a simulated ship."""

import math
from dataclasses import dataclass

from shaftprint.vessel._links import ShaftLink
from shaftprint.vessel._vessel import Vessel


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


def stated_coupling(vessel: Vessel) -> Coupling | None:
    """Return the coupling of a vessel file whose links have one spring, ahead of the gauge or across it; else None.

    Its ``psi`` becomes a viscous damping that loses as much in a cycle at the mode, ``k psi / (2 pi omega)`` with
    ``omega^2 = k (1 / J_1 + 1 / J_2)`` (J. P. Den Hartog, Mechanical Vibrations, section 2.8). Lines of more springs
    are sailed rigid.
    """
    springs = [link for link in vessel.links if link.stiffness_nm_rad is not None]
    if len(springs) != 1:
        return None
    behind = _behind(vessel, springs[0])
    ratio = vessel.gearbox.ratio
    rows = vessel.inertia
    if all(row.gauge == "downstream" for row in rows if row.name in springs[0].between):
        return None
    on_engine = next(row for row in rows if row.name == springs[0].between[0]).shaft == "engine"
    factor = ratio**2 if on_engine else 1.0
    driven = math.fsum(row.referred_kg_m2(ratio) for row in rows if row.gauge == "upstream" and row.name in behind)
    inertia = math.fsum(row.referred_kg_m2(ratio) for row in rows if row.name in behind)
    ahead = math.fsum(row.referred_kg_m2(ratio) for row in rows) - inertia
    stiffness = factor * (springs[0].stiffness_nm_rad or 0.0)
    omega = math.sqrt(stiffness * (1.0 / ahead + 1.0 / inertia))
    loss = stiffness * springs[0].relative_damping / (2.0 * math.pi * omega)
    return Coupling(
        stiffness_nm_rad=stiffness,
        damping_nm_s_rad=loss + factor * springs[0].damping_nm_s_rad,
        driven_kg_m2=driven,
    )


def _behind(vessel: Vessel, spring: ShaftLink) -> set[str]:
    """Return the masses on the propeller's side of a spring."""
    others = [set(link.between) for link in vessel.links if link is not spring]
    propeller = max((row for row in vessel.inertia if row.gauge == "downstream"), key=lambda row: row.inertia_kg_m2)
    reached = {propeller.name}
    while True:
        more = {name for pair in others if reached & pair for name in pair} - reached
        if not more:
            return reached
        reached |= more
