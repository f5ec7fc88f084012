"""The noun ``LimitUse`` and its verb: how near a test comes to each limit, and whether it leaves it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.design.inputs._gauge_range import FULL_SCALE, GaugeRange
from shaftprint.design.inputs._limits import NO_MOTORING, Curve, Limits, limits_from_vessel
from shaftprint.design.operation._operation import Operation
from shaftprint.digits import plain, plain_letters
from shaftprint.notebook._shown import Shown
from shaftprint.reasons import Reason
from shaftprint.signals._load_reasons import ratio_that_fits, std_of_load
from shaftprint.signals.levels._speed_scale import load_over_expected

if TYPE_CHECKING:
    from shaftprint.signals._working_points import WorkingPoint
    from shaftprint.vessel._vessel import Vessel

# A barred range may be crossed, but not for longer [s].
CROSSING_S = 2.0
_OF_SPEED = ("highest speed", "lowest speed")
# What the engine gives; a gauge at full scale shows less than there is.
_OF_ENGINE = ("full load", "full rack", "motoring torque", "zero fuel")
# An engine at a limit for more than this share of an excitation bends its lines by more than their noise: 3 % of five
# minutes moved a gain by one standard deviation. Where a fit has failed a quarter of it is the first thing to look at.
_BENDS, _MAY_BEND = 0.04, 0.01
# A load this many standard deviations below that of the vessel file, with an engine beyond its full load, is that of
# another ratio; with the one that fits the engine stays below this multiple of its full load.
_OFF, _HIGHEST = 2.0, 1.1
# A torque is at its limit where less than this share of it is left.
REACHED = 0.02


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class LimitUse(Shown):
    """The instant of one excitation that comes nearest to a limit, or leaves it furthest."""

    limit: str
    """Name of the limit, such as ``full load``."""
    excitation: str
    """Name of the excitation that runs then."""
    time_s: float
    """When [s], since the start of the test."""
    value: float
    """What is reached, in ``unit``."""
    allowed: float
    """What the limit allows then, in ``unit``."""
    left: float
    """How much is left between both, negative beyond the limit, in ``unit``."""
    unit: str
    """Unit of all three."""
    beyond_s: float
    """How long this excitation is beyond the limit, in all [s]."""
    of_s: float
    """How long this excitation runs [s]."""

    @property
    def is_beyond(self) -> bool:
        """Whether the limit is left."""
        return self.beyond_s > 0.0

    @property
    def is_torque(self) -> bool:
        """Whether it limits what the engine gives: beyond it the engine does not follow its governor."""
        return self.limit in _OF_ENGINE

    @property
    def is_speed(self) -> bool:
        """Whether it is the highest or the lowest speed."""
        return self.limit in _OF_SPEED

    @property
    def is_reached(self) -> bool:
        """Whether the limit is left, or so near that whatever keeps it may act: a limiter lets nothing pass."""
        return self.is_beyond or self.left < REACHED * abs(self.allowed)

    @property
    def sentence(self) -> str:
        """Which excitation leaves which limit, when, and how far."""
        return plain_letters(
            f"{self.excitation} leaves the limit {self.limit} at {self.time_s:.1f} s: {plain(self.value, 0)} "
            f"{self.unit}, allowed {plain(self.allowed, 0)} {self.unit}; {self.beyond_s:.1f} s in all."
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Rule:
    """One limit over the time of a test."""

    name: str
    unit: str
    value: FloatArray
    """What is reached, shape (samples,)."""
    allowed: FloatArray
    """What is allowed, shape (samples,)."""
    left: FloatArray
    """How much is left, negative beyond, shape (samples,)."""


def stated_limits(vessel: "Vessel") -> Limits:
    """Return what a vessel file allows, without a limit of the set point."""
    return limits_from_vessel(vessel, set_point_rpm=math.inf)


def limit_uses(operation: Operation, limits: Limits) -> tuple[LimitUse, ...]:
    """Return how near each excitation comes to each limit, the nearest or furthest beyond first for each limit.

    What the vessel file does not state is not held against anything: no motoring torque, no rate.

    Parameters
    ----------
    operation
        What engine and shaft do.
    limits
        What they may do.
    """
    uses = []
    for rule in _rules(operation, limits):
        of_rule = [
            (_nearest(rule, name, running, operation.time_s), float(rule.left[running].min()))
            for name, running in operation.stretches.items()
        ]
        uses += [use for use, _ in sorted(of_rule, key=lambda pair: pair[1])]
    return tuple(uses)


def limit_reasons(uses: Sequence[LimitUse], excitations: Sequence[str], *, failed: bool = False) -> tuple[Reason, ...]:
    """Return that the engine was at a limit so long in some excitations that no linear line explains them.

    ``uses``: from `limit_uses`, of a recording. ``excitations``: names of those that are used. ``failed``: whether no
    line explained them.
    """
    where = _where(uses, excitations, _MAY_BEND if failed else _BENDS)
    sentence = (
        f"By the vessel file the engine was at a limit: {where}. There it does not follow its governor. Repeat the "
        "test with smaller amplitudes or at a lower speed, or correct limits and upstream inertia in the vessel file "
        "if the engine may give that."
    )
    return (Reason(kind="engine limit", sentence=sentence),) if where else ()


def limit_cautions(uses: Sequence[LimitUse], excitations: Sequence[str]) -> tuple[str, ...]:
    """Return that a test that a linear line explains went, by the vessel file, where none does; as `limit_reasons`."""
    where = _where(uses, excitations, _BENDS)
    sentence = (
        f"By the vessel file the engine was at a limit: {where}. The model explains the data all the same: correct "
        "limits, upstream inertia, gear ratio or the scale of the torque there if the engine cannot give that."
    )
    return (sentence,) if where else ()


def ratio_reasons(
    uses: Sequence[LimitUse], excitations: Sequence[str], point: "WorkingPoint", vessel: "Vessel"
) -> tuple[Reason, ...]:
    """Return that the gear ratio is too small, where both sides of it say so and no sensor shows it.

    With a ratio that is too small the engine gives more than its full load, and the propeller takes less than it
    should; a gauge or another propeller does one of both.

    ``uses``: from `limit_uses`, of a recording. ``excitations``: names of those that are used. ``point``: mean speed
    and torque. ``vessel``: says which torque belongs to which speed.
    """
    load = load_over_expected(point, vessel)
    if not load > 0.0 or math.log(load) > -_OFF * std_of_load(point, vessel):
        return ()
    beyond = [use for use in uses if use.limit == "full load" and use.value * load**0.5 < _HIGHEST * use.allowed]
    where, ratio = _where(beyond, excitations, _BENDS), ratio_that_fits(load, vessel)
    if not where or not ratio or vessel.is_underway:
        return ()
    return (
        Reason(
            kind="gear ratio",
            where="gearbox.ratio",
            sentence=(
                f"The gear ratio is in doubt: over the square of the speed the propeller takes {load:.2f} times the "
                f"torque of working_point, and the engine would all the same be at a limit: {where}; check {ratio}, or "
                "propeller, scale of the torque and full-load curve of the vessel file."
            ),
        ),
    )


def limit_warnings(uses: Sequence[LimitUse], excitations: Sequence[str]) -> tuple[str, ...]:
    """Return that the engine will be at a limit in some excitations; ``uses`` are of a test before it is made."""
    where = _where(uses, excitations, _BENDS)
    sentence = (
        f"The engine would be at a limit: {where}. There it does not follow its governor, and what is predicted does "
        "not hold. Choose smaller amplitudes or a lower speed."
    )
    return (sentence,) if where else ()


def _where(uses: Sequence[LimitUse], excitations: Sequence[str], longest: float) -> str:
    used = [use for use in uses if use.excitation in excitations and use.is_torque]
    return plain_letters(
        "; ".join(
            f"{use.excitation} beyond {use.limit} for {use.beyond_s:.0f} s of {use.of_s:.0f} s, with "
            f"{plain(use.value, 0)} of {plain(use.allowed, 0)} {use.unit} at {use.time_s:.1f} s"
            for use in used
            if use.beyond_s > longest * use.of_s
        )
    )


def _nearest(rule: _Rule, excitation: str, running: BoolArray, time_s: FloatArray) -> LimitUse:
    places, step_s = np.flatnonzero(running), float(time_s[1] - time_s[0])
    place = places[np.argmin(rule.left[places])]
    beyond_s = float(np.count_nonzero(rule.left[places] < 0.0)) * step_s
    if rule.name.startswith("barred") and beyond_s <= CROSSING_S:
        beyond_s = 0.0
    return LimitUse(
        limit=rule.name,
        excitation=excitation,
        time_s=float(time_s[place]),
        value=float(rule.value[place]),
        allowed=float(rule.allowed[place]),
        left=float(rule.left[place]),
        unit=rule.unit,
        beyond_s=beyond_s,
        of_s=places.size * step_s,
    )


def _rules(operation: Operation, limits: Limits) -> Iterator[_Rule]:
    speed = operation.speed_rpm
    yield _below("highest speed", "rpm", speed, limits.highest_speed_rpm)
    yield _above("lowest speed", "rpm", speed, limits.lowest_speed_rpm)
    if limits.demand_rate_limit_rpm_per_s is not None:
        rate = np.abs(operation.rate_rpm_per_s)
        yield _below("rate of the set point", "rpm/s", rate, limits.demand_rate_limit_rpm_per_s)
    demand = operation.torque_demand_nm
    full_load = _torque(limits.full_load, speed)
    yield _below("full load", "N m", operation.brake_torque_nm, full_load)
    if demand is not None:
        yield _below("full rack", "N m", demand, full_load)
    if limits.motoring != NO_MOTORING:
        motoring = -_torque(limits.motoring, speed)
        yield _above("motoring torque", "N m", operation.brake_torque_nm, motoring)
        if demand is not None:
            yield _above("zero fuel", "N m", demand, motoring)
    if limits.gauge is not None and operation.shaft_torque_nm is not None:
        load_nm = limits.gauge.shaft_torque_nm(limits.brake_torque_nm, speed / limits.engine_speed_rpm)
        yield _within_range(limits.gauge, operation.shaft_torque_nm, load_nm)
    for low, high in limits.barred_rpm:
        end = np.where(speed < 0.5 * (low + high), low, high)
        yield _Rule(
            name=f"barred {low:g} to {high:g} rpm",
            unit="rpm",
            value=speed,
            allowed=end,
            left=np.abs(speed - 0.5 * (low + high)) - 0.5 * (high - low),
        )


def _below(name: str, unit: str, value: FloatArray, highest: FloatArray | float) -> _Rule:
    allowed = np.broadcast_to(highest, value.shape)
    return _Rule(name=name, unit=unit, value=value, allowed=allowed, left=allowed - value)


def _above(name: str, unit: str, value: FloatArray, lowest: FloatArray | float) -> _Rule:
    allowed = np.broadcast_to(lowest, value.shape)
    return _Rule(name=name, unit=unit, value=value, allowed=allowed, left=value - allowed)


def _within_range(gauge: GaugeRange, torque_nm: FloatArray, load_nm: FloatArray) -> _Rule:
    """Return what the gauge shows as a rule: orders and noise go with the shaft torque of the load."""
    ripple_nm = gauge.ripple * load_nm
    below = _below(FULL_SCALE, "N m", torque_nm, gauge.highest_nm - ripple_nm)
    above = _above(FULL_SCALE, "N m", torque_nm, gauge.lowest_nm + ripple_nm)
    return below if below.left.min() <= above.left.min() else above


def _torque(curve: Curve, speed_rpm: FloatArray) -> FloatArray:
    speeds, torques = zip(*curve, strict=True)
    return np.asarray(np.interp(speed_rpm, speeds, torques))
