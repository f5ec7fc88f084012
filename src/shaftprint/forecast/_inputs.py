"""What moves a simulation: a campaign, or columns of a file, in the units of the structure."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import RecordingError, RequestError
from shaftprint.forecast._ship_before_test import ShipBeforeTest
from shaftprint.models._structure import Structure
from shaftprint.recording._channel import Channel
from shaftprint.recording._read import read_recording

SET_POINT, SET_POINT_CHANNEL = "n_set", "set point"
# Steps of a simulated campaign: a limit that a jump meets is seen half a step early. Longer stretches than a million
# steps get longer steps.
SHORTEST_STEP_S, LONGEST_STEP_S, MOST_STEPS = 1e-3, 5e-3, 1e6
# Beside a jump, on both sides.
_BESIDE_S = 1e-7
# What is put out and what is logged as set point differ by the error of the voltmeter; more is another working point.
SAME_WORKING_POINT = 0.05


@dataclass(frozen=True, kw_only=True, slots=True)
class Point:
    """The working point about which the structure deviates, and the line from voltage to speed."""

    engine_speed_rpm: float
    """Engine speed [rpm]."""
    shaft_torque_nm: float
    """Shaft torque at the gauge [N m]."""
    slope_rpm_per_v: float | None
    """Engine speed for one volt of set point [rpm/V]; None where it is not known."""
    intercept_rpm: float | None
    """Engine speed of that line at no voltage [rpm]; None for the one that gives the working point at the offset."""
    shaft_speed_rpm: float | None = None
    """Speed of a shaft that clutches part from the engine [rpm]; None where none do."""
    ship_speed_m_s: float | None = None
    """Speed of a ship that is stopped [m/s]; None of one that is not."""

    def deviation(self, volts: FloatArray, *, offset_v: float | None = None) -> FloatArray:
        """Return the set point as a deviation from the working point [-].

        ``volts``: set point [V]. ``offset_v``: set point that is put out at the working point [V]; as measured by the
        line if not given. Raises RequestError if nothing says what a volt asks for.
        """
        if self.slope_rpm_per_v is None or (self.intercept_rpm is None and offset_v is None):
            raise RequestError(
                "a set point in volt needs --fingerprint, or a campaign, --vessel and --rpm-per-volt, or "
                "slope_rpm_per_v in the campaign file."
            )
        if offset_v is not None:
            return frozen_float(self.slope_rpm_per_v * (volts - offset_v) / self.engine_speed_rpm)
        speed = self.slope_rpm_per_v * volts + (self.intercept_rpm or 0.0)
        return frozen_float(speed / self.engine_speed_rpm - 1.0)

    def is_put_out_at(self, offset_v: float) -> bool:
        """Return whether the offset of a campaign is that of the working point, but for the error of a voltmeter."""
        if self.intercept_rpm is None:
            return True
        return abs(float(self.deviation(np.array([offset_v]))[0])) < SAME_WORKING_POINT


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Inputs:
    """Inputs over time."""

    time_s: FloatArray
    """Uniform times of what is written [s], shape (samples,)."""
    every: int
    """Steps of the inputs between two of these times."""
    inputs: Mapping[str, FloatArray]
    """Each input, shape ((samples - 1) every + 1,)."""
    shown: Mapping[str, FloatArray]
    """Each input at the times that are written, shape (samples,)."""
    units: Mapping[str, str]
    """Unit of each input; empty where a file does not say."""
    hold: bool
    """Whether an input keeps its value until the next, instead of being straight between two."""
    remark: str = ""
    """What a reader must know about it."""

    @property
    def fine_time_s(self) -> FloatArray:
        """Times of the inputs [s]."""
        count = next(iter(self.inputs.values())).size
        interval = (self.time_s[1] - self.time_s[0]) / self.every
        return frozen_float(self.time_s[0] + interval * np.arange(count))


def point_of(ship: ShipBeforeTest) -> Point | None:
    """Return the working point of a first test or a vessel file; None where neither is given.

    Raises RequestError if both are given, or a slope without a vessel file.
    """
    fingerprint, vessel, slope_rpm_per_v = ship.first_test, ship.vessel, ship.slope_rpm_per_v
    if fingerprint is not None:
        if vessel is not None or slope_rpm_per_v is not None:
            raise RequestError("--vessel and --rpm-per-volt are for a simulation without --fingerprint.")
        conditions = fingerprint.conditions
        speed = conditions.engine_speed.value
        # what a deviation of the set point is multiplied by, so that speed follows it at low frequency
        scale = fingerprint.quantity("set-point scale").value
        slope = fingerprint.quantity("set-point slope").value
        intercept = fingerprint.quantity("set-point intercept").value
        return Point(
            engine_speed_rpm=speed,
            shaft_torque_nm=conditions.shaft_torque.value,
            slope_rpm_per_v=scale * slope,
            intercept_rpm=speed + scale * (intercept - speed),
        )
    if vessel is None:
        if slope_rpm_per_v is not None:
            raise RequestError("--rpm-per-volt needs --vessel, which says at what speed.")
        return None
    stated = vessel.working_point
    return Point(
        engine_speed_rpm=stated.engine_speed_rpm,
        shaft_torque_nm=stated.driving_torque_nm,
        slope_rpm_per_v=slope_rpm_per_v,
        intercept_rpm=None,
    )


def campaign_inputs(
    campaign: Campaign, structure: Structure, point: Point | None, *, rate_hz: float, span: tuple[float, float] | None
) -> Inputs:
    """Return the set point of a campaign.

    It is straight over short times; at a jump it is half-way, so that it is neither late nor early.

    ``rate_hz``: samples a second that are written [Hz]. ``span``: begin and end [s]; the whole campaign if not given.
    Raises RequestError if the structure has another input than the set point, the line from volt is not known, or the
    campaign does not hold the span.
    """
    if structure.inputs != (SET_POINT,):
        raise RequestError(
            f"--campaign sets {SET_POINT}, structure {structure.name} goes from {', '.join(structure.inputs)}; give "
            "its inputs with --input."
        )
    if point is None:
        raise RequestError("--campaign is in volt: give --fingerprint, or --vessel and --rpm-per-volt.")
    point = _with_lever_of(campaign, point)
    begin, end = span or (0.0, campaign.duration_s)
    if end > campaign.duration_s:
        raise RequestError(f"--between: campaign {campaign.name} ends at {campaign.duration_s:g} s, not {end:g} s.")
    step_s = float(np.clip((end - begin) / MOST_STEPS, SHORTEST_STEP_S, LONGEST_STEP_S))
    every = int(np.ceil(1.0 / (rate_hz * step_s) - 1e-9))
    samples = _at_least_two(int(np.floor((end - begin) * rate_hz + 1e-9)) + 1)
    time = frozen_float(begin + np.arange(samples) / rate_hz)
    fine = begin + np.arange((samples - 1) * every + 1) / (rate_hz * every)
    set_point = 0.5 * (_asked(campaign, point, fine - _BESIDE_S) + _asked(campaign, point, fine + _BESIDE_S))
    set_point[0] = _asked(campaign, point, fine[:1] + _BESIDE_S)[0]
    return Inputs(
        time_s=time,
        every=every,
        inputs={SET_POINT: set_point},
        # a step that is due now has been made
        shown={SET_POINT: _asked(campaign, point, time + _BESIDE_S)},
        units={SET_POINT: "-"},
        hold=False,
        remark=_remark(campaign, point),
    )


def _with_lever_of(campaign: Campaign, point: Point) -> Point:
    """Return a working point with the line of the campaign's lever, where that is stated and nothing else is."""
    slope = campaign.slope_rpm_per_v
    if point.slope_rpm_per_v is not None or slope is None:
        return point
    at_offset_rpm = point.engine_speed_rpm if campaign.offset_rpm is None else campaign.offset_rpm
    return replace(point, slope_rpm_per_v=slope, intercept_rpm=at_offset_rpm - slope * campaign.offset_v)


def _asked(campaign: Campaign, point: Point, time_s: FloatArray) -> FloatArray:
    offset_v = campaign.offset_v if point.is_put_out_at(campaign.offset_v) else None
    return point.deviation(setpoint(campaign, time_s), offset_v=offset_v)


def _remark(campaign: Campaign, point: Point) -> str:
    if point.is_put_out_at(campaign.offset_v):
        return (
            f"{campaign.offset_v:g} V of the campaign is taken as the working point, {point.engine_speed_rpm:.1f} rpm."
        )
    return (
        f"{campaign.offset_v:g} V of the campaign is another working point than {point.engine_speed_rpm:.1f} rpm. "
        "The fingerprint's line from volt to rpm was taken; a linear structure is carried away from where it holds."
    )


def file_inputs(
    path: Path, structure: Structure, point: Point | None, *, hold: bool, span: tuple[float, float] | None
) -> Inputs:
    """Return inputs that are columns of a file: named as those of the structure, or a set point in rpm or volt.

    Raises RecordingError if the file cannot be read, a column is missing, or two have different clocks.
    """
    with read_recording(path) as recording:
        channels = {name: _channel(recording.channels, name, path) for name in structure.inputs}
        uneven = [name for name, channel in channels.items() if channel.is_uneven]
        if uneven:
            raise RecordingError(
                f"{path}: expected inputs at one rate, found messages at times of their own in {', '.join(uneven)}; "
                "put them on one: shaftprint convert --rate."
            )
        clocks = {(channel.rate_hz, channel.start_s, channel.count) for channel in channels.values()}
        if len(clocks) != 1:
            raise RecordingError(f"{path}: expected one clock for {', '.join(channels)}, found {len(clocks)}.")
        ((rate_hz, start_s, count),) = clocks
        first, last = 0, count
        if span is not None:
            first, last = (round((at - start_s) * rate_hz) for at in span)
            if first < 0 or last >= count:
                raise RecordingError(
                    f"{path}: expected {span[0]:g} to {span[1]:g} s within the file, found {start_s:g} to "
                    f"{start_s + (count - 1) / rate_hz:g} s."
                )
            last += 1
        _at_least_two(last - first)
        time = start_s + np.arange(first, last) / rate_hz
        inputs = {name: _in_own_units(channel, path, name, point, first, last) for name, channel in channels.items()}
    units = {name: "-" if name == SET_POINT else channel.unit for name, channel in channels.items()}
    return Inputs(time_s=time, every=1, inputs=inputs, shown=inputs, units=units, hold=hold)


def _channel(channels: Mapping[str, Channel], name: str, path: Path) -> Channel:
    for title in (name, SET_POINT_CHANNEL) if name == SET_POINT else (name,):
        if title in channels:
            return channels[title]
    also = ' (deviation) or "set point [rpm]" or "set point [V]"' if name == SET_POINT else ""
    raise RecordingError(f'{path}: expected a column "{name}"{also}, found {", ".join(channels)}.')


def _in_own_units(channel: Channel, path: Path, name: str, point: Point | None, first: int, last: int) -> FloatArray:
    values = channel.values(first, last)
    if not np.all(np.isfinite(values)):
        at = channel.time_s(first, last)[~np.isfinite(values)][0]
        raise RecordingError(f"{path}, column {channel.name}: expected numbers, found none at {at:g} s.")
    if name != SET_POINT or (channel.name == SET_POINT and channel.unit in ("-", "")):
        return values
    if point is None:
        raise RequestError(
            f"{path}: a set point in {channel.unit or 'no unit'} needs a working point: give --fingerprint or --vessel."
        )
    match channel.unit:
        case "rpm":
            return values / point.engine_speed_rpm - 1.0
        case "V":
            return point.deviation(values)
        case _:
            raise RecordingError(
                f'{path}, column {channel.name}: expected a set point in "rpm" or "V", or "{SET_POINT} [-]", found the '
                f'unit "{channel.unit}".'
            )


def _at_least_two(samples: int) -> int:
    if samples < 2:
        raise RequestError("--between: expected a stretch of two samples or more, found less; begin comes first.")
    return samples
