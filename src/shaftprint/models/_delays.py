"""Blocks that are late: exact delay, its Pade approximation, a computer's hold, the pick-up with its mean."""

import math
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._expression import Polynomials
from shaftprint.models._parameter import Parameter
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula


@dataclass(frozen=True, slots=True, eq=False)
class Delay(Block):
    """Exact transport delay ``exp(-s t)`` (thesis eq. 4.20), wherever it sits."""

    time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The delay."""
        return (self.time,)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``exp(-s t)``."""
        (t,) = values
        return np.exp(-s * t)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-s exp(-s t)``."""
        return (-s * response,)

    def flow(self, flow: Flow, signal: Formula) -> Formula:
        """Return what the signal was ``t`` ago."""
        return flow.delayed(signal, flow.parameter(self.time.name))


PADE_5 = (30240.0, 15120.0, 3360.0, 420.0, 30.0, 1.0)


@dataclass(frozen=True, slots=True, eq=False)
class PadeDelay(Block):
    """Fifth-order Pade approximation of a delay, to compare with the exact one only.

    Thesis eq. 4.24 lacks the powers of ``s``: its terms are ``c_k (s t)^k``. Accurate for ``omega t`` below about 4.
    """

    time: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The delay."""
        return (self.time,)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``P(-s t) / P(s t)``."""
        (t,) = values
        x = s * t
        return np.asarray(np.polyval(PADE_5[::-1], -x) / np.polyval(PADE_5[::-1], x))

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return ``-s (P'(-x) + H P'(x)) / P(x)`` at ``x = s t``."""
        (t,) = values
        x = s * t
        slope = np.polyder(np.array(PADE_5[::-1]))
        change = np.polyval(slope, -x) + response * np.polyval(slope, x)
        return (np.asarray(-s * change / np.polyval(PADE_5[::-1], x)),)

    def ratio(self, *values: float) -> Polynomials:
        """Return numerator and denominator in ``s``."""
        powers = np.array(PADE_5) * values[0] ** np.arange(6)
        return (powers * (-1.0) ** np.arange(6))[::-1], powers[::-1]


@dataclass(frozen=True, slots=True, eq=False)
class ZeroOrderHold(Block):
    """A computer's output that keeps its value for one period ``T``: ``(1 - exp(-s T)) / (s T)``.

    It stands in a loop. From samples to samples of a drive, ``Held`` is exact; this leaves out the images at multiples
    of the sample rate ``f_s``, a share of up to ``3.3 (f / f_s)^2`` where the response falls like ``1 / s``, and far
    less where it falls faster.
    """

    period_s: float
    """Time between two outputs of the computer [s]."""

    def __post_init__(self) -> None:
        """Check the period.

        Raises StructureError if it is not positive and finite.
        """
        if not 0.0 < self.period_s < math.inf:
            raise StructureError(f"hold: expected a period above 0 s, found {self.period_s}.")

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """No parameters."""
        return ()

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return ``(1 - exp(-s T)) / (s T)``."""
        x = s * self.period_s
        return np.asarray(-np.expm1(-x) / x)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return nothing."""
        return ()

    def flow(self, flow: Flow, signal: Formula) -> Formula:
        """Return the mean over the last period: what the hold is without the images of its sampling."""
        return flow.mean(signal, self.period_s)


@dataclass(frozen=True, slots=True, eq=False)
class AveragingSensor(Block):
    """A pulse pick-up: mean over a window, hold until the next pulse, delay of the time stamp.

    ``sinhc(s T_average / 2) sinhc(s T_hold / 2) exp(-s t_pickup)`` with ``sinhc(x) = sinh(x) / x``; on the
    frequency axis these are the ``sinc`` of the one-revolution mean and of the hold. ``t_pickup`` is the whole
    delay of the value behind the true speed, half the window and half the hold included; it is zero for values
    stamped at mid-period.
    """

    averaging: Parameter
    hold: Parameter
    delay: Parameter

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """``T_average``, ``T_hold``, ``t_pickup``."""
        return (self.averaging, self.hold, self.delay)

    def transfer(self, s: ComplexArray, *values: FloatArray) -> ComplexArray:
        """Return the sensor's response."""
        averaging, hold, delay = values
        return _sinhc(s * averaging / 2.0) * _sinhc(s * hold / 2.0) * np.exp(-s * delay)

    def derivatives(self, s: ComplexArray, response: ComplexArray, *values: FloatArray) -> tuple[ComplexArray, ...]:
        """Return the derivatives to both windows and to the delay."""
        averaging, hold, delay = values
        lagged = np.exp(-s * delay) * (s / 2.0)
        mean, held = s * averaging / 2.0, s * hold / 2.0
        return (
            lagged * _sinhc_slope(mean) * _sinhc(held),
            lagged * _sinhc(mean) * _sinhc_slope(held),
            -s * response,
        )

    def flow(self, flow: Flow, signal: Formula) -> Formula:
        """Return the late mean."""
        return flow.delayed(self.means(flow, signal), self.lateness(flow))

    def means(self, flow: Flow, signal: Formula) -> Formula:
        """Return the mean over both windows, which end now."""
        once = flow.mean(signal, flow.parameter(self.averaging.name))
        return flow.mean(once, flow.parameter(self.hold.name))

    def lateness(self, flow: Flow) -> Formula:
        """Return the delay that the means do not have already."""
        windows = flow.parameter(self.averaging.name) + flow.parameter(self.hold.name)
        return flow.parameter(self.delay.name) - 0.5 * windows


SERIES_BELOW = 0.02


def _sinhc(x: ComplexArray) -> ComplexArray:
    """Return ``sinh(x) / x``; by its series near zero, where the quotient is 0 / 0."""
    small = np.abs(x) < SERIES_BELOW
    safe = np.where(small, 1.0, x)
    square = x * x
    return np.where(
        small,
        1.0 + square / 6.0 * (1.0 + square / 20.0 * (1.0 + square / 42.0)),
        np.sinh(safe) / safe,
    )


def _sinhc_slope(x: ComplexArray) -> ComplexArray:
    """Return the derivative of ``sinh(x) / x``."""
    small = np.abs(x) < SERIES_BELOW
    safe = np.where(small, 1.0, x)
    square = x * x
    series = x / 3.0 * (1.0 + square / 10.0 * (1.0 + square / 28.0 * (1.0 + square / 54.0)))
    return np.where(small, series, (np.cosh(safe) - np.sinh(safe) / safe) / safe)
