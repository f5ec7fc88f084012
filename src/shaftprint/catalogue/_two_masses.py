"""Two masses and a spring: the line of shafts up to its first torsional mode, in physical units."""

from collections.abc import Mapping

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.models._combination import Combination
from shaftprint.models._own_blocks import RationalBlock
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

# Bounds of the search around what is expected.
LEAST, MOST = 0.2, 5.0


def two_mass_line(
    *,
    engine_kg_m2: float = 54.0,
    propeller_kg_m2: float = 17.0,
    stiffness_nm_rad: float = 94e3,
    damping_nm_s_rad: float = 90.0,
    load_nm_s_rad: float = 106.0,
) -> Structure:
    """Return two masses with a spring, from engine torque to engine speed ``w_e`` and shaft torque ``M_s``.

    ``J_e dw_e/dt = M_e - M_s``, ``M_s = (c + k / s) (w_e - w_p)``, ``J_p dw_p/dt = M_s - d w_p``, all referred to the
    propeller shaft and in SI units: torques in N m, speeds in rad/s. The gauge shows the torque of the spring.
    ``w_e / M_e = (J_p s^2 + (c + d) s + k) / D`` and ``M_s / M_e = (c s + k) (J_p s + d) / D`` with
    ``D = J_e J_p s^3 + (J_e (c + d) + J_p c) s^2 + (k (J_e + J_p) + c d) s + k d``.

    The parameters are free from a fifth to five times what is given, ``c`` and ``d`` from zero; ``torsion.two_masses``
    says what to expect.

    Parameters
    ----------
    engine_kg_m2, propeller_kg_m2
        ``J_e`` and ``J_p`` [kg m2], upstream and downstream of the gauge.
    stiffness_nm_rad, damping_nm_s_rad
        ``k`` [N m/rad] and ``c`` [N m s/rad] of the spring between them.
    load_nm_s_rad
        ``d`` [N m s/rad], slope of the propeller torque.
    """
    of = (
        _around("J_e", "kg m2", engine_kg_m2, "inertia on the engine's side of the spring, at the propeller shaft"),
        _around("J_p", "kg m2", propeller_kg_m2, "inertia on the propeller's side of the spring"),
        _around("k", "N m/rad", stiffness_nm_rad, "stiffness between them, at the propeller shaft"),
        _from_zero("c", damping_nm_s_rad, "damping between them, at the propeller shaft"),
        _from_zero("d", load_nm_s_rad, "slope of the propeller torque"),
    )
    return Structure(
        name="TWO-MASS",
        title="two masses and a spring, first torsional mode",
        input="M_e",
        outputs={"w_e": RationalBlock(_speed, of), "M_s": RationalBlock(_torque, of)},
        combinations=(
            Combination(name="f_1", unit="Hz", of=_natural_hz, meaning="natural frequency, first torsional mode"),
            Combination(name="zeta_1", unit="-", of=_damping_ratio, meaning="damping ratio, first torsional mode"),
            Combination(name="J_e + J_p", unit="kg m2", of=lambda p: p["J_e"] + p["J_p"], meaning="inertia of all"),
        ),
    )


def _around(name: str, unit: str, value: float, meaning: str) -> Parameter:
    return Parameter(name, unit, LEAST * value, MOST * value, value, meaning)


def _from_zero(name: str, value: float, meaning: str) -> Parameter:
    return Parameter(name, "N m s/rad", 0.0, MOST * value, value, meaning)


def _denominator(j_e: FloatArray, j_p: FloatArray, k: FloatArray, c: FloatArray, d: FloatArray) -> list[FloatArray]:
    return [j_e * j_p, j_e * (c + d) + j_p * c, k * (j_e + j_p) + c * d, k * d]


def _speed(
    j_e: FloatArray, j_p: FloatArray, k: FloatArray, c: FloatArray, d: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    return [j_p, c + d, k], _denominator(j_e, j_p, k, c, d)


def _torque(
    j_e: FloatArray, j_p: FloatArray, k: FloatArray, c: FloatArray, d: FloatArray
) -> tuple[list[FloatArray], list[FloatArray]]:
    return [c * j_p, c * d + k * j_p, k * d], _denominator(j_e, j_p, k, c, d)


def _omega(p: Mapping[str, FloatArray]) -> FloatArray:
    return np.asarray(np.sqrt(p["k"] * (1.0 / p["J_e"] + 1.0 / p["J_p"])))


def _natural_hz(p: Mapping[str, FloatArray]) -> FloatArray:
    """Return ``sqrt(k (1 / J_e + 1 / J_p)) / (2 pi)``."""
    return _omega(p) / (2.0 * np.pi)


def _damping_ratio(p: Mapping[str, FloatArray]) -> FloatArray:
    """Return ``(c (1 / J_e + 1 / J_p) + d J_e / (J_p (J_e + J_p))) / (2 omega_1)``, to first order in the damping."""
    lost = p["c"] * (1.0 / p["J_e"] + 1.0 / p["J_p"]) + p["d"] * p["J_e"] / (p["J_p"] * (p["J_e"] + p["J_p"]))
    return lost / (2.0 * _omega(p))
