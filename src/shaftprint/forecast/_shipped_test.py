"""A shipped test for another ship: the same share of the working speed, by that ship's own lever."""

from typing import TYPE_CHECKING, Any, Final, TypeVar

import numpy as np

from shaftprint.campaign._campaign import Campaign, load_campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.design.inputs._set_point_line import line_of_sensor
from shaftprint.design.operation._limit_use import LimitUse, limit_uses, stated_limits
from shaftprint.digits import plain, plain_letters
from shaftprint.errors import RequestError
from shaftprint.forecast._predict import expected_motion
from shaftprint.forecast._ship_before_test import ShipBeforeTest
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


# Of what a torque limit allows so much is kept free: governor and inertia are not known before a test. Smaller than
# this share of the tug's, amplitudes tell too little.
_SPARE: Final = 0.1
_LEAST_SHARE: Final = 0.3
_TRIED: Final = 8


def shipped_test(name: str, vessel: "Vessel", *, title: str) -> tuple[Campaign, str]:
    """Return a shipped campaign in volts of a ship's own lever, its speeds in the same share of the working speed.

    Amplitudes are in that share too, or smaller where engine or ship would come to a limit; which, is returned beside
    it, and nothing where they are not.

    ``name``: one of `load_campaign`. ``title``: name of the campaign. Raises RequestError if the vessel file does not
    say which speed the lever asks for, its lever does not reach as far, or its limits leave too little.
    """
    hindered: LimitUse | None = None
    for share in np.linspace(1.0, _LEAST_SHARE, _TRIED).tolist():
        campaign = _of_share(name, vessel, title=title, share=share)
        reached = _reached(campaign, vessel)
        if reached is None:
            return campaign, "" if hindered is None else (
                f"Amplitudes are {100.0 * share:.0f} % of the usual ones: with those {hindered.excitation} would come "
                f"to {_of_limit(hindered)}."
            )
        hindered = hindered or reached
    assert reached is not None  # noqa: S101 - the last share was hindered
    raise RequestError(
        f"{vessel.name}: expected limits within which the test {name} moves the ship about "
        f"{vessel.working_point.engine_speed_rpm:g} rpm, found that {reached.excitation} comes to {_of_limit(reached)} "
        f"with {100.0 * _LEAST_SHARE:.0f} % of its amplitudes; choose a lower engine_speed_rpm of the working point, "
        "correct the limits, or let `shaftprint plan` make a test within them."
    )


def _reached(campaign: Campaign, vessel: "Vessel") -> LimitUse | None:
    """Return the limit of speed that an excitation leaves, or of torque that it comes near to; None where none."""
    motion = expected_motion(campaign, ShipBeforeTest(vessel=vessel), campaign.slope_rpm_per_v or 1.0)
    uses = [use for use in limit_uses(motion, stated_limits(vessel)) if use.excitation in campaign.measured]
    near = [use for use in uses if use.is_torque and use.left < _SPARE * abs(use.allowed)]
    near += [use for use in uses if use.is_speed and use.is_beyond]
    return min(near, key=lambda use: use.left / abs(use.allowed), default=None)


def _of_limit(use: LimitUse) -> str:
    reached, allowed = (plain_letters(plain(abs(value), 0)) for value in (use.value, use.allowed))
    return f"{reached} of {allowed} {use.unit} of the limit {use.limit}"


def _of_share(name: str, vessel: "Vessel", *, title: str, share: float) -> Campaign:
    """Return a shipped campaign for a lever, with a share of its amplitudes."""
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

    def swing(of_tug: float) -> float:
        return size(share * of_tug)

    changed: dict[str, Any] = {"name": title, "offset_v": volts(made.offset_v)}
    changed["slope_rpm_per_v"] = round(line.slope_rpm_per_v, _DIGITS)
    at_offset_rpm = _MADE_AT_RPM + _MADE_FOR_RPM_PER_V * (made.offset_v - _MADE_AT_V)
    changed["offset_rpm"] = round(larger * at_offset_rpm, _DIGITS)
    if made.ramp_v_per_s is not None:
        changed["ramp_v_per_s"] = size(made.ramp_v_per_s)
    changed["sines"] = tuple(_with(one, amplitude_v=swing(one.amplitude_v)) for one in made.sines)
    changed["multisines"] = tuple(
        _with(one, level_v=volts(one.level_v), amplitudes_v=tuple(map(swing, one.amplitudes_v)))
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
