"""Slow drift of the propeller load from one window to the next, and what it does to the response."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray, frozen_float

if TYPE_CHECKING:
    from shaftprint.spectra._line_measurement import LineMeasurement

# A quadratic propeller at the quay: torque grows by twice the relative speed.
_LOAD_SLOPE = 2.0
_SHORTEST_TIME_CONSTANT_S = 0.05
_LONGEST_TIME_CONSTANT_S = 20.0
_GRID_POINTS = 241
# Where the inertia dominates, torque over speed changes from bin to bin, and what that leaves looks like load.
_STEEPEST_SLOPE = 1.5 * _LOAD_SLOPE


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LoadDrift:
    """How much the propeller load of each window differs from that at the working point.

    At the quay the propeller takes ``M_s = M_s0 (1 + delta) (n / n_0)^2``. Over a window with speed amplitude ``a``
    the mean of the square is ``(mean n / n_0)^2 + a^2 / 2``, so the window's mean torque gives its ``delta``.
    """

    delta: FloatArray
    """Relative load of each window [-], shape (lines,)."""
    standard_deviation: float
    """Scatter of ``delta`` between the windows [-]; 0 for a single window."""
    time_constant_s: float
    """Rough time constant ``2 pi I n_0 / M_s0`` of the whole line [s], from how noise in the load moves the speed."""

    def __post_init__(self) -> None:
        """Make the array read-only."""
        object.__setattr__(self, "delta", frozen_float(self.delta))


def load_drift(
    measurements: Sequence["LineMeasurement"], *, speed: int, torque: int, usable: Sequence[bool]
) -> LoadDrift:
    """Find the relative propeller load of each window and how the line answers to a change of load.

    Parameters
    ----------
    measurements
        One entry a line, normalised with the working point.
    speed
        Place of the speed channel.
    torque
        Place of the torque channel.
    usable
        Which lines have a clean set point and a speed without aliasing.

    Returns
    -------
    The drift.
    """
    square = np.array([line.mean[speed] ** 2 + 0.5 * np.abs(line.amplitude[speed]) ** 2 for line in measurements])
    delta = np.array([line.mean[torque] for line in measurements]) / square - 1.0
    chosen = [line for line, good in zip(measurements, usable, strict=True) if good]
    return LoadDrift(
        delta=delta,
        standard_deviation=float(np.std(delta, ddof=1)) if delta.size > 1 else 0.0,
        time_constant_s=_time_constant_s(chosen, speed=speed, torque=torque),
    )


def drift_direction(response: ComplexArray, frequency_hz: float, time_constant_s: float) -> ComplexArray:
    """Return the change of the response of one line for a relative load ``delta`` of 1.

    With the load changed by ``delta``, the sine of the speed meets an additional torque ``2 delta G_n`` at the
    propeller. Seen at the gauge it is there directly and through the change of speed that it causes,

    ``dG_n = -(1 - G_n) / (tau s + 2) * 2 G_n``,  ``dG_M = 2 G_n + (G_M / G_n) dG_n``,

    where ``1 - G_n`` is the part of a torque that the governor does not hold.

    Parameters
    ----------
    response
        ``G_n`` and ``G_M`` at the line, shape (2,).
    frequency_hz
        Frequency of the line [Hz].
    time_constant_s
        Time constant of the whole line [s].

    Returns
    -------
    Derivatives of ``G_n`` and ``G_M``, shape (2,).
    """
    speed, torque = response
    torque_change = _LOAD_SLOPE * speed
    speed_change = _speed_per_torque(speed, frequency_hz, np.array([time_constant_s]))[0] * torque_change
    return np.array([speed_change, torque_change + torque / speed * speed_change])


def _time_constant_s(measurements: Sequence["LineMeasurement"], *, speed: int, torque: int) -> float:
    """Fit the time constant to how speed noise follows load noise beside each line.

    What remains of the torque noise when the part that goes with the speed noise, ``G_M / G_n`` times it, is taken
    away is noise in the load. The speed's regression on it is compared with ``-(1 - G_n) / (tau s + 2)`` for a grid of
    time constants. The mean of ``log tau`` over the likelihood is returned: the middle of the grid where nothing is
    known.
    """
    log_grid = np.linspace(np.log(_SHORTEST_TIME_CONSTANT_S), np.log(_LONGEST_TIME_CONSTANT_S), _GRID_POINTS)
    cost = np.zeros(_GRID_POINTS)
    tiny = np.finfo(np.float64).tiny
    for line in measurements:
        noise = line.noise.covariance
        slope = line.amplitude[torque] / line.amplitude[speed]
        if np.abs(slope) > _STEEPEST_SLOPE:
            continue
        jacobian = np.array([[1.0, 0.0], [-slope, 1.0]])
        channels = np.ix_([speed, torque], [speed, torque])
        speed_and_load = jacobian @ noise[channels] @ jacobian.conj().T
        load_power = max(speed_and_load[1, 1].real, tiny)
        follows = speed_and_load[0, 1] / load_power
        unexplained = max(speed_and_load[0, 0].real - np.abs(follows) ** 2 * load_power, tiny)
        model = _speed_per_torque(line.amplitude[speed] / line.amplitude[0], line.window.frequency_hz, np.exp(log_grid))
        samples = line.noise.complex_samples
        # Student's cost: a noise covariance of few samples must not outvote the others
        cost += samples * np.log1p(np.abs(follows - model) ** 2 * load_power / unexplained)
    likelihood = np.exp(cost.min() - cost)
    return float(np.exp(likelihood @ log_grid / likelihood.sum()))


def _speed_per_torque(speed_response: complex, frequency_hz: float, time_constant_s: FloatArray) -> ComplexArray:
    s = 2j * np.pi * frequency_hz
    answer: ComplexArray = np.divide(speed_response - 1.0, time_constant_s * s + _LOAD_SLOPE)
    return answer
