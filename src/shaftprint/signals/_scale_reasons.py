"""Why the scales of speed and torque are in doubt, with the field of the vessel file that would mend it."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import in_nm
from shaftprint.reasons import Reason
from shaftprint.signals._load_reasons import std_of_load
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
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

# A factor is that of the gear within so much: the efficiency of the gear, and a load of another day.
_LIKE_GEAR = 0.15
# A torque belongs to a speed within so many standard deviations of its load, and to no speed so many away.
_AGREES, _FAR_OFF = 1.0, 3.0


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
    if _torque_agrees(load, doubt.factor, std_of_load(point, vessel)):
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


def _told(beside: Mapping[str, float], ending: str) -> str:
    if not beside:
        return ""
    names, factors = " and ".join(beside), " and ".join(f"{factor:.2f}" for factor in beside.values())
    return f", with {names} {factors} times what the vessel file expects,{ending}"


def what_to_check(factor: float, vessel: "Vessel", rate_hz: float | None = None) -> str:
    """Return which field of the vessel file would make a speed right that is shown so many times too large.

    ``rate_hz``: samples a second at which the recording was read: pulses come as often as samples are said to.
    """
    logger, is_counted = vessel.logger, vessel.sensors.speed[0].gives_pulses
    # a value in rpm is the same at any rate
    stated_hz = logger.sample_rate_hz if logger is not None and is_counted else None
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
        return (
            f"the scale of {sensor.channel} ({1.0 / factor:.3g} times it would fit, as with another factor in the file "
            "that describes a bus), its unit and its shaft"
        )
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
