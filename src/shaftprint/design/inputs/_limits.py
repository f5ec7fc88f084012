"""The noun ``Limits``: what ship and engine allow during a test, in the units of the ship."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Self, TypeAlias

import numpy as np

from shaftprint.design.inputs._gauge_range import GaugeRange, gauge_range_of
from shaftprint.errors import DesignError
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

Curve: TypeAlias = tuple[tuple[float, float], ...]
"""Torque over speed: points of engine speed [rpm] and brake torque [N m], speeds ascending."""

NO_MOTORING: Curve = ((0.0, 0.0),)
# Share of the time for which the noise may take the torque of a leg beyond a limit: less than that for which one
# may act in the windows of a test.
SHARE_OVER = 3e-4
SPEED_SIGMAS = 4.0
"""Standard deviations of the noise that stay free below a limit of the speed: one sample in 30,000 passes them."""
# Above this frequency a test leaves out lines unless asked: shaft orders are there when the speed swings.
HIGHEST_FREQUENCY_HZ = 3.4
# Speeds of the legs over the working point where nobody says otherwise, and how many times the largest deviation of the
# set point they keep away from the limits of the speed: a leg reaches farther than its set point does.
USUAL_SHARES = (1.15, 0.78)
_CLEAR = 1.3
# What a leg wants above its mean torque, over that torque: noise of four standard deviations takes half of what is kept
# below full load; what the gauge shows must hold the lines beside orders and noise.
_TORQUE_ROOM, _GAUGE_ROOM = 0.5, 0.15
_SHARE_STEP = 0.01
# Lines end where the demand has four messages a period.
MESSAGES_PER_PERIOD = 4.0


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Limits(Shown):
    """What must not be passed while a test runs."""

    engine_speed_rpm: float
    """Engine speed of the first working point [rpm]; speeds of legs are shares of it."""
    brake_torque_nm: float
    """Brake torque there [N m]."""
    set_point_rpm: float
    """Largest deviation of the set point from the level of its leg [rpm]."""
    lowest_speed_rpm: float
    """Lowest engine speed [rpm]: the idle speed, or more."""
    highest_speed_rpm: float
    """Highest engine speed [rpm]."""
    full_load: Curve
    """Highest brake torque over speed."""
    motoring: Curve = NO_MOTORING
    """Torque that turns the engine without fuel, over speed: the brake torque falls to its negative. One point holds at
    all speeds."""
    share_over: float = SHARE_OVER
    """Share of the time of a leg for which noise may take the torque beyond a limit."""
    noise_sigmas: float | None = None
    """Standard deviations of the noise of speed and brake torque that are kept free below their limits at every crest,
    instead of a share of the time; None: by ``share_over``."""
    demand_rate_limit_rpm_per_s: float | None = None
    """Fastest change of the set point that the engine's control unit follows [rpm/s]; None: no limit."""
    demand_resolution_rpm: float | None = None
    """Step of the demand on its way to the control unit [rpm]; None: not quantised."""
    demand_cycle_s: float | None = None
    """Time from one message with the demand to the next [s]; None: it follows at once."""
    barred_rpm: tuple[tuple[float, float], ...] = ()
    """Ranges of engine speed in which the line must not stay [rpm]."""
    highest_frequency_hz: float = HIGHEST_FREQUENCY_HZ
    """Highest frequency of a line [Hz]."""
    gauge: GaugeRange | None = None
    """What the torque gauge can show; None: not held against anything."""

    def __post_init__(self) -> None:
        """Check that the numbers leave room.

        Raises DesignError if one is not positive, or two contradict each other.
        """
        wrong = [*_not_positive(self), *_not_ascending(self)]
        if wrong:
            raise DesignError(f"limits of a test: expected {'; '.join(wrong)}.")

    @property
    def demand_delay_s(self) -> float:
        """Delay that holding and quantising add to the latency of the set point, on average [s].

        Half a cycle of the messages, and half of a step over the rate at which it is followed.
        """
        held = 0.0 if self.demand_cycle_s is None else 0.5 * self.demand_cycle_s
        if self.demand_resolution_rpm is None or self.demand_rate_limit_rpm_per_s is None:
            return held
        return held + 0.5 * self.demand_resolution_rpm / self.demand_rate_limit_rpm_per_s

    @property
    def last_frequency_hz(self) -> float:
        """Highest frequency of a line that the messages of the demand still render [Hz]."""
        if self.demand_cycle_s is None:
            return self.highest_frequency_hz
        return min(self.highest_frequency_hz, 1.0 / (MESSAGES_PER_PERIOD * self.demand_cycle_s))

    def with_ripple(self, ripple: float | None) -> Self:
        """Return the limits with a gauge of another ripple; as they are without a gauge, or where none is known."""
        if self.gauge is None or ripple is None:
            return self
        return replace(self, gauge=replace(self.gauge, ripple=ripple))

    def free_speeds(self, speed_rpm: float) -> tuple[float, float]:
        """Return the lowest and highest speed about a mean speed, which barred ranges narrow [rpm].

        Raises
        ------
        DesignError
            If the mean speed is in a barred range, or outside of the allowed speeds.
        """
        low = max([self.lowest_speed_rpm, *(high for _, high in self.barred_rpm if high <= speed_rpm)])
        high = min([self.highest_speed_rpm, *(low for low, _ in self.barred_rpm if low >= speed_rpm)])
        barred = [f"{a:g} to {b:g} rpm" for a, b in self.barred_rpm if a < speed_rpm < b]
        if barred or not low < speed_rpm < high:
            raise DesignError(
                f"leg at {speed_rpm:g} rpm: expected a speed from {low:g} to {high:g} rpm"
                f"{f' outside of the barred {barred[0]}' if barred else ''}; choose another share of the working point."
            )
        return low, high


def limits_from_vessel(vessel: "Vessel", *, set_point_rpm: float) -> Limits:
    """Return what a vessel file allows; change single numbers with ``dataclasses.replace``.

    Where the file has no operating limits, speeds go from idle to rated speed and no torque below zero is asked for.

    Parameters
    ----------
    set_point_rpm
        Largest deviation of the set point from the level of its leg [rpm].
    """
    point, machine, limits = vessel.working_point, vessel.machine, vessel.limits
    low, high = limits.lowest_speed_rpm, limits.highest_speed_rpm
    return Limits(
        engine_speed_rpm=point.engine_speed_rpm,
        brake_torque_nm=point.driving_torque_nm / vessel.gearbox.shaft_over_brake,
        set_point_rpm=set_point_rpm,
        lowest_speed_rpm=machine.lowest_governed_rpm if low is None else low,
        highest_speed_rpm=machine.rated_speed_rpm if high is None else high,
        full_load=_curve(*machine.full_load),
        motoring=NO_MOTORING if vessel.motoring is None else _curve(*vessel.motoring),
        demand_rate_limit_rpm_per_s=limits.demand_rate_limit_rpm_per_s,
        demand_resolution_rpm=limits.demand_resolution_rpm,
        demand_cycle_s=limits.demand_cycle_s,
        barred_rpm=limits.barred_speeds_rpm,
        gauge=gauge_range_of(vessel),
    )


def usual_speeds(limits: Limits, *, working_point_rpm: float | None = None) -> tuple[float, ...]:
    """Return two speeds as far apart as the limits leave room for, at most 1.15 and 0.78 of the working point.

    A second speed separates what one alone cannot. Where full load, gauge or highest speed lower the first, the second
    is lower by as much. Where there is no room for two it is the working point alone.

    ``limits``: what ship and engine allow. ``working_point_rpm``: engine speed of the working point that is meant
    [rpm], where the limits are stated about another one, such as that of a first test at a higher speed; theirs where
    not given. Returns shares of ``limits.engine_speed_rpm``.
    """
    point_rpm = limits.engine_speed_rpm if working_point_rpm is None else working_point_rpm
    to_stated = point_rpm / limits.engine_speed_rpm
    clear = _CLEAR * limits.set_point_rpm
    usual = min(USUAL_SHARES[0], (limits.highest_speed_rpm - clear) / point_rpm)
    high = usual
    while not _has_torque_room(limits, high * to_stated) and high > USUAL_SHARES[1]:
        high -= _SHARE_STEP
    low = max(USUAL_SHARES[1] * min(high / usual, 1.0), (limits.lowest_speed_rpm + clear) / point_rpm)
    shares = (round(high, 3), round(low, 3)) if high > low else (1.0,)
    return tuple(share * to_stated for share in shares)


def _has_torque_room(limits: Limits, speed_share: float) -> bool:
    """Return whether a leg at a speed has room for lines below full load and in the range of the gauge.

    In bollard pull, where torque goes with the square of the speed.
    """
    torque_nm = speed_share**2 * limits.brake_torque_nm
    speeds_rpm, torques_nm = zip(*limits.full_load, strict=True)
    full_nm = float(np.interp(speed_share * limits.engine_speed_rpm, speeds_rpm, torques_nm))
    gauge = limits.gauge
    shown = gauge is None or gauge.highest_nm > (1.0 + gauge.rare_ripple + _GAUGE_ROOM) * gauge.shaft_torque_nm(
        limits.brake_torque_nm, speed_share
    )
    return shown and full_nm > (1.0 + _TORQUE_ROOM) * torque_nm


def _curve(speeds_rpm: Sequence[float], torques_nm: Sequence[float]) -> Curve:
    return tuple(zip(speeds_rpm, torques_nm, strict=True))


def _not_positive(limits: Limits) -> list[str]:
    numbers = {
        "engine_speed_rpm": limits.engine_speed_rpm,
        "brake_torque_nm": limits.brake_torque_nm,
        "set_point_rpm": limits.set_point_rpm,
        "highest_frequency_hz": limits.highest_frequency_hz,
        "share_over": limits.share_over,
        "demand_rate_limit_rpm_per_s": limits.demand_rate_limit_rpm_per_s,
        "demand_resolution_rpm": limits.demand_resolution_rpm,
        "demand_cycle_s": limits.demand_cycle_s,
    }
    return [
        f"a positive {name}, found {value:g}"
        for name, value in numbers.items()
        if value is not None and not value > 0.0
    ]


def _not_ascending(limits: Limits) -> list[str]:
    ranges = {"speeds": (limits.lowest_speed_rpm, limits.highest_speed_rpm)}
    ranges |= {f"barred range {number}": span for number, span in enumerate(limits.barred_rpm, start=1)}
    wrong = [] if limits.share_over < 0.5 else [f"a share_over below 0.5, found {limits.share_over:g}"]
    wrong += [
        f"{name} from lower to higher, found {low:g} to {high:g} rpm"
        for name, (low, high) in ranges.items()
        if not low < high
    ]
    for name, curve in (("full_load", limits.full_load), ("motoring", limits.motoring)):
        speeds = [speed for speed, _ in curve]
        if not speeds or any(later <= earlier for earlier, later in pairwise(speeds)):
            wrong.append(f"{name} with ascending speeds, found {', '.join(f'{one:g}' for one in speeds) or 'none'}")
    return wrong
