"""Channels that cannot be what the vessel file says they are, by their pulses and the sign of the torque."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.digits import in_nm
from shaftprint.reasons import Reason
from shaftprint.signals._inspect import ChannelReport, PulseReport
from shaftprint.signals._load_reasons import points_of, torque_beside_file
from shaftprint.signals._scale_reasons import scale_reasons
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.signals.kinds._compare import are_alike, engine_turns, swapped_pick_ups, what_would_agree
from shaftprint.signals.levels._gauge_zero import zero_between, zero_reason
from shaftprint.signals.levels._working_point import direction_words, expect_stated_lever, turned_lever

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._signals import Signals
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

# A channel without so large a share of its values has another mean than the others.
_LOST = 0.01
# A gauge that reads less than this share of the expected torque, below zero, may be one with a zero that has moved.
_CLEARLY_NEGATIVE = -0.1
# The torque of a test is around that of the working point, which the vessel file may know badly.
_AROUND = (0.3, 3.0)


def contradictions(
    reports: Sequence[ChannelReport],
    vessel: "Vessel",
    *,
    signals: "Signals | None" = None,
    campaign: "Campaign | None" = None,
) -> tuple[str, ...]:
    """Return a sentence for each contradiction between channels and vessel file, with the swap that would end it.

    No campaign is needed: on a rigid line all pick-ups give one engine speed, a shaft that turns ahead has a positive
    torque, one that turns astern a negative one, and torque goes with the square of the speed. With the signals of a
    test the speed that was asked for says more.

    ``reports``: what each channel holds, from ``inspect_channels``. ``vessel``: says which channel carries what.
    ``signals``, ``campaign``: the prepared signals and what was asked of the ship, where both are there.
    """
    of_channels = (*_of_speeds(reports, vessel), *_of_torque(reports, vessel))
    return of_channels or _of_scales(reports, vessel, signals, campaign)


def _of_speeds(reports: Sequence[ChannelReport], vessel: "Vessel") -> tuple[str, ...]:
    pulses = {report.channel: report.pulses for report in reports if report.pulses is not None}
    # means of other times are not alike: with gaps the test compares the speeds where both have one
    cut = {report.channel for report in reports if _lost_share(report) > _LOST}
    sensors = [one for one in vessel.sensors.speed if one.channel in pulses and one.channel not in cut]
    speeds = [_engine_speed(one, pulses[one.channel], vessel) for one in sensors]
    if len(sensors) < 2 or are_alike(speeds):
        return ()
    swap = swapped_pick_ups(sensors, {channel: one.per_second for channel, one in pulses.items()}, vessel)
    return (swap or _in_words(sensors, speeds, vessel),)


def _lost_share(report: ChannelReport) -> float:
    """Return the share of the time in which a channel says nothing."""
    return sum(gap.stop_s - gap.start_s for gap in report.gaps) / report.duration_s


def _engine_speed(sensor: "SpeedSensor", pulses: PulseReport, vessel: "Vessel") -> float:
    """Return the engine speed [rev/s]."""
    return engine_turns(sensor, vessel) * pulses.per_second


def _in_words(sensors: Sequence["SpeedSensor"], found: Sequence[float], vessel: "Vessel") -> str:
    """Return how far the two pick-ups that differ most are apart, and what to check."""
    speeds = {sensor.name: speed for sensor, speed in zip(sensors, found, strict=True)}
    shafts = {sensor.name: sensor.shaft for sensor in sensors}
    low, high = min(speeds, key=speeds.__getitem__), max(speeds, key=speeds.__getitem__)
    sentence = f"expected one engine speed, found {low} = {speeds[low]:.4g} and {high} = {speeds[high]:.4g} rev/s"
    ratio = ""
    if shafts[low] != shafts[high]:
        apart = speeds[low] / speeds[high]
        ratio = f"{vessel.gearbox.ratio * (apart if shafts[high] == 'propeller' else 1.0 / apart):.4g}"
    like, check = what_would_agree(speeds, vessel, ratio=ratio)
    return f"{sentence}{like}; {check}."


def _of_torque(reports: Sequence[ChannelReport], vessel: "Vessel") -> tuple[str, ...]:
    sensor, expected = vessel.sensors.shaft_torque, vessel.working_point.shaft_torque_nm
    by_use = {report.use: report for report in reports}
    torque, set_point = by_use.get("shaft torque"), by_use.get("set point")
    if torque is None:
        # a pick-up alone is tried
        return ()

    def mean_nm(report: ChannelReport) -> float:
        return float(sensor.torque_nm(report.mean))

    mean_torque_nm = mean_nm(torque)
    if not np.isfinite(mean_torque_nm) or mean_torque_nm / expected >= _CLEARLY_NEGATIVE:
        return ()
    sentence = f"expected a torque around {in_nm(expected)}, found a mean of {in_nm(mean_torque_nm)}"
    # astern torque and set point have one sign, so that the sign tells of no swap
    alike = set_point if set_point is not None and set_point.unit == torque.unit else None
    swapped = np.nan if alike is None or vessel.working_point.is_astern else mean_nm(alike)
    if alike is not None and _AROUND[0] < swapped / expected < _AROUND[1]:
        return (
            f"channels {torque.channel} and {alike.channel} seem to be swapped: {sentence} in {torque.channel}, "
            f"and {in_nm(swapped)} in {alike.channel}. Correct the channels in the vessel file or the columns of "
            "the recording.",
        )
    sign = "the sign of sensors.shaft_torque.scale_nm_per_unit" if sensor.shaft is None else "reversed of its shaft"
    return (
        f"channel {torque.channel}: {sentence}; check that it is the torque, and {sign}; {direction_words(vessel)}.",
    )


def _of_scales(
    reports: Sequence[ChannelReport], vessel: "Vessel", signals: "Signals | None", campaign: "Campaign | None"
) -> tuple[str, ...]:
    """Return how speed and torque are off by one factor, by the test, or without one by the means of all channels."""
    beside = ""
    asked: tuple[str, ...] = ()
    if signals is not None and campaign is not None:
        if turned := turned_lever(signals.working_point, signals.calibration, vessel):
            return turned
        asked = expect_stated_lever(signals.working_point, signals.calibration, vessel)
        reasons = scale_reasons(
            signals.working_point,
            vessel,
            campaign,
            levels_rpm=signals.levels_rpm,
            legs={leg.name: leg.working_point for leg in signals.legs},
            rate_hz=signals.read_hz,
        )
        points = points_of(signals)
        beside = torque_beside_file(points, vessel)
        reasons = reasons or _of_zero(points, vessel)
    else:
        point = _mean_point(reports, vessel)
        rates_hz = {report.channel: report.rate_hz for report in reports}
        rate_hz = rates_hz.get(vessel.sensors.speed[0].channel)
        reasons = () if point is None else scale_reasons(point, vessel, rate_hz=rate_hz)
    # a speed that is miscounted makes another torque of the same
    return tuple(reason.sentence for reason in reasons) or (*asked, *((beside,) if beside else ()))


def _of_zero(points: Sequence[WorkingPoint], vessel: "Vessel") -> tuple[Reason, ...]:
    """Return what the torque of two speeds says of the zero of the gauge; a pitch that goes with them moves it too."""
    found = None if vessel.pitch is not None else zero_between(points)
    reason = None if found is None else zero_reason(*found, points[0].shaft_torque_nm, vessel)
    return () if reason is None else (reason,)


def _mean_point(reports: Sequence[ChannelReport], vessel: "Vessel") -> WorkingPoint | None:
    """Return the means of speed and torque of a whole recording; None where there are none."""
    by_channel = {report.channel: report for report in reports}
    sensor = vessel.sensors.speed[0]
    shown, torque = (by_channel.get(one.channel) for one in (sensor, vessel.sensors.shaft_torque))
    if shown is None or torque is None or sensor.gives_angle or (sensor.gives_pulses and shown.pulses is None):
        return None
    if shown.pulses is not None:
        speed = _engine_speed(sensor, shown.pulses, vessel)
    else:
        speed = abs(float(sensor.speed_rev_s(shown.mean))) * vessel.gearbox.engine_over(sensor.shaft)
    torque_nm = float(vessel.driving_torque_nm(torque.mean))
    if not speed > 0.0 or not np.isfinite(torque_nm):
        return None
    return WorkingPoint(
        engine_speed_rev_s=speed,
        shaft_torque_nm=torque_nm,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=0.0,
        load_std=0.0,
    )
