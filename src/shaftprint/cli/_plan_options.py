"""Options of ``plan`` as they are typed: wishes, limits, lengths and speeds, such as ``t_d=10%`` and ``12min``."""

from __future__ import annotations

from collections.abc import Sequence

import click

from shaftprint.cli._typed_numbers import number_and_unit
from shaftprint.late import late
from shaftprint.spelling import meant

with late():
    from shaftprint.design.inputs import _stated_limits
    from shaftprint.design.inputs._stated_limits import StatedLimit
    from shaftprint.design.inputs._wish import Wish


_SECONDS = {"s": 1.0, "sec": 1.0, "min": 60.0, "h": 3600.0}
_PERCENT = 100.0


def wish_of(text: str) -> tuple[str, float, bool]:
    """Return name, standard deviation and whether it is over the value, of ``t_d=10%`` or ``g=0.05``.

    Raises click.BadParameter if the text is not of that form.
    """
    name, _, stated = text.rpartition("=")
    number, unit = number_and_unit(stated)
    if not name.strip() or number is None or not number > 0.0 or unit not in ("", "%"):
        raise click.BadParameter(
            f"expected a number of the line and how well it is to be known, such as t_d=10% or, in its own unit, "
            f"g=0.05, found {text!r}."
        )
    return name.strip(), number / _PERCENT if unit == "%" else number, unit == "%"


def wish_from(wishes: Sequence[tuple[str, float, bool]]) -> Wish:
    """Return the wishes of a command line.

    Raises click.UsageError if a number is wished for twice.
    """
    names = [name for name, _, _ in wishes]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise click.UsageError(f"--wish {twice[0]}: expected each number once, found it {names.count(twice[0])} times.")
    relative = {name: std for name, std, is_share in wishes if is_share}
    return Wish(relative=relative, absolute={name: std for name, std, is_share in wishes if not is_share})


def limit_of(text: str) -> StatedLimit:
    """Return a limit of ``rate=600rpm/s``.

    Raises click.BadParameter if there is no such limit, or its number or unit is another.
    """
    name, _, stated = text.partition("=")
    kind = _stated_limits.LIMITS.get(name.strip())
    if kind is None:
        advice = meant(name.strip(), _stated_limits.LIMITS)
        raise click.BadParameter(f"expected one of {', '.join(_stated_limits.LIMITS)}, found {name.strip()!r}.{advice}")
    number, unit = number_and_unit(stated)
    if number is None or not number > 0.0 or unit not in kind.units:
        units = " or ".join(one or "no unit" for one in kind.units)
        if number is not None and number > 0.0 and not unit:
            raise click.BadParameter(f"expected a unit behind {number:g}, {units}, such as {kind.example}, found none.")
        raise click.BadParameter(f"expected a positive number in {units} such as {kind.example}, found {text!r}.")
    return StatedLimit(name=name.strip(), value=number * kind.units[unit], unit=unit)


def seconds_of(text: str) -> float:
    """Return a length of time [s] of ``12min``, ``90s`` or ``1.5h``.

    Raises click.BadParameter if the text is not of that form.
    """
    number, unit = number_and_unit(text)
    if number is None or not number > 0.0 or unit not in _SECONDS:
        raise click.BadParameter(f"expected a length of time such as 12min, 90s or 1h, found {text!r}.")
    return number * _SECONDS[unit]


def shares_of(text: str) -> tuple[float, ...]:
    """Return speeds over that of the working point of ``0.78,1.15``.

    Raises click.BadParameter if the text is not of that form.
    """
    numbers = [number_and_unit(one) for one in text.split(",")]
    if any(number is None or not number > 0.0 or unit for number, unit in numbers):
        raise click.BadParameter(f"expected speeds over that of the working point, such as 0.78,1.15, found {text!r}.")
    return tuple(number for number, _ in numbers if number is not None)
