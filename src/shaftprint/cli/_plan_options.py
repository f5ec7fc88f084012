"""Options of ``plan`` as they are typed: wishes, limits, lengths and speeds, such as ``t_d=10%`` and ``12min``."""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import click

from shaftprint.design.inputs._gauge_range import GaugeRange
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._wish import Wish
from shaftprint.spelling import meant
from shaftprint.units import SECONDS_PER_MINUTE

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*([^\d\s].*?)?\s*$")
_SECONDS = {"s": 1.0, "sec": 1.0, "min": SECONDS_PER_MINUTE, "h": 60.0 * SECONDS_PER_MINUTE}
_PERCENT = 100.0


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
    "set-point": LimitKind(field="", units={"V": 1.0, "rpm": 1.0}, example="set-point=1.0V"),
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


def wish_of(text: str) -> tuple[str, float, bool]:
    """Return name, standard deviation and whether it is over the value, of ``t_d=10%`` or ``g=0.05``.

    Raises
    ------
    click.BadParameter
        If the text is not of that form.
    """
    name, _, stated = text.rpartition("=")
    number, unit = _number(stated)
    if not name.strip() or number is None or not number > 0.0 or unit not in ("", "%"):
        raise click.BadParameter(
            f"expected a number of the line and how well it is to be known, such as t_d=10% or, in its own unit, "
            f"g=0.05, found {text!r}."
        )
    return name.strip(), number / _PERCENT if unit == "%" else number, unit == "%"


def wish_from(wishes: Sequence[tuple[str, float, bool]]) -> Wish:
    """Return the wishes of a command line.

    Raises
    ------
    click.UsageError
        If a number is wished for twice.
    """
    names = [name for name, _, _ in wishes]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise click.UsageError(f"--wish {twice[0]}: expected each number once, found it {names.count(twice[0])} times.")
    relative = {name: std for name, std, is_share in wishes if is_share}
    return Wish(relative=relative, absolute={name: std for name, std, is_share in wishes if not is_share})


def limit_of(text: str) -> StatedLimit:
    """Return a limit of ``rate=600rpm/s``.

    Raises
    ------
    click.BadParameter
        If there is no such limit, or its number or unit is another.
    """
    name, _, stated = text.partition("=")
    kind = LIMITS.get(name.strip())
    if kind is None:
        advice = meant(name.strip(), LIMITS)
        raise click.BadParameter(f"expected one of {', '.join(LIMITS)}, found {name.strip()!r}.{advice}")
    number, unit = _number(stated)
    if number is None or not number > 0.0 or unit not in kind.units:
        units = " or ".join(one or "no unit" for one in kind.units)
        raise click.BadParameter(f"expected a positive number in {units} such as {kind.example}, found {text!r}.")
    return StatedLimit(name=name.strip(), value=number * kind.units[unit], unit=unit)


def set_point_rpm_of(stated: Sequence[StatedLimit], slope_rpm_per_v: float) -> float | None:
    """Return the largest deviation of the set point [rpm]; None where it is not stated."""
    for limit in stated:
        if limit.name == "set-point":
            return limit.value * abs(slope_rpm_per_v) if limit.unit == "V" else limit.value
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


def seconds_of(text: str) -> float:
    """Return a length of time [s] of ``12min``, ``90s`` or ``1.5h``.

    Raises
    ------
    click.BadParameter
        If the text is not of that form.
    """
    number, unit = _number(text)
    if number is None or not number > 0.0 or unit not in _SECONDS:
        raise click.BadParameter(f"expected a length of time such as 12min, 90s or 1h, found {text!r}.")
    return number * _SECONDS[unit]


def shares_of(text: str) -> tuple[float, ...]:
    """Return speeds over that of the working point of ``0.78,1.15``.

    Raises
    ------
    click.BadParameter
        If the text is not of that form.
    """
    numbers = [_number(one) for one in text.split(",")]
    if any(number is None or not number > 0.0 or unit for number, unit in numbers):
        raise click.BadParameter(f"expected speeds over that of the working point, such as 0.78,1.15, found {text!r}.")
    return tuple(number for number, _ in numbers if number is not None)


def _number(text: str) -> tuple[float | None, str]:
    """Return the finite number at the beginning of a text and the unit behind it; None where there is none."""
    match = _NUMBER.match(text)
    if match is None:
        return None, ""
    number = float(match[1])
    return (number if math.isfinite(number) else None), match[2] or ""
