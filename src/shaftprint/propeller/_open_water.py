"""The noun of the room: thrust and torque of a propeller in open water, and their slopes at a point."""

import math
from dataclasses import dataclass

import numpy as np

from shaftprint.errors import PropellerError
from shaftprint.notebook._shown import Shown
from shaftprint.propeller._polynomial import Polynomial

# Where rounding leaves an advance ratio a little beyond the end of the curve.
_ROUNDING = 1e-12


@dataclass(frozen=True, kw_only=True, slots=True)
class OpenWaterPoint:
    """A propeller at one advance ratio and one pitch."""

    advance: float
    """Advance ratio ``J = v_a / (n D)``."""
    pitch_ratio: float
    """Pitch over diameter ``P/D``."""
    thrust: float
    """``K_T = T / (rho n^2 D^4)`` of propeller and nozzle together."""
    nozzle_thrust: float
    """``K_TN``, the nozzle's part of it; 0 without nozzle."""
    torque: float
    """``K_Q = Q / (rho n^2 D^5)``."""
    a: float
    """``(J / K_T) dK_T/dJ``, not above 0: how the thrust falls with the speed of advance."""
    b: float
    """``(J / K_Q) dK_Q/dJ``, not above 0: how the torque falls with the speed of advance."""
    p: float
    """``(theta / K_T) dK_T/dtheta`` with ``theta`` the pitch ratio: how the thrust grows with pitch."""
    q: float
    """``(theta / K_Q) dK_Q/dtheta``: how the torque grows with pitch."""

    @property
    def efficiency(self) -> float:
        """Open-water efficiency ``J K_T / (2 pi K_Q)``."""
        return self.advance * self.thrust / (2.0 * math.pi * self.torque)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class OpenWaterCurve(Shown):
    """Open-water curves ``K_T``, ``K_TN`` and ``K_Q`` over advance ratio and pitch ratio, from 0 to zero thrust."""

    name: str
    """Series and type, such as ``Ka4-70 in nozzle 19A``."""
    thrust: Polynomial
    """``K_T`` of propeller and nozzle together."""
    nozzle_thrust: Polynomial | None
    """``K_TN`` of the nozzle; None for an open propeller."""
    torque: Polynomial
    """``K_Q``."""
    lowest_pitch_ratio: float
    """Lowest pitch ratio that was tested."""
    highest_pitch_ratio: float
    """Highest pitch ratio that was tested."""

    def at(self, advance: float, pitch_ratio: float) -> OpenWaterPoint:
        """Return coefficients and normalised slopes at one point.

        ``a``, ``b``, ``p`` and ``q`` are those of D. Stapersma and A. Vrijdag, Linearisation of a ship propulsion
        system model (Ocean Engineering 142, 2017, 441-457). ``a`` and ``p`` grow without bound towards zero thrust.

        Parameters
        ----------
        advance
            Advance ratio ``J``; 0 at bollard pull.
        pitch_ratio
            Pitch over diameter.

        Raises
        ------
        PropellerError
            If the pitch was not tested, or ``J`` is below 0 or not below the end of the thrust.
        """
        last = self.zero_thrust_advance(pitch_ratio)
        if not 0.0 <= advance < last * (1.0 + _ROUNDING):
            raise PropellerError(
                f"{self.name}: expected an advance ratio J from 0 to {last:.4g}, where the thrust ends at P/D "
                f"{pitch_ratio:g}, found {advance:g}; check speed, wake and shaft speed."
            )
        j, theta = np.asarray(advance, dtype=np.float64), np.asarray(pitch_ratio, dtype=np.float64)
        k_t, k_q = float(self.thrust.value(j, theta)), float(self.torque.value(j, theta))
        return OpenWaterPoint(
            advance=float(advance),
            pitch_ratio=float(pitch_ratio),
            thrust=k_t,
            nozzle_thrust=0.0 if self.nozzle_thrust is None else float(self.nozzle_thrust.value(j, theta)),
            torque=k_q,
            a=float(j * self.thrust.advance_slope(j, theta)) / k_t + 0.0,
            b=float(j * self.torque.advance_slope(j, theta)) / k_q + 0.0,
            p=float(theta * self.thrust.pitch_slope(j, theta)) / k_t,
            q=float(theta * self.torque.pitch_slope(j, theta)) / k_q,
        )

    def zero_thrust_advance(self, pitch_ratio: float) -> float:
        """Return the lowest positive ``J`` at which the thrust ends.

        Raises
        ------
        PropellerError
            If the pitch was not tested.
        """
        if not self.lowest_pitch_ratio <= pitch_ratio <= self.highest_pitch_ratio:
            raise PropellerError(
                f"{self.name}: expected a pitch ratio P/D from {self.lowest_pitch_ratio:g} to "
                f"{self.highest_pitch_ratio:g}, found {pitch_ratio:g}; the series was not tested there."
            )
        roots = np.roots(self.thrust.powers_of_advance(pitch_ratio)[::-1])
        real = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > 0.0)]
        return float(real.min())
