"""A plan as a campaign file: what is put out to the governor, in volts."""

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Staircase
from shaftprint.campaign._multisine import Multisine
from shaftprint.design.plan._leg import Leg
from shaftprint.design.plan._plan import Plan
from shaftprint.errors import DesignError

STAIRS_NAME = "St1"
"""Name of the staircase of a planned test."""


def campaign_of(plan: Plan, *, name: str, offset_v: float, slope_rpm_per_v: float) -> Campaign:
    """Return the campaign of a plan: a multisine for each leg with ramps between them, the way back, and a staircase.

    Parameters
    ----------
    plan
        The plan.
    name
        Name of the campaign.
    offset_v
        Set point at the speed of the first working point [V].
    slope_rpm_per_v
        Change of the engine speed for one volt [rpm/V], negative where a lower voltage asks for more speed.

    Raises
    ------
    DesignError
        If the slope is zero.
    """
    if slope_rpm_per_v == 0.0:
        raise DesignError(f"campaign {name}: expected a slope of the set point in rpm for one volt, found 0.")
    multisines = tuple(
        _multisine(leg, f"M{number}", start_s, plan, offset_v, slope_rpm_per_v)
        for number, (leg, start_s) in enumerate(zip(plan.legs, plan.starts_s, strict=True), start=1)
    )
    return Campaign(
        name=name,
        duration_s=plan.duration_s,
        offset_v=multisines[0].level_v,
        offset_rpm=plan.legs[0].level_rpm,
        slope_rpm_per_v=slope_rpm_per_v,
        ramp_v_per_s=plan.timetable.ramp_rpm_per_s / abs(slope_rpm_per_v),
        multisines=multisines,
        staircases=_staircases(plan, multisines[0].level_v, slope_rpm_per_v),
    )


def _staircases(plan: Plan, level_v: float, slope_rpm_per_v: float) -> tuple[Staircase, ...]:
    """Return the staircase about a level [V]; none where the plan has none."""
    if not plan.stairs_rpm:
        return ()
    levels_v = tuple(level_v + deviation_rpm / slope_rpm_per_v for deviation_rpm in plan.stairs_rpm)
    return (
        Staircase(name=STAIRS_NAME, levels_v=levels_v, dwell_s=plan.timetable.dwell_s, start_s=plan.stairs_start_s),
    )


def _multisine(leg: Leg, name: str, start_s: float, plan: Plan, offset_v: float, slope_rpm_per_v: float) -> Multisine:
    turned = np.pi if slope_rpm_per_v < 0.0 else 0.0
    return Multisine(
        name=name,
        level_v=offset_v + (leg.level_rpm - plan.limits.engine_speed_rpm) / slope_rpm_per_v,
        period_s=leg.period_s,
        harmonics=leg.harmonics,
        amplitudes_v=tuple((leg.amplitudes_rpm / abs(slope_rpm_per_v)).tolist()),
        phases_rad=tuple((leg.phases_rad + turned).tolist()),
        start_s=start_s,
        settled_s=start_s + leg.settle_s,
        stop_s=start_s + leg.duration_s,
    )
