"""The untuned viscous damper: a ring in silicone inside a housing on the crankshaft."""

import math


def best_damper_nm_s_rad(*, ring_kg_m2: float, effective_kg_m2: float, omega_rad_s: float) -> float:
    """Return the damping between ring and housing that makes the largest amplitude of one mode smallest [N m s/rad].

    ``c = J_r omega sqrt(2 / ((1 + mu) (2 + mu)))`` with ``mu = J_r / J``. Too little damping lets the ring stand still,
    too much carries it along as a part of the housing; either way nothing is lost (Den Hartog, Mechanical Vibrations,
    section 3.4, the viscously coupled damper without spring).

    Parameters
    ----------
    ring_kg_m2
        ``J_r``, the ring.
    effective_kg_m2
        ``J``, twice the kinetic energy of the mode over the square of the speed of the housing.
    omega_rad_s
        Natural frequency of the mode without the ring.
    """
    share = ring_kg_m2 / effective_kg_m2
    return ring_kg_m2 * omega_rad_s * math.sqrt(2.0 / ((1.0 + share) * (2.0 + share)))
