"""The shaft torque against what the gauge can show: bounds of a leg, and how much of it is expected to be cut off."""

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.inputs._gauge_range import FULL_SCALE
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._motion import SIGNALS
from shaftprint.errors import DesignError

# Which share of the samples is above so many ripples: five orders of independent phase, and noise, as on the simulated
# Stan Tug (docs/decisions/0059-full-scale.md). Beyond the last as steep as before it.
_RIPPLES = np.array([0.0, 0.317, 0.475, 0.663, 0.797, 0.926, 1.0, 1.1, 1.172, 1.239, 1.291, 1.342, 1.373])
_ABOVE = np.array([0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5])


def gauge_bounds(limits: Limits, speed_share: float, *, crest: float = 1.0) -> tuple[Bound, ...]:
    """Return the ends of what the gauge shows as bounds of a leg; none where no gauge is stated.

    Orders and noise go with the load, the square of the speed: ``M (1 + m + a n) + r M L <= M_max`` and
    ``M (1 + m) - r M L >= M_min``, with the mean shaft torque ``M``, the deviations ``m`` and ``n`` of torque and
    speed, the ripple ``r`` and the load ``L = 1 + 2 n + a n``. For speeds from the mean to ``1 + a`` times it ``a n``
    is at least ``n^2``, which the square of the speed adds to the linear torque. A margin for the noise is in the
    ripple.

    ``speed_share``: mean speed of the leg over that of the first working point. ``crest``: how many times the ripple is
    kept free at a crest. Raises DesignError if the mean torque of the leg leaves no room for what one sample in 10,000
    has on top.
    """
    gauge = limits.gauge
    if gauge is None:
        return ()
    speed_rpm = speed_share * limits.engine_speed_rpm
    reach = min(limits.set_point_rpm, limits.free_speeds(speed_rpm)[1] - speed_rpm) / speed_rpm
    torque_nm = gauge.shaft_torque_nm(limits.brake_torque_nm, speed_share)
    needed_nm = (1.0 + gauge.rare_ripple) * torque_nm
    if not gauge.highest_nm > needed_nm:
        raise DesignError(
            f"vessel file of {gauge.vessel}, full_scale_nm of [sensors.shaft_torque]: expected more than "
            f"{needed_nm:.0f} N m for a leg at {speed_rpm:g} rpm, whose shaft torque is {torque_nm:.0f} N m with "
            f"orders and noise of {100.0 * gauge.rare_ripple:.0f} % on it, found a gauge that shows up to "
            f"{gauge.highest_nm:g} N m; choose a larger range of the telemetry and state it there, or slower legs."
        )
    ripple, bounds = crest * gauge.ripple, []
    for sign, end_nm in ((1.0, gauge.highest_nm), (-1.0, -gauge.lowest_nm)):
        of_speed = max(sign, 0.0) * reach + ripple * (2.0 + reach)
        row = np.array([{"shaft torque": sign, "speed": of_speed}.get(signal, 0.0) for signal in SIGNALS])
        bounds.append(Bound(name=FULL_SCALE, weights=frozen_float(row), room=end_nm / torque_nm - sign - ripple))
    return tuple(bounds)


def share_cut_off(limits: Limits, speed_share: float, signals: FloatArray) -> float:
    """Return which share of a leg's samples is expected beyond what the gauge shows; zero where no gauge is stated.

    ``speed_share``: mean speed of the leg over that of the first working point. ``signals``: deviations of ``SIGNALS``
    over one period, shape (signals, samples).
    """
    gauge = limits.gauge
    if gauge is None or gauge.ripple == 0.0:
        return 0.0
    speed, torque = signals[SIGNALS.index("speed")], signals[SIGNALS.index("shaft torque")]
    ends = np.array([[gauge.highest_nm], [gauge.lowest_nm]])
    mean_nm = gauge.shaft_torque_nm(limits.brake_torque_nm, speed_share)
    room = np.array([[1.0], [-1.0]]) * (ends / mean_nm - (1.0 + torque + speed**2))
    return float(np.mean(np.sum(_above(room / (gauge.ripple * (1.0 + speed) ** 2)), axis=0)))


def _above(ripples: FloatArray) -> FloatArray:
    """Return the share of samples above so many ripples, of any shape."""
    steepness = np.log(_ABOVE[-1] / _ABOVE[-2]) / (_RIPPLES[-1] - _RIPPLES[-2])
    inside = np.interp(ripples, _RIPPLES, np.log(_ABOVE))
    return np.asarray(np.exp(inside + steepness * np.maximum(ripples - _RIPPLES[-1], 0.0)))
