"""Limits that a user states of ship and engine, in place of those of the vessel file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from shaftprint.design.inputs._gauge_range import GaugeRange
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.errors import RequestError


@dataclass(frozen=True, kw_only=True, slots=True)
class LimitKind:
    """One limit that may be stated."""

    field: str
    """Field of ``Limits`` that it sets; empty for those that are treated by themselves."""
    units: Mapping[str, float]
    """Units that it may have, with the factor to that of the field."""
    example: str
    """How it is typed."""


_RPM = {"rpm": 1.0}
LIMITS: Final[Mapping[str, LimitKind]] = {
    "set-point": LimitKind(
        field="", units={"V": 1.0, "rpm": 1.0, "mA": 1.0, "%": 1.0, "counts": 1.0}, example="set-point=1.0V"
    ),
    "rate": LimitKind(field="demand_rate_limit_rpm_per_s", units={"rpm/s": 1.0}, example="rate=600rpm/s"),
    "lowest-speed": LimitKind(field="lowest_speed_rpm", units=_RPM, example="lowest-speed=600rpm"),
    "highest-speed": LimitKind(field="highest_speed_rpm", units=_RPM, example="highest-speed=1700rpm"),
    "resolution": LimitKind(field="demand_resolution_rpm", units=_RPM, example="resolution=4.8rpm"),
    "cycle": LimitKind(field="demand_cycle_s", units={"s": 1.0, "ms": 1e-3}, example="cycle=50ms"),
    "frequency": LimitKind(field="highest_frequency_hz", units={"Hz": 1.0}, example="frequency=3Hz"),
    "time-over": LimitKind(field="share_over", units={"%": 0.01}, example="time-over=0.03%"),
    "noise-margin": LimitKind(field="noise_sigmas", units={"": 1.0}, example="noise-margin=4"),
    "torque": LimitKind(field="", units={"Nm": 1.0, "N m": 1.0, "kNm": 1e3}, example="torque=1100Nm"),
    "motoring": LimitKind(field="", units={"Nm": 1.0, "N m": 1.0, "kNm": 1e3}, example="motoring=250Nm"),
    "full-scale": LimitKind(field="", units={"Nm": 1.0, "N m": 1.0, "kNm": 1e3}, example="full-scale=10kNm"),
    "ripple": LimitKind(field="", units={"%": 0.01, "": 1.0}, example="ripple=60%"),
}
"""Limits by the name that is typed."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StatedLimit:
    """A limit as the user states it."""

    name: str
    """One of ``LIMITS``."""
    value: float
    """Its value in the unit of the first of its units, or in its own where that is kept."""
    unit: str
    """Unit that was typed."""


def set_point_rpm_of(stated: Sequence[StatedLimit], line: SetPointLine) -> float | None:
    """Return the largest deviation of the set point [rpm]; None where it is not stated.

    It may be stated in rpm, in volts of the campaign, or in the unit of the lever. Raises RequestError if the lever has
    another unit.
    """
    for limit in stated:
        if limit.name != "set-point":
            continue
        if limit.unit == "rpm":
            return limit.value
        if limit.unit == "V":
            return limit.value * abs(line.slope_rpm_per_v)
        if line.lever is None or line.lever.unit != limit.unit:
            units = dict.fromkeys(("V", "rpm", *(() if line.lever is None else (line.lever.unit,))))
            raise RequestError(
                f"expected --limit set-point in {' or '.join(units)}, as "
                f"sensors.set_point of the vessel file has it, found {limit.value:g} {limit.unit}."
            )
        return limit.value * abs(line.lever.v_per_unit * line.slope_rpm_per_v)
    return None


def limits_with(limits: Limits, stated: Sequence[StatedLimit]) -> Limits:
    """Return limits with what the user states instead of the vessel file."""
    changed: dict[str, Any] = {}
    ripple: float | None = None
    for limit in stated:
        field = LIMITS[limit.name].field
        if field:
            changed[field] = limit.value
        elif limit.name == "torque":
            changed["full_load"] = tuple((speed, min(torque, limit.value)) for speed, torque in limits.full_load)
        elif limit.name == "motoring":
            changed["motoring"] = ((limits.engine_speed_rpm, limit.value),)
        elif limit.name == "full-scale":
            changed["gauge"] = _with_full_scale(limits.gauge, limit.value)
        elif limit.name == "ripple":
            ripple = limit.value
    return replace(limits, **changed).with_ripple(ripple)


def _with_full_scale(gauge: GaugeRange | None, full_nm: float) -> GaugeRange | None:
    """Return the range of the gauge with another full scale about its zero."""
    if gauge is None:
        return None
    zero_nm = 0.5 * (gauge.lowest_nm + gauge.highest_nm)
    return replace(gauge, lowest_nm=zero_nm - full_nm, highest_nm=zero_nm + full_nm)
