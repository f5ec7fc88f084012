"""Limits of the ship as bounds of one leg: straight lines in the deviations of ``SIGNALS`` about its working point."""

from itertools import pairwise

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.design.inputs._limits import SPEED_SIGMAS, Curve, Limits
from shaftprint.design.motion._bound import Bound
from shaftprint.design.motion._gauge import gauge_bounds
from shaftprint.design.motion._motion import SIGNALS
from shaftprint.distributions import deviations_passed
from shaftprint.errors import DesignError

# A leg reaches speeds so many times as far from its level as its set point does.
_OVERSHOOT = 1.3


def bounds_of_leg(limits: Limits, speed_share: float, noise: FloatArray) -> tuple[Bound, ...]:
    """Return the bounds about a working point in bollard pull, where torque goes with the square of the speed.

    ``limits``: what ship and engine allow. ``speed_share``: mean speed of the leg over that of the first working point.
    ``noise``: covariance of the noise of ``SIGNALS``, shape (signals, signals). Raises DesignError if nothing is left
    of a limit.
    """
    speed_rpm = speed_share * limits.engine_speed_rpm
    torque_nm = speed_share**2 * limits.brake_torque_nm
    low, high = limits.free_speeds(speed_rpm)
    step = limits.set_point_rpm / speed_rpm
    stated: list[tuple[str, dict[str, float], float]] = [
        ("set point", {"set point": 1.0}, step),
        ("set point", {"set point": -1.0}, step),
        ("highest speed", {"speed": 1.0}, high / speed_rpm - 1.0),
        ("lowest speed", {"speed": -1.0}, 1.0 - low / speed_rpm),
    ]
    if limits.demand_rate_limit_rpm_per_s is not None:
        rate = limits.demand_rate_limit_rpm_per_s / speed_rpm
        stated += [("rate of the set point", {"rate": sign}, rate) for sign in (1.0, -1.0)]
    reach = (max(low, speed_rpm * (1.0 - _OVERSHOOT * step)), min(high, speed_rpm * (1.0 + _OVERSHOOT * step)))
    for name, signal, curve, sign in (
        ("full load", "brake torque", limits.full_load, 1.0),
        ("motoring torque", "brake torque", limits.motoring, -1.0),
        ("full rack", "torque demand", limits.full_load, 1.0),
        ("zero fuel", "torque demand", limits.motoring, -1.0),
    ):
        for slope, at_mean_nm in _pieces(curve, reach, speed_rpm):
            # the torque stays below the curve, or above its negative: sign M <= curve(n)
            weights = {signal: sign, "speed": -slope * speed_rpm / torque_nm}
            stated.append((name, weights, at_mean_nm / torque_nm - sign))
    bounds = tuple(_bound(name, weights, room, limits, noise, speed_rpm) for name, weights, room in stated)
    return (*bounds, *gauge_bounds(limits, speed_share))


def _bound(
    name: str, weights: dict[str, float], room: float, limits: Limits, noise: FloatArray, speed_rpm: float
) -> Bound:
    row = np.array([weights.get(signal, 0.0) for signal in SIGNALS])
    std = float(np.sqrt(row @ noise @ row))
    sigmas = limits.noise_sigmas
    if sigmas is None and set(weights) == {"speed"}:
        # a speed beyond its limit is a reason to break a test off, an instant of torque is none
        sigmas = SPEED_SIGMAS
    needed = std * (deviations_passed(limits.share_over) if sigmas is None else sigmas)
    if not room - needed > 0.0:
        stated = f"for {100.0 * limits.share_over:g} % of the time" if sigmas is None else f"{sigmas:g} deviations"
        raise DesignError(
            f"leg at {speed_rpm:g} rpm: expected room below the limit {name}, found {room:.2g} of the working point "
            f"and noise of {needed:.2g} ({stated}); choose another speed."
        )
    if sigmas is None:
        return Bound(name=name, weights=frozen_float(row), room=room, noise=std)
    return Bound(name=name, weights=frozen_float(row), room=room - needed)


def _pieces(curve: Curve, reach: tuple[float, float], speed_rpm: float) -> list[tuple[float, float]]:
    """Return slope [N m/rpm] and torque at a speed [N m] of the straight pieces of a curve within a range of speeds.

    The least of all pieces, each prolonged, is the curve where that is concave and below it elsewhere. Beyond its ends
    a curve is flat.
    """
    low, high = reach
    speeds = [speed for speed, _ in curve]
    points = [(min(low, speeds[0]) - 1.0, curve[0][1]), *curve, (max(high, speeds[-1]) + 1.0, curve[-1][1])]
    pieces = []
    for (first_rpm, first_nm), (second_rpm, second_nm) in pairwise(points):
        if second_rpm > low and first_rpm < high:
            slope = (second_nm - first_nm) / (second_rpm - first_rpm)
            pieces.append((slope, first_nm + slope * (speed_rpm - first_rpm)))
    return list(dict.fromkeys(pieces))
