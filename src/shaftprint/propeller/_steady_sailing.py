"""A ship in steady running: what its propellers give and take, and how slowly ship and shaft answer."""

import math
from dataclasses import dataclass

from shaftprint.errors import PropellerError
from shaftprint.normalisation import inertia_time_s
from shaftprint.propeller._open_water import OpenWaterCurve, OpenWaterPoint


@dataclass(frozen=True, kw_only=True, slots=True)
class SteadySailing:
    """A ship with one propeller or several equal ones at constant speed."""

    point: OpenWaterPoint
    """Coefficients and slopes of the propellers at this speed."""
    shaft_speed_rev_s: float
    """Speed of the propeller shafts [rev/s]."""
    ship_speed_m_s: float
    """Speed of the ship through the water [m/s]."""
    thrust_n: float
    """Thrust ``T`` of one propeller with its nozzle [N]."""
    shaft_torque_nm: float
    """Torque ``M_s`` of one shaft [N m]."""
    resistance_n: float
    """Resistance ``R = k_p (1 - t) T`` that the ``k_p`` propellers overcome [N]."""

    def ship_time_s(self, mass_kg: float) -> float:
        """Return ``tau_u = m v / R`` [s] of a ship with its entrained water [kg]; infinite at the quay."""
        return mass_kg * self.ship_speed_m_s / self.resistance_n if self.ship_speed_m_s else math.inf

    def shaft_time_s(self, inertia_kg_m2: float) -> float:
        """Return ``tau = 2 pi I n_s / M_s`` [s] of an inertia on the propeller shaft [kg m2]."""
        return inertia_time_s(
            inertia_kg_m2, shaft_speed_rev_s=self.shaft_speed_rev_s, shaft_torque_nm=self.shaft_torque_nm
        )


def sail_steadily(
    curve: OpenWaterCurve,
    *,
    pitch_ratio: float,
    diameter_m: float,
    water_density_kg_m3: float,
    shaft_speed_rev_s: float,
    ship_speed_m_s: float,
    wake_fraction: float,
    thrust_deduction: float,
    propellers: int = 1,
    torque_factor: float = 1.0,
) -> SteadySailing:
    """Return thrust, torque and resistance of a ship in steady running.

    ``J = v (1 - w) / (n D)``, ``T = rho n^2 D^4 K_T``, ``M_s = f rho n^2 D^5 K_Q`` and ``R = k_p (1 - t) T``; time
    constants as D. Stapersma and A. Vrijdag, Linearisation of a ship propulsion system model (Ocean Engineering 142,
    2017, 441-457).

    Parameters
    ----------
    curve, pitch_ratio, diameter_m
        The propeller.
    water_density_kg_m3
        Density of the water [kg/m3].
    shaft_speed_rev_s, ship_speed_m_s
        Speeds; the ship's is 0 at the quay.
    wake_fraction
        ``w``: the propeller sees ``v (1 - w)``.
    thrust_deduction
        ``t``: of the thrust ``T (1 - t)`` pulls the ship.
    propellers
        Number of equal propellers ``k_p``.
    torque_factor
        ``f``, torque of the shaft over that in open water: ``1 / eta_R``, and what else makes a propeller differ.

    Raises
    ------
    PropellerError
        If pitch or advance ratio lies outside the curve, or a number is not physical.
    """
    for name, value in (("shaft_speed_rev_s", shaft_speed_rev_s), ("diameter_m", diameter_m)):
        if not value > 0.0:
            raise PropellerError(f"steady sailing: expected {name} above 0, found {value:g}; give a positive value.")
    for name, value in (("wake_fraction", wake_fraction), ("thrust_deduction", thrust_deduction)):
        if not value < 1.0:
            raise PropellerError(f"steady sailing: expected {name} below 1, found {value:g}; give a fraction.")
    point = curve.at(ship_speed_m_s * (1.0 - wake_fraction) / (shaft_speed_rev_s * diameter_m), pitch_ratio)
    force = water_density_kg_m3 * shaft_speed_rev_s**2 * diameter_m**4
    return SteadySailing(
        point=point,
        shaft_speed_rev_s=shaft_speed_rev_s,
        ship_speed_m_s=ship_speed_m_s,
        thrust_n=force * point.thrust,
        shaft_torque_nm=torque_factor * force * diameter_m * point.torque,
        resistance_n=propellers * (1.0 - thrust_deduction) * force * point.thrust,
    )
