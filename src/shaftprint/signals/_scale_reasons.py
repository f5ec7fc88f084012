"""Why the scales of speed and torque are in doubt, with the field of the vessel file that would mend it."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import in_nm
from shaftprint.reasons import OTHER_SHIP, Reason
from shaftprint.signals.kinds._compare import LARGEST_DIFFERENCE
from shaftprint.signals.levels._speed_scale import (
    ScaleDoubt,
    ScaleEvidence,
    asked_speed,
    evidence_between,
    load_over_expected,
    scale_doubt,
    scale_evidence,
)
from shaftprint.spelling import listed
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

# A factor is that of the gear within so much: the efficiency of the gear, and a load of another day.
_LIKE_GEAR = 0.15
# What is stated of the torque where the file states nothing, as of a propeller series, and the least that wind, current
# and draught of a day change it by.
_USUAL, _LEAST = 0.15, 0.1
# The same with a pitch that is controlled.
_OF_PITCH = 0.7
# So many standard deviations are no chance.
FAR = 3.5
# A torque belongs to a speed within so many standard deviations of its load, and to no speed so many away.
_AGREES, _FAR_OFF = 1.0, 3.0
# Fouling, damage and the load of a day change the logarithm of a torque coefficient by no more.
_MOST_OF_SHIP = math.log(1.4)
# Torque at one speed goes with this power of the diameter.
_OF_DIAMETER = 5.0
# Logarithm of a factor of the torque beyond what a propeller that was replaced makes.
_OF_ANOTHER_SHIP = math.log(2.0)


def scale_reasons(
    point: "WorkingPoint",
    vessel: "Vessel",
    campaign: "Campaign | None" = None,
    *,
    levels_rpm: Sequence[float] = (),
    legs: Mapping[str, "WorkingPoint"] | None = None,
    of_fit: Mapping[str, ScaleEvidence] | None = None,
    beside: Mapping[str, float] | None = None,
    rate_hz: float | None = None,
) -> tuple[Reason, ...]:
    """Return a reason where the speed is off by one factor, or the torque is that of another shaft.

    ``point``: mean speed and torque, and the set point at which they were. ``vessel``: the vessel file. ``campaign``:
    says which speed was asked for; None where nobody says what was done in the recording. ``levels_rpm``: mean engine
    speeds that were governed [rpm]. ``legs``: mean speed and torque of each leg, by its name: one factor for all of
    them is not all that can be wrong. ``of_fit``: what a fit tells of the scales besides, by its name. ``beside``:
    found over expected of what follows from them, by name, to be told. ``rate_hz``: samples a second at which the
    recording was read.
    """
    further = of_fit or {}
    evidence = (*scale_evidence(point, vessel, campaign), *further.values())
    doubt = scale_doubt(evidence, vessel, levels_rpm=levels_rpm)
    if doubt is None:
        return () if campaign is None else _between_legs(point, legs or {}, vessel, campaign)
    told = beside or {}
    if doubt.of == "torque":
        return (_of_torque(doubt, point, vessel, told),)
    expected_rpm, load = vessel.working_point.engine_speed_rpm, load_over_expected(point, vessel)
    found_rpm = rpm_from_rev_s(point.engine_speed_rev_s)
    asked_rpm = expected_rpm if campaign is None else asked_speed(point, vessel, campaign)[0]
    if _torque_agrees(load, doubt.factor, _std_of_load(point, vessel)):
        channel = vessel.sensors.set_point.channel
        return (
            Reason(
                kind="set-point scale",
                where=channel,
                sentence=(
                    f"The set point is in doubt: {channel} asks for {asked_rpm:.4g} rpm, and speed and torque agree on "
                    f"{found_rpm:.4g} rpm; check the line of the lever (table_rpm of sensors.set_point, and its sign), "
                    "and the offset of the campaign."
                ),
            ),
        )
    by = "vessel file" if campaign is None or campaign.offset_rpm is None else "campaign"
    torque = (
        f"{in_nm(point.shaft_torque_nm)} belong to {found_rpm * load**0.5:.4g} rpm and the {by} has" if load > 0.0
        else f"the {by} has"
    )  # fmt: skip
    followers = _told(told, " as one factor of the speed makes them")
    return (
        Reason(
            kind="speed scale",
            where=vessel.sensors.speed[0].channel,
            sentence=(
                f"The speed is in doubt: it seems to be {doubt.words} the true one, {found_rpm:.4g} rpm where {torque} "
                f"{asked_rpm:.4g} rpm{followers}; {what_to_check(doubt.factor, vessel, rate_hz)}."
            ),
        ),
    )


def _torque_agrees(load: float, factor: float, std: float) -> bool:
    """Return whether the torque belongs to the speed as it is shown, and cannot to one that is off by a factor.

    Then it is the set point that asks for another speed: its line, not the speed. ``load``: torque over the square of
    the speed, over that of the vessel file, with the deviation ``std`` of its logarithm.
    """
    if not load > 0.0:
        return False
    return abs(math.log(load)) < _AGREES * std < _FAR_OFF * std < abs(math.log(load) + 2.0 * math.log(factor))


def _between_legs(
    point: "WorkingPoint", legs: Mapping[str, "WorkingPoint"], vessel: "Vessel", campaign: "Campaign"
) -> tuple[Reason, ...]:
    """Return a reason where the speed of one leg is off by one factor beside that of the working point."""
    main = next((name for name, one in legs.items() if one == point), "the working point")
    for name, one in legs.items():
        doubt = scale_doubt(evidence_between(one, point, vessel, campaign), vessel)
        if doubt is None or doubt.of == "torque":
            continue
        found_rpm = rpm_from_rev_s(one.engine_speed_rev_s)
        torque_rpm = rpm_from_rev_s(point.engine_speed_rev_s) * (one.shaft_torque_nm / point.shaft_torque_nm) ** 0.5
        return (
            Reason(
                kind="speed scale",
                where=vessel.sensors.speed[0].channel,
                sentence=(
                    f"The speed is in doubt: in {name} it seems to be {doubt.words} the true one beside that of "
                    f"{main}, {found_rpm:.4g} rpm where {in_nm(one.shaft_torque_nm)} belong to {torque_rpm:.4g} rpm "
                    f"by the torque there; look for what divides, doubles or loses pulses in one of the two, and test "
                    "again."
                ),
            ),
        )
    return ()


def torque_beside_file(points: Sequence["WorkingPoint"], vessel: "Vessel") -> str:
    """Return that the torque at every level is far from that of the vessel file, and what would fit; empty if not.

    A torque that is known to 15 % contradicts nothing within that: what counts is how many standard deviations of all
    that the file states lie between both. ``points``: mean speed and torque of each level, the working point first.
    """
    sensor = vessel.sensors.shaft_torque
    loads = [load_over_expected(point, vessel) for point in points]
    if not min(loads) > 0.0:
        return ""
    logs = [math.log(load) for load in loads]
    std = [_std_of_load(point, vessel) for point in points]
    away = min(abs(log) / one for log, one in zip(logs, std, strict=True))
    # a scale makes all levels too large or all too small
    if away <= FAR or min(logs) < 0.0 < max(logs):
        return ""
    point, load, turning = points[0], loads[0], vessel.working_point.turning
    found_nm = turning * point.shaft_torque_nm
    further = "".join(
        f", {one:.2f} times at {rpm_from_rev_s(at.engine_speed_rev_s):.4g} rpm"
        for at, one in zip(points[1:], loads[1:], strict=True)
    )
    return (
        f"channel {sensor.channel}: expected a torque around {_rounded(found_nm / load)} N m at "
        f"{rpm_from_rev_s(point.engine_speed_rev_s):.4g} rpm by working_point of the vessel file, found "
        f"{_rounded(found_nm)} N m, {load:.2f} times that{further}, "
        f"{away:.1f} standard deviations of what is stated; check {what_fits(load, vessel, std[0])}."
    )


def propeller_reason(
    coefficient: float, point: "WorkingPoint", vessel: "Vessel", *, std: float | None = None, confirmed_by: str = ""
) -> Reason | None:
    """Return that the torque belongs to a propeller of another size; None where gauge, gear or ship may be the cause.

    The torque coefficient is far from what is stated, by more than fouling, damage or the load of a day make of it, and
    the torque itself is that of the working point, or something else confirms the scale of the gauge.

    ``coefficient``: the torque coefficient that was found. ``point``: mean speed and torque. ``std``: standard
    deviation of its logarithm over the stated one; by what is stated where it is None. ``confirmed_by``: what confirms
    the scale of the gauge besides.
    """
    if vessel.is_underway or vessel.pitch is not None or not coefficient > 0.0:
        return None
    load, factor = load_over_expected(point, vessel), coefficient / vessel.torque_coefficient
    is_far = abs(math.log(factor)) > max(_MOST_OF_SHIP, FAR * (_std_of_load(point, vessel) if std is None else std))
    like_file = load > 0.0 and abs(math.log(load)) < min(abs(math.log(factor)) / 2.0, _MOST_OF_SHIP)
    if not is_far or not (like_file or confirmed_by):
        return None
    agreeing = [*(["the torque"] if like_file else []), *([confirmed_by] if confirmed_by else [])]
    diameter_m = vessel.propeller.diameter_m
    shafts = {one.shaft for one in vessel.sensors.speed}
    further = [*([] if len(shafts) > 1 else ["gearbox.ratio"]), *(["whether the ship took way"] if load < 0.8 else [])]
    check = ["diameter_m", "pitch_ratio", "torque_coefficient of the propeller", *further]
    return Reason(
        kind="propeller",
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


def _std_of_load(point: "WorkingPoint", vessel: "Vessel") -> float:
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
    elif std and all(one.shaft == "engine" for one in vessel.sensors.speed):
        # a pick-up on each shaft tells the ratio, and one on the propeller's alone needs none
        causes.append(f"gearbox.ratio ({gearbox.ratio:g} is stated, {gearbox.ratio / load**0.5:.3g} would fit)")
    if std and load < 1.0 and not vessel.is_underway:
        causes.append("whether the ship took way")
    if abs(log) > _OF_ANOTHER_SHIP:
        causes.insert(0, OTHER_SHIP)
    return listed(causes)


def _told(beside: Mapping[str, float], ending: str) -> str:
    if not beside:
        return ""
    names, factors = " and ".join(beside), " and ".join(f"{factor:.2f}" for factor in beside.values())
    return f", with {names} {factors} times what the vessel file expects,{ending}"


def what_to_check(factor: float, vessel: "Vessel", rate_hz: float | None = None) -> str:
    """Return which field of the vessel file would make a speed right that is shown so many times too large.

    ``rate_hz``: samples a second at which the recording was read: pulses come as often as samples are said to.
    """
    stated_hz = None if vessel.logger is None else vessel.logger.sample_rate_hz
    if stated_hz is not None and rate_hz is not None and abs(rate_hz / stated_hz / factor - 1.0) < _LIKE_GEAR / 2.0:
        return (
            f"the recording was read at {rate_hz:g} Hz, and sample_rate_hz of the logger is {stated_hz:g} Hz in the "
            f"vessel file, with which the speed fits: read it with --sample-rate {stated_hz:g}"
        )
    sensors, ratio = vessel.sensors.speed, vessel.gearbox.ratio
    # pick-ups that differ by more would have been refused: one of them may be off by less
    if len(sensors) > 1 and abs(factor - 1.0) > LARGEST_DIFFERENCE:
        names = ", ".join(sensor.channel for sensor in sensors)
        return (
            f"all of {names} agree, so look for what divides or doubles their pulses on the way to the logger, and "
            "check pulses_per_revolution, and the speeds of working_point and campaign"
        )
    sensor = sensors[0]
    away = {"propeller": 1.0 / ratio, "engine": ratio}
    other = "propeller" if sensor.shaft == "engine" else "engine"
    if abs(factor / away[other] - 1.0) < _LIKE_GEAR and abs(ratio - 1.0) > _LIKE_GEAR:
        return (
            f'that is the gear ratio of {ratio:g}: write shaft = "{other}" for {sensor.channel} if it is on the '
            f"{other}'s shaft{_or_count(factor, sensor)}"
        )
    return f"check {_counted(factor, sensor)}"


def _or_count(factor: float, sensor: "SpeedSensor") -> str:
    return f", or check {_counted(factor, sensor)}"


def _counted(factor: float, sensor: "SpeedSensor") -> str:
    """Return the field by which a sensor counts turns, with the value that would fit."""
    if sensor.gives_angle:
        return f"counts_per_revolution or the unit of {sensor.channel}"
    if not sensor.gives_pulses and sensor.unit != "Hz":
        return f"unit, scale and shaft of {sensor.channel}"
    stated = sensor.pulses_per_revolution
    fitting = stated * factor
    if fitting > 0.75 and abs(round(fitting) / fitting - 1.0) < _LIKE_GEAR / 2.0:
        return f"pulses_per_revolution of {sensor.channel}: {stated} is stated, {round(fitting)} would fit"
    camshaft = ", as on the camshaft of a four-stroke engine" if 0.4 < fitting < 0.6 else ""
    return f"pulses_per_revolution of {sensor.channel}: {stated} is stated, and {fitting:.3g} come in a turn{camshaft}"


def _of_torque(doubt: ScaleDoubt, point: "WorkingPoint", vessel: "Vessel", beside: Mapping[str, float]) -> Reason:
    sensor, ratio = vessel.sensors.shaft_torque, vessel.gearbox.ratio
    load = load_over_expected(point, vessel)
    what = (
        "it seems to be that of the engine's shaft"
        if doubt.factor < 1.0
        else "the gear ratio seems to be in its scale a second time"
    )
    return Reason(
        kind="gauge scale",
        where=sensor.channel,
        sentence=(
            f"The scale of the torque gauge is in doubt: the torque over the square of the speed is {load:.3g} times "
            f"what the vessel file expects{_told(beside, '')} near the gear ratio of {ratio:g}: {what}; check "
            f"scale_nm_per_unit of {sensor.channel}, which counts on the propeller's shaft: "
            f"{sensor.scale_nm_per_unit / doubt.factor:.4g} would fit."
        ),
    )
