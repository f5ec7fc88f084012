"""The way of the set point from the voltage at the helm to the speed demand inside the ECU."""

from typing import NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.errors import SettingsError
from shaftprint.kernels._compiled import compiled
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._physics import working_point
from shaftprint.units import rev_s_from_rpm, rpm_from_rev_s
from shaftprint.vessel._vessel import Vessel


@compiled(nogil=True)
def _rate_limit(asked: FloatArray, followed: FloatArray, largest_change) -> None:  # type: ignore[no-untyped-def]
    for j in range(1, asked.size):
        change = asked[j] - followed[j - 1]
        largest = largest_change
        if followed[j - 1] == asked[j - 1] and abs(change) > largest:
            # a jump that is seen now was on average half a step ago
            largest = 0.5 * largest
        followed[j] = followed[j - 1] + min(max(change, -largest), largest)


def helm_voltage(tug: Tug, campaign: Campaign, time_s: FloatArray) -> FloatArray:
    """Return the true set-point voltage [V] behind the potentiometer, shape of ``time_s``."""
    cycle_s, step_v = tug.generator_cycle_s, tug.generator_step_v
    if cycle_s is not None:
        # a billionth of a cycle, so that rounding does not delay a voltage that is due
        time_s = cycle_s * (np.floor(time_s / cycle_s + 1e-9) + 0.5)
    voltage = setpoint(campaign, time_s)
    if step_v is not None:
        voltage = step_v * np.round(voltage / step_v)
    return voltage + tug.set_point_offset_v


@compiled(nogil=True)
def _play(voltage, followed, half_v) -> None:  # type: ignore[no-untyped-def]
    for j in range(1, voltage.size):
        followed[j] = min(max(followed[j - 1], voltage[j] - half_v), voltage[j] + half_v)


def demanded_speed(tug: Tug, vessel: Vessel, voltage_v: FloatArray) -> FloatArray:
    """Return the engine speed [rev/s] that a voltage asks for by the true line, shape of ``voltage_v``.

    The line bends about the voltage that asks for the speed of the working point.
    """
    slope, intercept = tug.set_point_slope_rpm_per_v, tug.set_point_intercept_rpm
    line = slope * voltage_v + intercept
    if tug.set_point_bend_per_v:
        speed_rev_s, _ = working_point(tug, vessel)
        about_v = voltage_v - (rpm_from_rev_s(speed_rev_s) - intercept) / slope
        line += 0.5 * tug.set_point_bend_per_v * slope * about_v**2
    return rev_s_from_rpm(line)


class DemandLimits(NamedTuple):
    """What the ECU makes of the demand; None where it does not."""

    resolution_rpm: float | None
    """Step of the demand [rpm]."""
    cycle_s: float | None
    """Time for which a message is held [s]."""
    rate_rpm_per_s: float | None
    """Fastest change [rpm/s]."""
    lowest_rpm: float | None
    """Idle speed, below which no demand is followed [rpm]."""

    @property
    def stated(self) -> dict[str, float]:
        """What the ECU limits, as it is kept with the truth."""
        return {f"demand_{name}": value for name, value in self._asdict().items() if value is not None}


def demand_limits(tug: Tug, vessel: Vessel) -> DemandLimits:
    """Return what the ECU makes of the demand: what the truth says of it, else what the vessel file states."""
    stated = vessel.limits
    return DemandLimits(
        resolution_rpm=_first(tug.demand_resolution_rpm, stated.demand_resolution_rpm),
        cycle_s=_first(tug.demand_cycle_s, stated.demand_cycle_s),
        rate_rpm_per_s=_first(tug.demand_rate_limit_rpm_per_s, stated.demand_rate_limit_rpm_per_s),
        lowest_rpm=stated.lowest_speed_rpm,
    )


def _first(of_truth: float | None, of_vessel: float | None) -> float | None:
    return of_vessel if of_truth is None else of_truth


class Demand:
    """Stream of the speed demand in the ECU on half steps.

    It is late, held, has play, is quantised, not below idle and rate-limited.
    """

    def __init__(self, tug: Tug, vessel: Vessel, campaign: Campaign, *, start_s: float, step_s: float) -> None:
        self._tug = tug
        self._vessel = vessel
        self._campaign = campaign
        self._followed_v: float | None = None
        self._limits = demand_limits(tug, vessel)
        self._working_point_rev_s, _ = working_point(tug, vessel)
        self._start_s = start_s
        self._half_step_s = 0.5 * step_s
        self._count = 0
        self.first = float(self._late(np.array([start_s]))[0])
        """Demand at the start [rev/s], at which the line is taken to run steadily."""
        if not self.first > 0.0:
            raise SettingsError(
                f"campaign {campaign.name}: expected a set point that asks for a positive speed at {start_s:g} s, "
                f"found {rpm_from_rev_s(self.first):g} rpm by its line; change slope, intercept or offset of the "
                "tug, or state slope_rpm_per_v and offset_rpm in the campaign file."
            )
        self._last = self.first

    def next(self, steps: int, wander: FloatArray) -> FloatArray:
        """Return the demand [rev/s] at the nodes and middles of the next steps, shape (2 steps + 1,).

        ``wander`` is the disturbance of the demand [fraction of the working point] at the nodes, shape (steps + 1,).
        """
        half_steps = np.arange(self._count, self._count + 2 * steps + 1, dtype=np.float64)
        time: FloatArray = self._start_s + self._half_step_s * half_steps
        demand = self._late(time)
        self._count += 2 * steps
        if self._limits.rate_rpm_per_s is not None:
            largest = rev_s_from_rpm(self._limits.rate_rpm_per_s) * self._half_step_s
            # the first value is the last of the chunk before: it may not move twice
            followed = np.full_like(demand, self._last)
            _rate_limit(demand, followed, largest)
            self._last = float(followed[-1])
            demand = followed
        demand[::2] += self._working_point_rev_s * wander
        demand[1::2] += 0.5 * self._working_point_rev_s * (wander[:-1] + wander[1:])
        return demand

    def _late(self, time_s: FloatArray) -> FloatArray:
        sent_s = time_s - self._tug.set_point_latency_s
        cycle_s = self._limits.cycle_s
        if cycle_s is not None:
            # a billionth of a cycle, so that rounding does not delay a message that is due
            sent_s = cycle_s * np.floor(sent_s / cycle_s + 1e-9)
        voltage = helm_voltage(self._tug, self._campaign, sent_s)
        if self._tug.set_point_hysteresis_v:
            followed = np.full_like(voltage, voltage[0] if self._followed_v is None else self._followed_v)
            _play(voltage, followed, 0.5 * self._tug.set_point_hysteresis_v)
            self._followed_v = float(followed[-1])
            voltage = followed
        demand = demanded_speed(self._tug, self._vessel, voltage)
        if self._limits.resolution_rpm is not None:
            resolution = rev_s_from_rpm(self._limits.resolution_rpm)
            demand = resolution * np.round(demand / resolution)
        if self._limits.lowest_rpm is not None:
            # a set point that asks for no positive speed at all is refused, not raised to idle
            demand = np.where(demand > 0.0, np.maximum(demand, rev_s_from_rpm(self._limits.lowest_rpm)), demand)
        return demand
