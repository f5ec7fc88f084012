"""Two bodies on an elastic coupling, normalised: the end of the engine, the end of the shaft, and their mode.

With ``B = tau_up - tau_m`` ahead of the coupling and ``A = tau_m + tau_dn`` behind it::

    M_b - T = B s n_1        T = (A s + k_q) n        s T = (d_c s + k_c) (n_1 - n)

the slope ``g`` of the engine torque is taken into the first; a spring and a damper side by side (E. J. Nestorides, A
Handbook on Torsional Vibration, 1958).
"""

from collections.abc import Mapping

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.models._combination import Combination


def engine_end(
    tau_up: FloatArray,
    tau_m: FloatArray,
    tau_dn: FloatArray,
    k_q: FloatArray,
    g: FloatArray,
    k_c: FloatArray,
    d_c: FloatArray,
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return ``n_1 / M_b`` of rack alone, ``N / ((B s - g) N + (A s + k_q) (d_c s + k_c))``.

    ``N = A s^2 + (k_q + d_c) s + k_c``.
    """
    ahead, behind, slope = tau_up - tau_m, tau_m + tau_dn, k_q + d_c
    return [behind, slope, k_c], [
        ahead * behind,
        ahead * slope - g * behind + behind * d_c,
        (ahead + behind) * k_c - g * slope + k_q * d_c,
        (k_q - g) * k_c,
    ]


def shaft_end(
    tau_m: FloatArray, tau_dn: FloatArray, k_q: FloatArray, k_c: FloatArray, d_c: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    """Return ``n / n_1 = (d_c s + k_c) / (A s^2 + (k_q + d_c) s + k_c)``."""
    return [d_c, k_c], [tau_m + tau_dn, k_q + d_c, k_c]


def coupling_mode() -> Combination:
    """Return the natural frequency of the two bodies on the undamped coupling, without slopes of engine and load."""
    return Combination(name="f_1", unit="Hz", of=_natural_hz, meaning="natural frequency of the line on its coupling")


def _natural_hz(p: Mapping[str, FloatArray]) -> FloatArray:
    """Return ``sqrt(k_c (1 / B + 1 / A)) / (2 pi)``."""
    stiffness = p["k_c"] * (1.0 / (p["tau_up"] - p["tau_m"]) + 1.0 / (p["tau_m"] + p["tau_dn"]))
    return np.asarray(np.sqrt(stiffness) / (2.0 * np.pi))
