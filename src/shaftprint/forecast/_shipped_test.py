"""A shipped test for another ship: the same share of the working speed, by that ship's own lever."""

from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.design.inputs._set_point_line import line_of_sensor
from shaftprint.errors import RequestError
from shaftprint.settings import Settings

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# What the lever asks for of which the shipped tests were made: at this voltage this speed, and so much more per volt.
_MADE_AT_V: Final = -5.0
_MADE_AT_RPM: Final = 1183.8
_MADE_FOR_RPM_PER_V: Final = -251.2
_DIGITS: Final = 6
_Noun = TypeVar("_Noun", bound=Settings)
# fast enough for the fastest sine of 3.4 Hz: its peak is missed by less than a part in a thousand
_LOOKED_AT_HZ: Final = 100.0


def shipped_test(name: str, vessel: "Vessel", *, title: str) -> Campaign:
    """Return a shipped campaign in volts of a ship's own lever, its speeds in the same share of the working speed.

    ``name``: one of `load_campaign`. ``title``: name of the campaign. Raises RequestError if the vessel file does not
    say which speed the lever asks for, or its lever does not reach as far.
    """
    sensor, working_rpm = vessel.sensors.set_point, vessel.working_point.engine_speed_rpm
    line = line_of_sensor(vessel)
    if line is None:
        raise RequestError(
            f"{vessel.name}: expected table_rpm of sensors.set_point, which speeds the lever asks for, found none; "
            "state two readings with their speeds, or --lever of `shaftprint new vessel`."
        )
    made = load_campaign(name)
    larger = working_rpm / _MADE_AT_RPM
    volts_for_volt = larger * _MADE_FOR_RPM_PER_V / line.slope_rpm_per_v

    def volts(of_tug: float) -> float:
        return round(line.offset_v + volts_for_volt * (of_tug - _MADE_AT_V), _DIGITS)

    def size(of_tug: float) -> float:
        return round(abs(volts_for_volt) * of_tug, _DIGITS)

    changed: dict[str, Any] = {"name": title, "offset_v": volts(made.offset_v)}
    changed["slope_rpm_per_v"] = round(line.slope_rpm_per_v, _DIGITS)
    at_offset_rpm = _MADE_AT_RPM + _MADE_FOR_RPM_PER_V * (made.offset_v - _MADE_AT_V)
    changed["offset_rpm"] = round(larger * at_offset_rpm, _DIGITS)
    if made.ramp_v_per_s is not None:
        changed["ramp_v_per_s"] = size(made.ramp_v_per_s)
    changed["sines"] = tuple(_with(one, amplitude_v=size(one.amplitude_v)) for one in made.sines)
    changed["multisines"] = tuple(
        _with(one, level_v=volts(one.level_v), amplitudes_v=tuple(map(size, one.amplitudes_v)))
        for one in made.multisines
    )
    changed["staircases"] = tuple(_with(one, levels_v=tuple(map(volts, one.levels_v))) for one in made.staircases)
    campaign = _with(made, **changed)
    asked_v = setpoint(campaign, np.arange(0.0, campaign.duration_s, 1.0 / _LOOKED_AT_HZ))
    lowest, highest = sorted(sensor.reading([asked_v.min(), asked_v.max()]).tolist())
    shown = [reading for reading, _ in sensor.table_rpm or ()]
    if shown and not shown[0] <= lowest < highest <= shown[-1]:
        raise RequestError(
            f"{vessel.name}: expected a lever that reaches from {lowest:.5g} to {highest:.5g} {sensor.unit}, as far as "
            f"the test {name} goes about {working_rpm:g} rpm, found table_rpm from {shown[0]:g} to {shown[-1]:g} "
            f"{sensor.unit}; choose another engine_speed_rpm of the working point, or let `shaftprint plan` make a "
            "test within its limits."
        )
    return campaign


def _with(noun: _Noun, **changed: Any) -> _Noun:
    """Return a noun with other values, checked as those of a file are."""
    return type(noun).model_validate(noun.model_dump(exclude_none=True) | changed)
