"""The building blocks that are rational in ``s``: governor, actuation lag, line of shafts."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._block import Block
from shaftprint.models._expression import Polynomials
from shaftprint.models._parameter import Parameter


@dataclass(frozen=True, slots=True, eq=False)
class Gain(Block):
    """A free gain ``k``, such as the fuel-rack gain ``v`` of the engine map (thesis eq. 2.18)."""

    gain: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The gain."""
        return (self.gain,)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``k``."""
        (k,) = values
        return k * np.ones_like(s)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``dk = 1``."""
        return (np.ones_like(response),)

    def ratio(self, *values: float) -> Polynomials:
        """Return ``k / 1``."""
        return np.array([values[0]]), np.array([1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Integrator(Block):
    """The integral ``1 / s`` of the speed error (thesis eq. 2.15)."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """No parameters."""
        return ()

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``1 / s``."""
        return 1.0 / s

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return nothing."""
        return ()

    def ratio(self, *values: float) -> Polynomials:
        """Return ``1 / s``."""
        return np.array([1.0]), np.array([1.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False)
class PIGovernor(Block):
    """Proportional and integral governor ``K_p + K_i / s`` (thesis eqs 2.14-2.16, 4.3)."""

    proportional: Parameter
    integral: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``K_p``, ``K_i``."""
        return (self.proportional, self.integral)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``K_p + K_i / s``."""
        k_p, k_i = values
        return k_p + k_i * (1.0 / s)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``1`` and ``1 / s``."""
        return np.ones_like(s), 1.0 / s

    def ratio(self, *values: float) -> Polynomials:
        """Return ``(K_p s + K_i) / s``."""
        return np.array(values), np.array([1.0, 0.0])


@dataclass(frozen=True, slots=True, eq=False)
class FilteredDerivative(Block):
    """The filtered derivative term ``K_d s / (T_f s + 1)`` of a PID governor (thesis eq. 4.18)."""

    derivative: Parameter
    filter_time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``K_d``, ``T_f``."""
        return (self.derivative, self.filter_time)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``K_d s / (T_f s + 1)``."""
        k_d, t_f = values
        return k_d * s / (t_f * s + 1.0)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``s / (T_f s + 1)`` and ``-H s / (T_f s + 1)``."""
        _, t_f = values
        filtered = s / (t_f * s + 1.0)
        return filtered, -response * filtered

    def ratio(self, *values: float) -> Polynomials:
        """Return ``K_d s / (T_f s + 1)``."""
        return np.array([values[0], 0.0]), np.array([values[1], 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class SecondOrderLag(Block):
    """Second-order lag ``omega_n^2 / (s^2 + 2 zeta omega_n s + omega_n^2)``.

    Thesis eq. 4.22 prints ``zeta omega_n s``; with it every second-order result of the thesis would be unstable.
    """

    frequency: Parameter
    damping: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``omega_n``, ``zeta``."""
        return (self.frequency, self.damping)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the lag."""
        omega_n, zeta = values
        square = omega_n * omega_n
        return square / (s * s + (2.0 * zeta * omega_n) * s + square)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the derivatives to ``omega_n`` and ``zeta``.

        With ``D`` the denominator, ``dH/domega_n = 2 s (s + zeta omega_n) omega_n / D^2`` and
        ``dH/dzeta = -2 s H^2 / omega_n``.
        """
        omega_n, zeta = values
        to_zeta = response * response * s * (-2.0 / omega_n)
        return to_zeta * (s * (-1.0 / (omega_n * omega_n)) - zeta / omega_n), to_zeta

    def ratio(self, *values: float) -> Polynomials:
        """Return numerator and denominator."""
        omega_n, zeta = values
        return np.array([omega_n**2]), np.array([1.0, 2.0 * zeta * omega_n, omega_n**2])


@dataclass(frozen=True, slots=True, eq=False)
class FirstOrderLag(Block):
    """First-order lag ``1 / (T s + 1)``, such as the low-pass of a torque telemetry."""

    time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``T``."""
        return (self.time,)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``1 / (T s + 1)``."""
        (t,) = values
        return np.asarray(1.0 / (t * s + 1.0))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-s H^2``."""
        return (-s * response * response,)

    def ratio(self, *values: float) -> Polynomials:
        """Return ``1 / (T s + 1)``."""
        return np.array([1.0]), np.array([values[0], 1.0])
