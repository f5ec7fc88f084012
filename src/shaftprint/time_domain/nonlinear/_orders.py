"""Torque without the orders of engine and shaft, which sweep through the band of the model when the speed jumps.

At constant speed a whitening filter predicts an order from its last periods; while the speed changes it cannot, and
what is left is twice as strong there: just where limits act, so that intervals would be too narrow. An order is a sine
of the angle that the shaft has turned, as strong as the load, and angle and load are measured::

    M = M_slow + sum_k M_slow [a_k cos(k theta) + b_k sin(k theta)] + ...

found by least squares above the band in which a governor acts. Half an engine order, the engine's and the shaft's are
taken; blades and firings are above half the rate of a record.
"""

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.signals._signals import Signals
from shaftprint.vessel._vessel import Vessel

# A mean over this time is slow: it holds a period of the lowest order at half the working-point speed.
SLOW_S = 0.4
# Angles add up from speeds: over longer stretches their errors turn an order's phase.
STRETCH_S = 200.0


def without_orders(signals: Signals, vessel: Vessel) -> Signals:
    """Return signals whose shaft torque is without its lowest orders; what is not measured stays as it is."""
    orders = (1.0, *(float(order) for order in vessel.machine.torque_orders[:1]), 1.0 / vessel.gearbox.ratio)
    torque = np.array(signals.shaft_torque_nm)
    speed = np.array(signals.engine_speed.speed_rev_s)
    count = max(round(signals.samples / (STRETCH_S * signals.rate_hz)), 1)
    for part in np.array_split(np.arange(signals.samples), count):
        stretch = slice(int(part[0]), int(part[-1]) + 1)
        torque[stretch] -= orders_in(torque[stretch], speed[stretch], signals.rate_hz, orders)
    return signals.with_channel("M_s", values=frozen_float(torque))


def orders_in(torque: FloatArray, speed_rev_s: FloatArray, rate_hz: float, orders: tuple[float, ...]) -> FloatArray:
    """Return the orders of the engine in a torque [N m], shape (samples,)."""
    good = np.isfinite(torque) & np.isfinite(speed_rev_s)
    if not good.any():
        return np.zeros(torque.size)
    finite = np.where(good, torque, 0.0)
    turned = np.cumsum(np.where(np.isfinite(speed_rev_s), speed_rev_s, 0.0)) / rate_hz
    length = round(SLOW_S * rate_hz)
    load = _slow(finite, length)
    size = float(np.mean(np.abs(load))) or 1.0
    faster = np.where(good, speed_rev_s, 0.0) / float(np.mean(speed_rev_s[good])) - 1.0
    waves = [
        load / size * wave(2.0 * np.pi * order * turned) for order in dict.fromkeys(orders) for wave in (np.cos, np.sin)
    ]
    table = np.stack([*waves, *(faster * wave for wave in waves)], axis=1)
    columns = np.column_stack([finite, table])
    fast = (columns - _slow(columns, length))[good]
    shares, *_ = np.linalg.lstsq(fast[:, 1:], fast[:, 0], rcond=None)
    return np.asarray(np.where(good, table @ shares, 0.0))


def _slow(values: FloatArray, length: int) -> FloatArray:
    """Return a moving mean of a moving mean along the first axis, ends held."""
    size = len(values)
    for _ in range(2):
        begin, end = (
            np.repeat(values[[at]], count, axis=0) for at, count in ((0, length // 2), (-1, length - length // 2))
        )
        sums = np.cumsum(np.concatenate([begin, values, end]), axis=0)
        values = (sums[length:] - sums[:-length])[:size] / length
    return np.asarray(values)
