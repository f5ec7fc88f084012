"""Whether the torque is that of the propeller of the vessel file, and what to check where it is not."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.reasons import OTHER_SHIP, Reason
from shaftprint.signals.levels._speed_scale import load_over_expected
from shaftprint.spelling import listed
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

# What is stated of the torque where the file states nothing, as of a propeller series, and the least that wind, current
# and draught of a day change it by.
_USUAL, _LEAST = 0.15, 0.1
# The same with a pitch that is controlled.
_OF_PITCH = 0.7
# So many standard deviations are no chance.
FAR = 3.5
# Fouling, damage and the load of a day change the logarithm of a torque coefficient by no more.
_MOST_OF_SHIP = math.log(1.4)
LARGEST_BY_DAY = 1.2
"""The largest factor of the torque that weather, draught and fouling make of one propeller without a finding."""
# Torque at one speed goes with this power of the diameter.
_OF_DIAMETER = 5.0
# Logarithm of a factor of the torque beyond what a propeller that was replaced makes.
_OF_ANOTHER_SHIP = math.log(2.0)


def points_of(signals: "Signals") -> "tuple[WorkingPoint, ...]":
    """Return mean speed and torque of each level of a test, the working point first."""
    return tuple(dict.fromkeys((signals.working_point, *(leg.working_point for leg in signals.legs))))


def torque_beside_file(points: Sequence["WorkingPoint"], vessel: "Vessel") -> str:
    """Return that the torque at every level is far from that of the vessel file, and what would fit; empty if not.

    A torque that is known to 15 % contradicts nothing within that: what counts is how many standard deviations of all
    that the file states lie between both. ``points``: mean speed and torque of each level, the working point first.
    """
    found = _beside(points, vessel)
    if found is None or found[1] <= FAR:
        return ""
    return f"channel {vessel.sensors.shaft_torque.channel}: {_in_words(points, vessel, found[1])}."


def torque_to_look_at(points: Sequence["WorkingPoint"], vessel: "Vessel") -> str:
    """Return that the torque is another than that of the vessel file by more than one ship's days make of it.

    A torque that the file has as a guess contradicts little, and its size is worth a look all the same. Empty where
    `torque_beside_file` says more, and where the pitch or way of the ship may be the cause.
    """
    found = _beside(points, vessel)
    if found is None or vessel.is_underway or vessel.pitch is not None:
        return ""
    if found[1] > FAR or found[0] <= math.log(LARGEST_BY_DAY):
        return ""
    return f"The torque is none that the vessel file lets expect: {_in_words(points, vessel, found[1])}."


def _beside(points: Sequence["WorkingPoint"], vessel: "Vessel") -> tuple[float, float] | None:
    """Return how far the torque is from that of the vessel file at the least, as a logarithm and in deviations.

    None where it is at one level on the one side, and at another on the other: a scale makes all of them alike.
    """
    loads = [load_over_expected(point, vessel) for point in points]
    if not min(loads) > 0.0:
        return None
    logs = [math.log(load) for load in loads]
    if min(logs) < 0.0 < max(logs):
        return None
    away = (abs(log) / std_of_load(point, vessel) for log, point in zip(logs, points, strict=True))
    return min(abs(log) for log in logs), min(away)


def _in_words(points: Sequence["WorkingPoint"], vessel: "Vessel", away: float) -> str:
    point, load = points[0], load_over_expected(points[0], vessel)
    found_nm = vessel.working_point.turning * point.shaft_torque_nm
    further = "".join(
        f", {load_over_expected(at, vessel):.2f} times at {rpm_from_rev_s(at.engine_speed_rev_s):.4g} rpm"
        for at in points[1:]
    )
    return (
        f"expected a torque around {_rounded(found_nm / load)} N m at "
        f"{rpm_from_rev_s(point.engine_speed_rev_s):.4g} rpm by working_point of the vessel file, found "
        f"{_rounded(found_nm)} N m, {load:.2f} times that{further}, "
        f"{away:.1f} standard deviations of what is stated; "
        f"check {what_fits(load, vessel, std_of_load(point, vessel))}"
    )


def ratio_that_fits(factor: float, vessel: "Vessel") -> str:
    """Return the gear ratio with which a torque over the square of the speed is that of the vessel file, in words.

    Empty where a pick-up on the propeller's shaft shows its speed, ratio or not. ``factor``: found over expected.
    """
    if not rests_on_ratio(vessel):
        return ""
    ratio = vessel.gearbox.ratio
    return f"gearbox.ratio ({ratio:g} is stated, {ratio / factor**0.5:.3g} would fit)"


def rests_on_ratio(vessel: "Vessel") -> bool:
    """Return whether the speed of the propeller is that of the engine over the gear ratio: no pick-up shows it."""
    return vessel.gearbox.ratio != 1.0 and all(one.shaft == "engine" for one in vessel.sensors.speed)


def propeller_reason(
    coefficient: float,
    point: "WorkingPoint",
    vessel: "Vessel",
    *,
    std: float | None = None,
    confirmed_by: str = "",
    is_ratio_known: bool = False,
) -> Reason | None:
    """Return that the torque belongs to a propeller of another size, or to another gear ratio; None where to neither.

    The torque coefficient is far from what is stated, by more than fouling, damage or the load of a day make of it, and
    the torque itself is that of the working point, or something else confirms the scale of the gauge. Of a torque as
    stated no guess makes another coefficient: diameter, pitch and ratio of the file make it.

    ``coefficient``: the torque coefficient that was found. ``point``: mean speed and torque. ``std``: standard
    deviation of its logarithm over the stated one; by what is stated where it is None. ``confirmed_by``: what confirms
    the scale of the gauge besides. ``is_ratio_known``: whether the inertia behind the gauge confirms the gear ratio.
    """
    if vessel.is_underway or vessel.pitch is not None or not coefficient > 0.0:
        return None
    load, factor = load_over_expected(point, vessel), coefficient / vessel.torque_coefficient
    like_file = load > 0.0 and abs(math.log(load)) < min(abs(math.log(factor)) / 2.0, _MOST_OF_SHIP)
    least = 0.0 if like_file else FAR * (std_of_load(point, vessel) if std is None else std)
    if abs(math.log(factor)) <= max(_MOST_OF_SHIP, least) or not (like_file or confirmed_by):
        return None
    agreeing = [*(["the torque"] if like_file else []), *([confirmed_by] if confirmed_by else [])]
    diameter_m, ratio = vessel.propeller.diameter_m, "" if is_ratio_known else ratio_that_fits(factor, vessel)
    further = [*([ratio] if ratio else []), *(["whether the ship took way"] if load < 0.8 else [])]
    check = ["diameter_m", "pitch_ratio", "torque_coefficient of the propeller", *further]
    return Reason(
        kind="gear ratio" if ratio else "propeller",
        where="K_Q",
        sentence=(
            f"The torque fits a propeller of {diameter_m * factor ** (1.0 / _OF_DIAMETER):.3g} m, and diameter_m is "
            f"{diameter_m:g} m: K_Q is {coefficient:.4g} in place of {vessel.torque_coefficient:.4g}, while "
            f"{listed(agreeing)} {'is' if len(agreeing) == 1 else 'are'} as the vessel file says; "
            f"check {listed(check)}."
        ),
    )


def _rounded(value: float) -> str:
    """Return a number with four digits, without a power of ten."""
    return f"{float(f'{value:.4g}'):g}"


def std_of_load(point: "WorkingPoint", vessel: "Vessel") -> float:
    """Return the standard deviation of the torque that is expected, over it, with that of the gauge."""
    sensor, stated = vessel.sensors.shaft_torque, vessel.torque_coefficient_std
    load = max(_USUAL if stated is None else stated / vessel.torque_coefficient, _LEAST)
    pitch = 0.0 if vessel.pitch is None else _OF_PITCH
    return math.hypot(load, sensor.scale_std, sensor.zero_std / point.shaft_torque_nm, pitch)


def what_fits(load: float, vessel: "Vessel", std: float = 0.0) -> str:
    """Return what to check where the torque over the square of the speed is off by a factor, with values that fit.

    ``load``: found over expected. ``std``: how well its logarithm is known; of a factor that the inertia behind the
    gauge shares the gear is none, and nothing is said of it where this is 0.
    """
    sensor, gearbox, diameter_m = vessel.sensors.shaft_torque, vessel.gearbox, vessel.propeller.diameter_m
    scale = sensor.scale_nm_per_unit
    causes = [
        f"the scale of {sensor.channel} ({scale:g} N m for one {sensor.unit} is stated, {scale / load:.4g} would fit)",
        f"the propeller (diameter_m = {diameter_m:g} is stated, {diameter_m * load ** (1.0 / _OF_DIAMETER):.3g} would "
        "fit, or another pitch)",
    ]
    log, of_gear = math.log(load), math.log(gearbox.ratio)
    if abs(log + of_gear) < 2.0 * std:
        causes.append(f"whether it is the torque of the engine's shaft, before the gear of {gearbox.ratio:g}")
    elif abs(log - of_gear) < 2.0 * std:
        causes.append(f"whether the gear of {gearbox.ratio:g} is in its scale a second time")
    elif std and (ratio := ratio_that_fits(load, vessel)):
        causes.append(ratio)
    if std and load < 1.0 and not vessel.is_underway:
        causes.append("whether the ship took way")
    if abs(log) > _OF_ANOTHER_SHIP:
        causes.insert(0, OTHER_SHIP)
    return listed(causes)
