"""A planned test: its lines, what they do to the ship, and what another length would make of it."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._setpoint import setpoint
from shaftprint.digits import plain
from shaftprint.distributions import NORMAL_95
from shaftprint.plain_table import Symbol
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Dash, Line, Mark, Points, Straight
from shaftprint.report.figures._envelope import envelope
from shaftprint.units import PERCENT, SECONDS_PER_HOUR, SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.design.plan._plan import Plan
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.views._line_worth import LineWorth
    from shaftprint.design.views._other_lengths import LengthCurve
    from shaftprint.design.views._planned_motion import PlannedMotion

# Room of an axis beyond what it shows, as a share of it.
_ROOM = 0.06
# Samples of the set point of a whole test.
_SAMPLES = 20_000
_NOISE = "noise, 95 %"
_DASHES_OF_LIMITS: tuple[Dash, Dash] = ("dot", "dash")


def planned_set_point_chart(test: "PlannedTest") -> Chart:
    """Return the set point of the whole test as engine speed, with the limits of the speed."""
    campaign, limits = test.campaign, test.plan.limits
    time_s = np.linspace(0.0, campaign.duration_s, _SAMPLES, endpoint=False)
    speed = test.line.speed_rpm(setpoint(campaign, time_s), working_point_rpm=limits.engine_speed_rpm)
    time, values = envelope(time_s, speed)
    marks: list[Mark] = [
        Line(x=time / SECONDS_PER_MINUTE, y=values, name="set point", width=1.0),
        *_speed_limits(test.plan),
    ]
    levels = [*values, limits.lowest_speed_rpm, limits.highest_speed_rpm]
    speeds = Scale(title="engine speed [rpm]", span=_around(levels))
    return Chart(
        panels=(Panel(marks=marks, x=Scale(title="time [min]"), y=speeds),),
        heights_px=(260,),
    )


def planned_line_chart(worths: "Sequence[LineWorth]") -> Chart:
    """Return the lines of each leg above what a line would tell at each frequency, a leg beside the other."""
    lines, information = [], []
    for worth in worths:
        leg = worth.leg
        hertz, amplitudes = leg.frequency_hz, leg.amplitudes_rpm
        x = Scale(title="frequency [Hz]", log=True)
        stems = Points(
            x=hertz, y=amplitudes, bars=(amplitudes, np.zeros_like(amplitudes)), name="lines", shade=0, size=5
        )
        lines.append(Panel(marks=(stems,), x=x, y=Scale(title="amplitude [rpm]"), title=f"{leg.level_rpm:.0f} rpm"))
        per_hour = SECONDS_PER_HOUR * worth.per_second
        there = np.interp(np.log(hertz), np.log(worth.frequency_hz), per_hour)
        curve = Line(x=worth.frequency_hz, y=per_hour, name="information of a line of 1 rpm", shade=1)
        marks: tuple[Mark, ...] = (curve, Points(x=hertz, y=there, shade=0, size=5))
        y = Scale(title="information [1/h]", log=True, span=_around(per_hour, log=True))
        information.append(Panel(marks=marks, x=x, y=y))
    return Chart(panels=(*lines, *information), columns=len(worths), heights_px=(220, 220), linked="columns")


def planned_motion_chart(motions: "Sequence[PlannedMotion]", plan: "Plan") -> Chart:
    """Return one period of each leg: set point and speed above, brake torque below, with noise and limits."""
    speeds, torques = [], []
    for motion in motions:
        span = Scale(title="time in the period [s]", span=(0.0, motion.leg.period_s))
        title = f"{motion.leg.level_rpm:.0f} rpm"
        speeds.append(Panel(marks=_speed_marks(motion, plan), x=span, y=Scale(title="engine speed [rpm]"), title=title))
        torques.append(Panel(marks=_torque_marks(motion), x=span, y=Scale(title="brake torque [N·m]")))
    return Chart(panels=(*speeds, *torques), columns=len(motions), heights_px=(260, 260), linked="columns")


def length_chart(curve: "LengthCurve", plan: "Plan") -> Chart:
    """Return how well the same lines would make numbers known in other times: over the wish, or over the value."""
    minutes = curve.duration_s / SECONDS_PER_MINUTE
    targets = plan.targets
    planned_min = plan.duration_s / SECONDS_PER_MINUTE
    marks: list[Mark] = [Straight(at=planned_min, axis="x", name=f"this plan, {plain(planned_min, 1)} min")]
    for shade, (name, relative) in enumerate(curve.relative_std.items()):
        scale = PERCENT
        if targets:
            scale = abs(plan.predicted.estimate(name).value) / targets[name]
        marks.append(Line(x=minutes, y=scale * relative, name=Symbol(name), shade=shade))
    if targets:
        marks.append(Straight(at=1.0, axis="y", name="wish", dash="dash"))
    title = "predicted std over wish" if targets else "predicted std [%]"
    levels = [value for mark in marks if isinstance(mark, Line) for value in mark.y.tolist()]
    upright = Scale(title=title, log=True, span=_around([*levels, 1.0] if targets else levels, log=True))
    panel = Panel(marks=marks, x=Scale(title="length of the test [min]"), y=upright)
    return Chart(panels=(panel,), heights_px=(320,))


def _around(values: Iterable[float], *, log: bool = False) -> tuple[float, float] | None:
    """Return the ends of an axis that leaves room beyond all values; None where there are none to show."""
    shown = [math.log(value) if log else value for value in values if math.isfinite(value) and (value > 0 or not log)]
    if not shown:
        return None
    low, high = min(shown), max(shown)
    room = _ROOM * (high - low) or 1.0
    ends = low - room, high + room
    return (math.exp(ends[0]), math.exp(ends[1])) if log else ends


def _speed_marks(motion: "PlannedMotion", plan: "Plan") -> list[Mark]:
    level, half = motion.leg.level_rpm, NORMAL_95 * motion.speed_std_rpm
    marks: list[Mark] = [
        Band(x=motion.time_s, lower=motion.speed_rpm - half, upper=motion.speed_rpm + half, name=_NOISE, shade=0),
        Line(x=motion.time_s, y=motion.set_point_rpm, name="set point", shade="reference", width=1.3),
        Line(x=motion.time_s, y=motion.speed_rpm, name="assumed ship", shade=0, width=1.6),
        *(
            Straight(at=level + sign * plan.limits.set_point_rpm, axis="y", name="limit of the set point", dash="dash")
            for sign in (-1.0, 1.0)
        ),
    ]
    return [*marks, *_speed_limits(plan, near=motion.speed_rpm)]


def _torque_marks(motion: "PlannedMotion") -> list[Mark]:
    half = NORMAL_95 * motion.torque_std_nm
    torque = motion.brake_torque_nm
    return [
        Band(x=motion.time_s, lower=torque - half, upper=torque + half, name=_NOISE, shade=0),
        Line(x=motion.time_s, y=torque, name="assumed ship", shade=0, width=1.6),
        Line(x=motion.time_s, y=motion.full_load_nm, name="full load", shade=1, width=1.3),
        Line(x=motion.time_s, y=motion.motoring_nm, name="motoring", shade=2, width=1.3),
    ]


def _speed_limits(plan: "Plan", near: FloatArray | None = None) -> list[Mark]:
    """Return the lowest and highest speed; those that are far from what is drawn are left out."""
    limits = {"lowest speed": plan.limits.lowest_speed_rpm, "highest speed": plan.limits.highest_speed_rpm}
    reach = np.inf if near is None else 0.6 * float(np.ptp(near))
    middle = 0.0 if near is None else float(np.mean(near))
    return [
        Straight(at=speed, axis="y", name=name, shade="ink", dash=dash)
        for (name, speed), dash in zip(limits.items(), _DASHES_OF_LIMITS, strict=True)
        if near is None or abs(speed - middle) < reach + 0.5 * float(np.ptp(near))
    ]
