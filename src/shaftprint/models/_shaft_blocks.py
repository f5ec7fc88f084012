"""The building blocks of the line of shafts: inertia, torque at the gauge, propeller, water."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._block import Block
from shaftprint.models._expression import Polynomials
from shaftprint.models._parameter import Parameter


@dataclass(frozen=True, slots=True, eq=False)
class Shaft(Block):
    """Rigid line of shafts from torque to speed, ``1 / (tau s + k_q - g)``.

    ``tau`` is the sum of the inertia times given, ``k_q`` the slope of the propeller torque (2 for a quadratic law) and
    ``g`` that of the engine torque (thesis eqs 2.13, 2.18, 2.20; eq. 4.2 is the case of one inertia and ``g = 0``).
    """

    inertia: tuple[Parameter, ...]
    propeller_slope: Parameter
    engine_slope: Parameter | None = None

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Inertia times, ``k_q``, and ``g`` where there is one."""
        end = () if self.engine_slope is None else (self.engine_slope,)
        return (*self.inertia, self.propeller_slope, *end)

    def _totals(self, values: tuple[FloatArray, ...]) -> tuple[FloatArray, FloatArray]:
        count = len(self.inertia)
        tau = values[0] if count == 1 else sum(values[1:count], start=values[0])
        slope = values[count] if self.engine_slope is None else values[count] - values[count + 1]
        return tau, slope

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``1 / (tau s + k_q - g)``."""
        tau, slope = self._totals(values)
        return 1.0 / (tau * s + slope)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-s H^2`` for each inertia time, ``-H^2`` for ``k_q``, ``H^2`` for ``g``."""
        square = response * response
        to_inertia = -s * square
        end = () if self.engine_slope is None else (square,)
        return (*(to_inertia for _ in self.inertia), -square, *end)

    def ratio(self, *values: float) -> Polynomials:
        """Return ``1 / (tau s + k_q - g)``."""
        count = len(self.inertia)
        slope = values[count] if self.engine_slope is None else values[count] - values[count + 1]
        return np.array([1.0]), np.array([sum(values[1:count], start=values[0]), slope])


@dataclass(frozen=True, slots=True, eq=False)
class TorqueBalance(Block):
    """Torque at the gauge over speed, ``tau_dn s + k_q``: what is downstream of the gauge must be turned.

    Free body cut at the gauge: ``M_s - M_p = 2 pi I_dn dn_s/dt``, with ``M_p* = k_q n*``.
    """

    inertia: Parameter
    propeller_slope: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``tau_dn``, ``k_q``."""
        return (self.inertia, self.propeller_slope)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``tau_dn s + k_q``."""
        tau, slope = values
        return tau * s + slope

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``s`` and ``1``."""
        return s, np.ones_like(s)

    def ratio(self, *values: float) -> Polynomials:
        """Return ``(tau_dn s + k_q) / 1``."""
        return np.array(values), np.array([1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Inertia(Block):
    """Torque that accelerates an inertia, over speed: ``tau s``."""

    time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``tau``."""
        return (self.time,)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``tau s``."""
        (tau,) = values
        return tau * s

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``s``."""
        return (np.broadcast_to(s, response.shape),)

    def ratio(self, *values: float) -> Polynomials:
        """Return ``tau s / 1``."""
        return np.array([values[0], 0.0]), np.array([1.0])


@dataclass(frozen=True, slots=True, eq=False)
class EntrainedWater(Inertia):
    """Torque that accelerates the water carried along by the blades, over speed: ``tau_w s``.

    Its inertia is that of Schwanecke (Gedanken zur Frage der hydrodynamisch erregten Schwingungen des Propellers und
    der Wellenleitung, 1963), ``J_w = 0.0703 / (pi Z) (P/D)^2 (A_E/A_0)^2 rho D^5``. It acts like any other inertia
    downstream of the gauge: a test finds the sum with ``tau_dn``, not the two.
    """


@dataclass(frozen=True, slots=True, eq=False)
class DynamicInflow(Block):
    """Propeller torque above the quasi-steady one while the slipstream lags: ``kappa tau_i s / (tau_i s + 1)``.

    ``Q* = (k_q + kappa) n* - kappa u*`` with ``tau_i du*/dt = n* - u*``: the speed ``u`` through the disc follows the
    propeller by momentum (Blanke, Lindegaard and Fossen, Dynamic model for thrust generation of marine propellers,
    2000).
    """

    slope: Parameter
    time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``kappa``, ``tau_i``."""
        return (self.slope, self.time)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``kappa tau_i s / (tau_i s + 1)``."""
        kappa, tau = values
        return kappa * tau * s / (tau * s + 1.0)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``tau_i s / (tau_i s + 1)`` and ``kappa s / (tau_i s + 1)^2``."""
        kappa, tau = values
        lag = 1.0 / (tau * s + 1.0)
        return tau * s * lag, kappa * s * lag * lag

    def ratio(self, *values: float) -> Polynomials:
        """Return ``kappa tau_i s / (tau_i s + 1)``."""
        kappa, tau = values
        return np.array([kappa * tau, 0.0]), np.array([tau, 1.0])
