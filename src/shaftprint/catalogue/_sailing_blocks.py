"""The building blocks of a ship that sails free: its speed answers the shaft, and the propeller feels it.

Normalised deviations of propeller and ship around steady running::

    thrust      T* = (2 - a) n* + a v* + p theta*
    torque      Q* = (2 - b) n* + b v* + q theta*
    ship        tau_u dv*/dt = T* - e v*

with the speed of advance following the ship's, ``v_a* = v*``, as long as the wake is constant. They are those of D.
Stapersma and A. Vrijdag, Linearisation of a ship propulsion system model (Ocean Engineering 142, 2017, 441-457) and of
A. Vrijdag and D. Stapersma, Extension and application of a linearised ship propulsion system model (Ocean Engineering
143, 2017, 50-65). ``tau_u = m v / R``, ``e = d ln R / d ln v``; ``a``, ``b``, ``p`` and ``q`` are the slopes of the
propeller's curves.

At the gauge the torque is ``k_q / 2`` of that, with ``k_q`` 2 where the gauge has no zero error; the load of a single
window over that at the working point goes into ``k_q`` like at the quay.

Of a ship with two shafts ``sigma`` is the share of the thrust whose shafts move together: 1 where both follow the set
point, 0.5 where one does and the governor of the other holds its speed.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._block import Block
from shaftprint.models._parameter import Parameter

_Value = TypeVar("_Value")


@dataclass(frozen=True, slots=True, eq=False)
class SailingTorque(Block):
    """Torque of the propeller over shaft speed, ``(k_q / 2) [2 - b + sigma b (2 - a) / (tau_u s + e - a)]``.

    Fast changes meet ``2 - b``, the ship has no time to follow; slow ones meet ``2`` where ``e`` is 2.
    """

    load: Parameter
    thrust_slope: Parameter
    torque_slope: Parameter
    resistance_slope: Parameter
    ship_time: Parameter
    share: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``k_q``, ``a``, ``b``, ``e``, ``tau_u``, ``sigma``."""
        return (self.load, self.thrust_slope, self.torque_slope, self.resistance_slope, self.ship_time, self.share)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``(k_q / 2) [2 - b + sigma b (2 - a) / (tau_u s + e - a)]``."""
        k_q, a, b, e, tau_u, sigma = values
        return np.asarray(0.5 * k_q * ((2.0 - b) + sigma * b * (2.0 - a) / (tau_u * s + e - a)))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the derivatives; with ``H = 1 / (tau_u s + e - a)`` and ``c = sigma b (2 - a)``.

        ``(2 - b + c H) / 2`` and, each times ``k_q / 2``, ``c H^2 - sigma b H``, ``sigma (2 - a) H - 1``, ``-c H^2``,
        ``-c s H^2`` and ``b (2 - a) H``.
        """
        k_q, a, b, e, tau_u, sigma = values
        half = 0.5 * k_q
        lag = 1.0 / (tau_u * s + e - a)
        back = sigma * b * (2.0 - a) * lag
        fall = half * back * lag
        return (
            0.5 * ((2.0 - b) + back),
            fall - half * sigma * b * lag,
            half * (sigma * (2.0 - a) * lag - 1.0),
            -fall,
            -s * fall,
            half * b * (2.0 - a) * lag,
        )

    def ratio(self, *values: float) -> tuple[FloatArray, FloatArray]:
        """Return ``(k_q / 2) ((2 - b) (tau_u s + e - a) + sigma b (2 - a)) / (tau_u s + e - a)``."""
        k_q, a, b, e, tau_u, sigma = values
        top = [0.5 * k_q * (2.0 - b) * tau_u, 0.5 * k_q * ((2.0 - b) * (e - a) + sigma * b * (2.0 - a))]
        return np.array(top), np.array([tau_u, e - a])


@dataclass(frozen=True, slots=True, eq=False)
class SailingShaft(Block):
    """Line of shafts of a free-sailing ship from torque to speed.

    ``(tau_u s + e - a) / [(tau s + 2 - b - g) (tau_u s + e - a) + sigma b (2 - a)]`` where ``k_q`` is 2, with ``tau``
    the sum of the inertia times given and ``g`` the slope of the engine torque. With the downstream inertia alone and
    no ``g`` it is ``n / M_s`` at the gauge.
    """

    inertia: tuple[Parameter, ...]
    torque: SailingTorque
    """Torque of the propeller over the speed of the shaft."""
    engine_slope: Parameter | None = None

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Inertia times, then ``k_q``, ``a``, ``b``, ``e``, ``tau_u``, ``sigma``, and ``g`` where there is one."""
        end = () if self.engine_slope is None else (self.engine_slope,)
        return (*self.inertia, *self.torque.parameters, *end)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return one over the torque that inertia, propeller and engine ask for."""
        inertia, propeller, engine = self._parted(values)
        balance = self.torque.transfer(s, *propeller)
        for time in inertia:
            balance = balance + time * s
        for slope in engine:
            balance = balance - slope
        return np.asarray(1.0 / balance)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-H^2`` times the derivatives of the torque asked for."""
        inertia, propeller, engine = self._parted(values)
        square = response * response
        slopes = self.torque.derivatives(s, response, *propeller)
        return (*(-s * square for _ in inertia), *(-square * slope for slope in slopes), *(square for _ in engine))

    def ratio(self, *values: float) -> tuple[FloatArray, FloatArray]:
        """Return numerator and denominator."""
        inertia, (k_q, a, b, e, tau_u, sigma), engine = self._parted(values)
        time, slope = sum(inertia[1:], start=inertia[0]), 0.5 * k_q * (2.0 - b)
        for value in engine:
            slope = slope - value
        back = 0.5 * k_q * sigma * b * (2.0 - a)
        bottom = [time * tau_u, time * (e - a) + slope * tau_u, slope * (e - a) + back]
        return np.array([tau_u, e - a]), np.array(bottom)

    def _parted(self, values: tuple[_Value, ...]) -> tuple[tuple[_Value, ...], ...]:
        """Return inertia times, what the propeller takes, and the slope of the engine if there is one."""
        count = len(self.inertia)
        return values[:count], values[count : count + 6], values[count + 6 :]


@dataclass(frozen=True, slots=True, eq=False)
class SailingSpeed(Block):
    """Speed of the ship over shaft speed, ``sigma (2 - a) / (tau_u s + e - a)``."""

    thrust_slope: Parameter
    resistance_slope: Parameter
    ship_time: Parameter
    share: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``a``, ``e``, ``tau_u``, ``sigma``."""
        return (self.thrust_slope, self.resistance_slope, self.ship_time, self.share)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``sigma (2 - a) / (tau_u s + e - a)``."""
        a, e, tau_u, sigma = values
        return np.asarray(sigma * (2.0 - a) / (tau_u * s + e - a))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``(H - sigma) / D``, ``-H / D``, ``-s H / D`` and ``(2 - a) / D`` with ``D = tau_u s + e - a``."""
        a, e, tau_u, sigma = values
        lag = 1.0 / (tau_u * s + e - a)
        fall = response * lag
        return fall - sigma * lag, -fall, -s * fall, (2.0 - a) * lag

    def ratio(self, *values: float) -> tuple[FloatArray, FloatArray]:
        """Return ``sigma (2 - a) / (tau_u s + e - a)``."""
        a, e, tau_u, sigma = values
        return np.array([sigma * (2.0 - a)]), np.array([tau_u, e - a])


@dataclass(frozen=True, slots=True, eq=False)
class PitchSpeed(Block):
    """Speed of the ship over pitch at constant shaft speed, ``sigma p / (tau_u s + e - a)``."""

    pitch_slope: Parameter
    thrust_slope: Parameter
    resistance_slope: Parameter
    ship_time: Parameter
    share: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``p``, ``a``, ``e``, ``tau_u``, ``sigma``."""
        return (self.pitch_slope, self.thrust_slope, self.resistance_slope, self.ship_time, self.share)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``sigma p / (tau_u s + e - a)``."""
        p, a, e, tau_u, sigma = values
        return np.asarray(sigma * p / (tau_u * s + e - a))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``sigma / D``, ``H / D``, ``-H / D``, ``-s H / D`` and ``p / D`` with ``D = tau_u s + e - a``."""
        p, a, e, tau_u, sigma = values
        lag = 1.0 / (tau_u * s + e - a)
        fall = response * lag
        return sigma * lag, fall, -fall, -s * fall, p * lag

    def ratio(self, *values: float) -> tuple[FloatArray, FloatArray]:
        """Return ``sigma p / (tau_u s + e - a)``."""
        p, a, e, tau_u, sigma = values
        return np.array([sigma * p]), np.array([tau_u, e - a])
