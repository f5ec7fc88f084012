"""The coupling of a vessel file: two bodies and a spring that stand for the whole line up to its first mode."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.torsion._line import TorsionalLine, torsional_line
from shaftprint.torsion._modes import modes

if TYPE_CHECKING:
    from shaftprint.vessel._inertia import InertiaRow
    from shaftprint.vessel._links import ShaftLink
    from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class LineCoupling:
    """Where a line twists most in its first mode, upstream of the torque gauge or across it, at the propeller shaft."""

    between: tuple[str, str]
    """Masses on both of its ends, as the vessel file names them."""
    stiffness_nm_rad: float
    """``k`` [N m/rad]: gives the natural frequency of the whole line's first mode with the two bodies."""
    stiffness_std_nm_rad: float
    """Its standard deviation [N m/rad]."""
    damping_nm_s_rad: float
    """``d`` [N m s/rad]: loses as much in a cycle of the first mode as all links of the line."""
    damping_std_nm_s_rad: float
    """Its standard deviation [N m s/rad]."""
    driven_kg_m2: float
    """Inertia between coupling and torque gauge [kg m2]; 0 where the gauge shows what the coupling carries."""
    driven_std_kg_m2: float
    """Its standard deviation [kg m2]."""
    frequency_hz: float
    """Natural frequency of the first mode without damping [Hz]."""


def line_coupling(vessel: "Vessel") -> LineCoupling | None:
    """Return the coupling of a vessel file; None without links, or where a line twists most behind the torque gauge.

    It is the link with most of the elastic energy ``e_l`` of the first mode. All links give by their shares of that
    energy (Rayleigh's quotient): ``dk / k = sum e_l dk_l / k_l``, a loss of ``psi = sum e_l psi_l`` and a damping of
    ``d = k (psi / (2 pi omega_1) + sum e_l d_l / k_l)``, links taken as independent; ``k = omega_1^2 J_1 J_2 / (J_1 +
    J_2)`` with the inertia ahead of it and behind it.
    """
    if not vessel.links:
        return None
    line = torsional_line(vessel)
    # without damping: what the load takes from the speed of the mode is no softness of the coupling
    mode = modes(line.without_damping)
    share = mode.elastic_share[0]
    link = int(np.argmax(share))
    ahead, behind = _sides(line, link)
    elastic = [one for one in vessel.links if not one.is_rigid]
    between = elastic[link].between
    by_name = {row.name: row for row in vessel.inertia}
    if all(by_name[name].gauge == "downstream" for name in between):
        return None
    driven = [row for row in vessel.inertia if row.gauge == "upstream" and behind[line.body_of[row.name]] == 1.0]
    pair = 1.0 / float(ahead @ line.inertia_kg_m2) + 1.0 / float(behind @ line.inertia_kg_m2)
    omega = 2.0 * math.pi * float(mode.frequency_hz[0])
    return _coupling(between, elastic, share, omega=omega, pair=pair, driven=driven, ratio=vessel.gearbox.ratio)


def _coupling(
    between: tuple[str, str],
    links: "list[ShaftLink]",
    share: FloatArray,
    *,
    omega: float,
    pair: float,
    driven: "list[InertiaRow]",
    ratio: float,
) -> LineCoupling:
    stiffness = omega**2 / pair
    springs = [(part, link) for part, link in zip(share.tolist(), links, strict=True) if link.stiffness_nm_rad]
    of_loss = [part * link.relative_damping / (2.0 * math.pi * omega) for part, link in springs]
    of_damper = [part * link.damping_nm_s_rad / (link.stiffness_nm_rad or 1.0) for part, link in springs]
    damping = stiffness * math.fsum((*of_loss, *of_damper))
    stiffness_std = stiffness * math.hypot(*(part * link.stiffness_std_share for part, link in springs))
    damping_std = stiffness * math.hypot(
        *(value * link.relative_damping_std_share for value, (_, link) in zip(of_loss, springs, strict=True)),
        *(value * link.damping_std_share for value, (_, link) in zip(of_damper, springs, strict=True)),
    )
    return LineCoupling(
        between=between,
        stiffness_nm_rad=stiffness,
        stiffness_std_nm_rad=stiffness_std,
        damping_nm_s_rad=damping,
        damping_std_nm_s_rad=damping_std,
        driven_kg_m2=math.fsum(row.referred_kg_m2(ratio) for row in driven),
        driven_std_kg_m2=math.hypot(*(row.referred_std_kg_m2(ratio) for row in driven)),
        frequency_hz=omega / (2.0 * math.pi),
    )


def _sides(line: TorsionalLine, link: int) -> tuple[FloatArray, FloatArray]:
    """Return which bodies lie ahead of a link and which behind it, towards the propeller, that takes the load."""
    first, second = line.sides_of(link)
    return (first, second) if second[int(np.argmax(line.load_nm_s_rad))] else (second, first)
