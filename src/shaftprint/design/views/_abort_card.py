"""The noun ``AbortCard``: what the bridge may see during a test, and when it is to stop."""

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.design.inputs._lever import Lever
from shaftprint.design.inputs._limits import SPEED_SIGMAS
from shaftprint.design.motion._motion import SIGNALS, motion_noise
from shaftprint.distributions import normal_cdf
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.design.inputs._limits import Limits
    from shaftprint.design.planned_test._planned_test import PlannedTest

_SPEED, _TORQUE = SIGNALS.index("speed"), SIGNALS.index("brake torque")
# Speeds between the lowest and the highest of a leg, at which the curves of its limits are read.
_SPEEDS = 33
_OWN = slice(_SPEED, _TORQUE + 1)


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class AbortCard(Shown):
    """The extremes of a test, with the noise that comes on top of what is planned."""

    set_point_v: tuple[float, float]
    """Lowest and highest voltage of the set point [V]."""
    set_point_rpm: tuple[float, float]
    """Lowest and highest engine speed that is asked for [rpm]."""
    speed_rpm: tuple[float, float]
    """Lowest and highest engine speed that may be seen [rpm]."""
    brake_torque_nm: tuple[float, float]
    """Lowest and highest brake torque that may be seen [N m]: noise asks for no more than the engine has."""
    share_at_limit: float | None
    """Share of the time for which noise may ask for more than that, at most; None where it does not reach it."""
    rate_rpm_per_s: float
    """Fastest change of the set point [rpm/s]."""
    step_rpm: float
    """Largest step of the staircase at the end [rpm]; 0 without one."""
    duration_s: float
    """Length of the whole test with its ramps and its staircase [s]."""
    leave_rpm: tuple[float, float]
    """Engine speeds that must not be passed: the limits of the ship [rpm]."""
    level_v: float
    """Voltage to which the set point is brought back when the test is broken off [V]."""
    level_rpm: float
    """The engine speed there [rpm]."""
    lever: Lever | None
    """What the lever shows for volts; None where it shows them."""


def abort_card(test: "PlannedTest") -> AbortCard:
    """Return what the bridge may see.

    Speed and torque are the peaks of the possible ships with four standard deviations of the noise, so that a sample
    beyond them is a reason to stop; the torque no more than full load, and no less than motoring takes.
    """
    plan, campaign = test.plan, test.campaign
    speeds, torques, at_limit = [], [], False
    for leg, peaks, structure, noise in zip(plan.legs, plan.peaks, plan.structures, plan.noise, strict=True):
        spread = np.sqrt(np.diag(motion_noise(structure, plan.ship.values, noise))[_OWN]) * SPEED_SIGMAS
        speed, torque = leg.level_rpm * spread[0], leg.speed_share**2 * plan.limits.brake_torque_nm * spread[1]
        speeds += [peaks.speed_rpm[0] - speed, peaks.speed_rpm[1] + speed]
        wanted = peaks.brake_torque_nm[0] - torque, peaks.brake_torque_nm[1] + torque
        between = np.linspace(speeds[-2], speeds[-1], _SPEEDS)
        lowest, highest = (
            float(np.interp(between, *np.array(curve).T).max()) * sign
            for curve, sign in ((plan.limits.motoring, -1.0), (plan.limits.full_load, 1.0))
        )
        torques += [max(wanted[0], lowest), min(wanted[1], highest)]
        at_limit |= wanted[0] < lowest or wanted[1] > highest
    volts = [edge for leg in campaign.legs for edge in leg.extremes_v] + [campaign.offset_v]
    volts += [level_v for stairs in campaign.staircases for level_v in stairs.levels_v]
    asked = test.line.speed_rpm(np.array(volts), working_point_rpm=plan.limits.engine_speed_rpm)
    return AbortCard(
        set_point_v=(min(volts), max(volts)),
        set_point_rpm=(float(asked.min()), float(asked.max())),
        speed_rpm=(float(min(speeds)), float(max(speeds))),
        brake_torque_nm=(float(min(torques)), float(max(torques))),
        share_at_limit=_share_over(plan.limits) if at_limit else None,
        rate_rpm_per_s=max(*(peaks.rate_rpm_per_s for peaks in plan.peaks), plan.timetable.ramp_rpm_per_s),
        step_rpm=max((abs(after - before) for before, after in pairwise((0.0, *plan.stairs_rpm))), default=0.0),
        duration_s=plan.duration_s,
        leave_rpm=(plan.limits.lowest_speed_rpm, plan.limits.highest_speed_rpm),
        level_v=campaign.offset_v,
        level_rpm=plan.legs[0].level_rpm,
        lever=test.line.lever,
    )


def _share_over(limits: "Limits") -> float:
    """Return the share of the time that a plan leaves to noise beyond a limit of the torque."""
    sigmas = limits.noise_sigmas
    return limits.share_over if sigmas is None else float(normal_cdf(-sigmas))
