"""What an order of the shaft costs a steady sine beside it, before the test is made.

Orders are fitted together with the line and taken out, so that of an order nothing is left but what it has in common
with the line: the share ``rho^2`` of its power at the frequency of the line. The torque then has ``1 / (1 - rho^2)`` of
its variance, as two regressors with the correlation ``rho`` have (Draper and Smith, "Applied Regression Analysis",
chapter on collinearity). An order at ``f_k`` and a line ``d`` beside it, over ``T`` seconds, have

``rho^2 = 2 / T int_0^T (1 - t / T) cos(2 pi d t) exp(-D(t) / 2) dt``

in common, which is ``sinc^2(d T)`` at constant speed. ``D`` is the mean square by which the angle of the order wanders
in a time, from the density of the speed: ``D(t) = 2 int (f_k / f)^2 S_n(f) (1 - cos(2 pi f t)) df``.
"""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.identify.prediction._noise_levels import NoiseLevels

# Farther away, in bins of the window, a line has less than a hundredth of an order in common with it.
_FARTHEST_BINS = 4.0
_TIMES, _FREQUENCIES = 400, 400
# Slower wander than a tenth of a turn of the window shows as another mean speed.
_SLOWEST_SHARE = 0.1
_LEAST_APART = 1e-4


def order_cost(frequency_hz: float, duration_s: float, noise: "NoiseLevels") -> float:
    """Return by what share orders enlarge the variance of the torque of a line; 0 where none is beside it.

    ``frequency_hz``: frequency of the line [Hz]. ``duration_s``: its length [s]. ``noise``: knows the orders and the
    noise of the speed.
    """
    near = [one for one in noise.orders_hz if abs(frequency_hz - one) * duration_s < _FARTHEST_BINS]
    if not near or "n" not in noise.outputs:
        return 0.0
    common = (common_share(one, frequency_hz - one, duration_s, noise) for one in near)
    return sum(1.0 / max(1.0 - share, _LEAST_APART) - 1.0 for share in common)


def common_share(order_hz: float, beside_hz: float, duration_s: float, noise: "NoiseLevels") -> float:
    """Return the share ``rho^2`` of an order's power that a line beside it has in common with it.

    ``order_hz``: frequency of the order at the mean speed [Hz]. ``beside_hz``: how far the line is from it [Hz].
    ``duration_s``: length of the line [s]. ``noise``: knows the noise of the speed.
    """
    time = np.linspace(0.0, duration_s, _TIMES)
    apart = (1.0 - time / duration_s) * np.cos(2.0 * np.pi * beside_hz * time)
    wander = np.exp(-0.5 * _angle_wander(time, order_hz, _SLOWEST_SHARE / duration_s, noise))
    return float(2.0 / duration_s * np.trapezoid(apart * wander, time))


def _angle_wander(time_s: FloatArray, order_hz: float, slowest_hz: float, noise: "NoiseLevels") -> FloatArray:
    """Return the mean square by which the angle of an order wanders in a time [rad^2], shape (times,)."""
    frequency = np.geomspace(slowest_hz, noise.frequency_hz[-1], _FREQUENCIES)
    speed = noise.of_outputs("n").at(frequency)[:, 0, 0].real
    angle = (order_hz / frequency) ** 2 * speed
    moved = 1.0 - np.cos(2.0 * np.pi * np.outer(time_s, frequency))
    return np.asarray(2.0 * np.trapezoid(angle * moved, frequency, axis=1))
