"""Whether what comes back with the turns of the shafts stands in the torque where the pick-up lets expect it.

Unbalance, blades and firing come back with the angle of their shaft, whatever lever and propeller do. A wheel of 23
teeth that is taken for one of 24 shows all of them at 24/23 of the order that they have, which is far more than a
minute of torque leaves open; a gear ratio that is wrong moves those of the other shaft alone. A lever with its droop
and a propeller series know the speed ten times worse.

Whole multiples of the turns of a shaft, and of the working cycle of an engine, belong where they are, whether the
vessel file knows of them or not. Another factor has to explain two lines that are none of these, and most of all lines.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.reasons import OTHER_SHIP, Reason
from shaftprint.signals._scale_reasons import what_to_check
from shaftprint.signals.levels._order_lines import OrderLines, order_lines
from shaftprint.vessel._orders import orders_of

if TYPE_CHECKING:
    from shaftprint.arrays import BoolArray, FloatArray
    from shaftprint.signals._channel_signals import SpeedSignal
    from shaftprint.signals._gaps import Coverage
    from shaftprint.vessel._orders import Order
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._vessel import Vessel

# A factor of the speed farther from 1 shows in mean speed and torque, and one of the gears need not; the logarithm.
_FARTHEST, _FARTHEST_OF_GEARS = 0.2, 0.5
# How exact turns that are counted are, a gear ratio of three digits, and an instrument that counts nothing.
_OF_COUNT, _OF_RATIO, _OF_INSTRUMENT = 5e-4, 3e-3, 0.015
_FEWEST, _SHARE = 2, 0.6
# Blades of propellers that are built, and the orders that are looked for of each.
_BLADES, _ALL_OF_PROPELLER = (3, 4, 5, 6, 7), 3
# A tooth more or less is told where the factor is as exact as this share of it.
_OF_TOOTH = 0.25


@dataclass(frozen=True, kw_only=True, slots=True)
class _Explained:
    """Orders that stand at one factor of where they are expected."""

    factor: float
    """Where they stand over where they are expected."""
    orders: "tuple[Order, ...]"
    """Which."""
    lines: tuple[int, ...]
    """Places of their lines."""
    size: float
    """Sum of the sizes of their lines."""
    error: float
    """How far the factor may be off."""
    blades: int = 0
    """Number of blades that the propeller then has; 0 where it is as stated."""


def reasons_of_orders(
    speed: "SpeedSignal",
    torque_nm: "FloatArray",
    vessel: "Vessel",
    *,
    rate_hz: float,
    start_s: float,
    coverage: "Coverage",
) -> tuple[Reason, ...]:
    """Return a reason where the orders of the torque contradict the scale of the speed, or the gear ratio.

    ``speed``: the one that is identified. ``torque_nm``: on the same grid. ``vessel``: says which orders there are,
    which shaft the pick-up is on, and how it counts. ``rate_hz``, ``start_s``: the grid. ``coverage``: what the
    recording covers. Nothing is said where no order stands out of the noise.
    """
    lines = order_lines(speed.values, torque_nm, rate_hz=rate_hz, start_s=start_s, coverage=coverage)
    if lines is None:
        return ()
    sensor = next(one for one in vessel.sensors.speed if one.name == speed.name)
    exact = _OF_COUNT if sensor.counts_turns else _OF_INSTRUMENT
    orders = [order for order in vessel.orders if order.per_engine_turn < lines.highest]
    # without gears there is one shaft
    own = [order for order in orders if order.shaft == sensor.shaft or vessel.gearbox.ratio == 1.0]
    other = [order for order in orders if order not in own]
    of_own, of_other = _multiples(lines, own, exact), _multiples(lines, other, exact + _OF_RATIO)
    of_speed = _best(lines, orders, exact=exact + _OF_RATIO, belonging=of_own | of_other)
    if of_speed is not None and (not {*of_speed.orders} & {*own} or _is_no_wheel(of_speed, sensor)):
        of_speed = None
    apart = _of(lines, ~of_own)
    as_stated = bool(_explained(apart, other, 1.0, exact=exact + _OF_RATIO).lines)
    of_gears = None if as_stated else _best_of_gears(apart, other, vessel, exact=exact, belonging=of_other[~of_own])
    if of_speed is not None and of_gears is not None:
        # one of them stands where an order of the other cause would: what explains more lines is the cause
        own_lines = _explained(lines, own, 1.0, exact=exact).lines
        of_speed = of_speed if len(of_speed.lines) > len(of_gears.lines) + len(own_lines) else None
    if of_speed is not None:
        return (_of_speed(of_speed, speed, vessel),)
    return () if of_gears is None else (_of_gears(of_gears, sensor, speed, vessel, is_own=bool(of_own.any())),)


def _best_of_gears(
    lines: OrderLines, orders: "Sequence[Order]", vessel: "Vessel", *, exact: float, belonging: "BoolArray"
) -> _Explained | None:
    """Return the factor of the gears that explains most lines, with another number of blades where that explains more.

    Of a propeller that neither ratio nor blades of the file describe its own order, that of the blades and their double
    have to stand there, all three.
    """
    stated = _best(lines, orders, exact=exact, belonging=belonging, farthest=_FARTHEST_OF_GEARS)
    every = [] if stated is None else [stated]
    if not any(order.shaft == "propeller" for order in orders):
        return stated
    for blades in _BLADES:
        propeller = vessel.propeller.model_copy(update={"blades": blades})
        of_all = orders_of(vessel.machine, vessel.gearbox, propeller)
        others = [one for one in of_all if one.shaft == "propeller" and one.per_engine_turn < lines.highest]
        found = _best(lines, others, exact=exact, belonging=belonging, farthest=_FARTHEST_OF_GEARS)
        if found is not None and len(found.orders) == _ALL_OF_PROPELLER:
            every.append(replace(found, blades=blades))
    # the first of those that explain as much
    return max(every, key=lambda one: len(one.lines), default=None)


def _multiples(lines: OrderLines, orders: "Sequence[Order]", exact: float) -> "BoolArray":
    """Return which lines stand at a multiple of the lowest of some orders, shape (lines,)."""
    if not orders:
        return np.zeros(lines.order.size, dtype=np.bool_)
    base = min(order.per_engine_turn for order in orders)
    multiple = np.maximum(np.round(lines.order / base), 1.0)
    return np.asarray(np.abs(lines.order - multiple * base) < lines.resolution + exact * lines.order)


def _of(lines: OrderLines, chosen: "BoolArray") -> OrderLines:
    return replace(lines, order=lines.order[chosen], size=lines.size[chosen])


def _explained(lines: OrderLines, orders: "Sequence[Order]", factor: float, *, exact: float) -> _Explained:
    """Return which orders stand at a factor of where they are expected."""
    at: dict[int, Order] = {}
    for order in orders:
        expected = factor * order.per_engine_turn
        nearest = int(np.argmin(np.abs(lines.order - expected))) if lines.order.size else 0
        if lines.order.size and abs(lines.order[nearest] - expected) < lines.resolution + exact * expected:
            at[nearest] = order
    highest = max((order.per_engine_turn for order in at.values()), default=1.0)
    return _Explained(
        factor=factor,
        orders=tuple(at.values()),
        lines=tuple(at),
        size=float(lines.size[list(at)].sum()),
        error=lines.resolution / highest,
    )


def _best(
    lines: OrderLines,
    orders: "Sequence[Order]",
    *,
    exact: float,
    belonging: "BoolArray",
    farthest: float = _FARTHEST,
) -> _Explained | None:
    """Return the factor that explains most of the lines by orders; None where none explains enough.

    ``belonging``: which lines stand where something belongs already, shape (lines,). ``farthest``: the largest
    logarithm of a factor.
    """
    pairs = ((line, order.per_engine_turn) for order in orders for line in lines.order.tolist())
    factors = [line / turns for line, turns in pairs if abs(math.log(line / turns)) < farthest]
    found = (_explained(lines, orders, factor, exact=exact) for factor in factors)
    apart = [one for one in found if abs(one.factor - 1.0) > one.error + exact]
    best = max(apart, key=lambda one: (len(one.lines), one.size), default=None)
    if best is None:
        return None
    lowest = min(order.per_engine_turn for order in orders) * math.exp(-farthest)
    total = float(lines.size[lines.order > lowest].sum())
    if best.size < _SHARE * total or np.count_nonzero(~belonging[list(best.lines)]) < _FEWEST:
        return None
    # the highest order tells the factor best
    finest = max(range(len(best.lines)), key=lambda place: best.orders[place].per_engine_turn)
    return replace(best, factor=float(lines.order[best.lines[finest]]) / best.orders[finest].per_engine_turn)


def _is_no_wheel(found: _Explained, sensor: "SpeedSensor") -> bool:
    """Return whether no number of teeth makes such a factor."""
    if sensor.gives_pulses:
        teeth = sensor.pulses_per_revolution / found.factor
        wrong = abs(teeth - round(teeth)) > max(_OF_TOOTH, teeth * found.error)
        return wrong or round(teeth) == sensor.pulses_per_revolution
    return False


def _where(found: _Explained, speed: "SpeedSignal") -> str:
    """Return where orders stand, and where the speed lets expect them, in words."""
    mean = float(speed.values.mean())
    told = max(found.orders, key=lambda one: one.per_engine_turn)
    names = ", ".join(order.name for order in found.orders)
    expected_hz = told.per_engine_turn * mean
    return (
        f"{names} stand in the torque at {found.factor:.4f} times the frequencies at which {speed.channel} lets expect "
        f"them ({told.name} at {found.factor * expected_hz:.4g} Hz for {expected_hz:.4g} Hz at mean speed)"
    )


def _of_speed(found: _Explained, speed: "SpeedSignal", vessel: "Vessel") -> Reason:
    shown = 1.0 / found.factor
    return Reason(
        kind="speed scale",
        where=speed.channel,
        sentence=(
            f"The speed is in doubt: {_where(found, speed)}, so that it seems to be {shown:.4g} times the true one; "
            f"{what_to_check(shown, vessel)}."
        ),
    )


def _of_gears(
    found: _Explained,
    sensor: "SpeedSensor",
    speed: "SpeedSignal",
    vessel: "Vessel",
    *,
    is_own: bool,
) -> Reason:
    ratio, is_behind = vessel.gearbox.ratio, sensor.shaft == "propeller"
    fitting = ratio * found.factor if is_behind else ratio / found.factor
    beside = f", and those of the {sensor.shaft}'s own shaft where they belong" if is_own else ""
    with_blades = f", with {found.blades} blades; check {OTHER_SHIP}" if found.blades else ""
    instead = "" if is_own else f", or {what_to_check(1.0 / found.factor, vessel)}"
    return Reason(
        # an engine speed that comes through the gears is off itself
        kind="gear ratio" if is_own and not is_behind else "speed scale",
        where=speed.channel,
        sentence=(
            f"The gear ratio is in doubt: {_where(found, speed)}{beside}; check gearbox.ratio: {ratio:g} is stated, "
            f"{fitting:.4g} would fit{instead}{with_blades}."
        ),
    )
