"""What a crew does with the lever on an ordinary day."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np

from shaftprint.campaign._lever_course import LeverCourse
from shaftprint.tug._tug import Tug
from shaftprint.units import SECONDS_PER_HOUR
from shaftprint.vessel._vessel import Vessel

# A day begins and ends with the lever where it is.
_BEFORE_S = 30.0
# The clutch is not moved while the lever is.
_SETTLED_S = 4.0
# The rated speed of the engines for which habits are given; at others they are in proportion [rpm].
_RATED_RPM = 1800.0
# A crew at the quay asks for no more than this share of what the engine gives.
_OF_FULL_LOAD = 0.9


@dataclass(frozen=True, kw_only=True, slots=True)
class Habits:
    """How often, how far and how fast somebody moves the lever, of an engine whose rated speed is 1800 rpm."""

    shortest_hold_s: float = 15.0
    """Shortest time for which the lever is left alone [s]; times are evenly spread over their logarithm."""
    longest_hold_s: float = 200.0
    """Longest such time [s]."""
    corrections: float = 0.7
    """Share of the moves that correct the speed a little; the others go anywhere."""
    correction_rpm: tuple[float, float] = (25.0, 150.0)
    """Least and largest of such a correction [rpm]."""
    second_thoughts: float = 0.25
    """Share of the moves that are mended within seconds, by a fifth of them."""
    hand_rpm_per_s: tuple[float, float] = (100.0, 1500.0)
    """Slowest and fastest hand [rpm/s]."""
    speeds_rpm: tuple[float, float] = (650.0, 1650.0)
    """Lowest and highest speed that is asked for [rpm]."""
    idles_per_hour: float = 2.0
    """How often the lever is laid on idle [1/h]."""
    idle_s: tuple[float, float] = (40.0, 400.0)
    """Shortest and longest stay there [s]."""
    declutched: float = 0.5
    """Share of these stays in which the clutch is taken out."""

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Return the habits of some crew."""
        slowest = float(rng.uniform(80.0, 300.0))
        lowest = float(rng.uniform(640.0, 850.0))
        return cls(
            shortest_hold_s=float(rng.uniform(10.0, 25.0)),
            longest_hold_s=float(rng.uniform(120.0, 400.0)),
            corrections=float(rng.uniform(0.5, 0.85)),
            correction_rpm=(float(rng.uniform(15.0, 40.0)), float(rng.uniform(100.0, 200.0))),
            second_thoughts=float(rng.uniform(0.1, 0.4)),
            hand_rpm_per_s=(slowest, float(rng.uniform(600.0, 2500.0))),
            speeds_rpm=(lowest, float(rng.uniform(1350.0, 1680.0))),
            idles_per_hour=float(rng.uniform(0.5, 4.0)),
            declutched=float(rng.uniform(0.2, 0.9)),
        )


def lever_course(habits: Habits, tug: Tug, vessel: Vessel, *, hours: float, rng: np.random.Generator) -> LeverCourse:
    """Return where a crew puts the lever over some hours, and when it takes the clutch out.

    ``habits``: what the crew is used to. ``tug, vessel``: the ship: the line of its lever, and its idle speed.
    ``hours``: length [h]. ``rng``: source of what happens to be done.
    """
    in_proportion = vessel.machine.rated_speed_rpm / _RATED_RPM
    end_s, lowest = SECONDS_PER_HOUR * hours, in_proportion * habits.speeds_rpm[0]
    highest = min(in_proportion * habits.speeds_rpm[1], _highest_rpm(vessel))
    engine = vessel.engine
    idle = 0.5 * lowest if engine is None or engine.idle_speed_rpm is None else engine.idle_speed_rpm
    corners = [(0.0, 0.5 * (lowest + highest))]
    declutched: list[tuple[float, float]] = []
    time_s, level = _BEFORE_S, corners[0][1]

    def move(to_rpm: float) -> None:
        nonlocal time_s, level
        rate = in_proportion * math.exp(rng.uniform(*np.log(habits.hand_rpm_per_s)))
        corners.append((time_s, level))
        time_s += max(abs(to_rpm - level) / rate, 0.02)
        corners.append((time_s, to_rpm))
        level = to_rpm

    def hold() -> float:
        return math.exp(rng.uniform(math.log(habits.shortest_hold_s), math.log(habits.longest_hold_s)))

    mean_hold_s = (habits.longest_hold_s - habits.shortest_hold_s) / math.log(
        habits.longest_hold_s / habits.shortest_hold_s
    )
    to_idle = habits.idles_per_hour * mean_hold_s / SECONDS_PER_HOUR
    while time_s < end_s - _BEFORE_S:
        if rng.uniform() < to_idle:
            move(idle)
            stay_s = float(rng.uniform(*habits.idle_s))
            if rng.uniform() < habits.declutched and time_s + stay_s < end_s:
                declutched.append((time_s + _SETTLED_S, time_s + stay_s - _SETTLED_S))
            time_s += stay_s
            move(float(rng.uniform(lowest, 0.5 * (lowest + highest))))
        elif rng.uniform() < habits.corrections:
            step = in_proportion * float(rng.uniform(*habits.correction_rpm)) * (1.0 if rng.uniform() < 0.5 else -1.0)
            move(_within(level + step, lowest, highest))
        else:
            move(float(rng.uniform(lowest, highest)))
        if rng.uniform() < habits.second_thoughts:
            before = corners[-2][1]
            time_s += float(rng.uniform(1.0, 6.0))
            move(_within(level - 0.2 * (level - before), lowest, highest))
        time_s += hold()
    times, levels = np.array([corner for corner in corners if corner[0] < end_s]).T
    volts = (levels - tug.set_point_intercept_rpm) / tug.set_point_slope_rpm_per_v - tug.set_point_offset_v
    return LeverCourse(
        name="service",
        duration_s=end_s,
        offset_v=float(volts[0]),
        corner_s=tuple(times.tolist()),
        corner_v=tuple(volts.tolist()),
        declutched_s=tuple(declutched),
    )


def _highest_rpm(vessel: Vessel) -> float:
    """Return the speed at which the propeller of the working point takes nearly what the engine gives [rpm]."""
    point = vessel.working_point
    rpm = np.linspace(0.0, 1.0, 1001)[1:] * vessel.machine.rated_speed_rpm
    taken = point.driving_torque_nm / vessel.gearbox.shaft_over_brake * (rpm / point.engine_speed_rpm) ** 2
    given = np.interp(rpm, *vessel.machine.full_load)
    beyond = np.flatnonzero((taken > _OF_FULL_LOAD * given) & (rpm > point.engine_speed_rpm))
    return float(rpm[beyond[0]] if beyond.size else rpm[-1])


def _within(speed_rpm: float, lowest: float, highest: float) -> float:
    """Return a speed back from beyond the ends of the lever."""
    if speed_rpm > highest:
        return 2.0 * highest - speed_rpm
    return 2.0 * lowest - speed_rpm if speed_rpm < lowest else speed_rpm
