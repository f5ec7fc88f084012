"""What speaks against a whole log, before anything is fitted to it.

A fit of output and model takes the lever for an input that nothing on board moves. Where somebody trims it against the
load, or its clock is off, the numbers are wrong and the misfit need not show it (Box and MacGregor, The analysis of
closed-loop dynamic-stochastic systems, Technometrics 16, 1974). So each of these is asked for itself:

- does the still lever follow the load of some seconds before?
- by which shift of the lever does the log agree best with an earlier fingerprint?
- does the speed follow the lever wherever it stands still, and give way to the load nowhere?
- does the torque go with the square of the speed across moves, as it does at the quay?
- is the speed the same from whichever side the lever came?

Somebody who trims against the load only when he moves the lever anyway is seen by none of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._gauge import T_SP
from shaftprint.distributions import deviations
from shaftprint.service._gather import MEAN_S, StillMeans
from shaftprint.service._model import ServiceModel
from shaftprint.service._score import Simulated
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.time_domain._decimator import Decimator
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

LATEST_S = 0.02
"""Shift of the lever's clock from which on a log is refused [s]."""
# A fingerprint leaves the shift open, and so many deviations of that are beyond doubt.
_OPEN_STD = 2.0
# A lever follows the load from this many standard deviations on; a crew without that in mind stays below 2.3 an hour.
_FOLLOWS_STD = 4.0
# Scatter is taken over so many seconds together.
_TOGETHER_S = 30.0
# Shifts that are tried [s], in steps of a sample.
_REACH_S = 0.5
# A ship with way on takes a torque whose load rises with the speed across a move: by more than this share of it, beyond
# so many standard deviations, in moves of so much of the speed.
_WAY, _WAY_STD, _LEAST_MOVE = 0.1, 4.0, 0.08
# Where the lever stands still the speed is what it asks for, within this share of it and so many deviations of its
# line; elsewhere less than this share of the time. After a move that takes so long, and a mean over so much of the end.
_OFF, _OFF_STD, _OFF_SHARE, _SETTLED_S, _END_S = 0.017, 6.0, 0.1, 15.0, 5.0
# From this share of what the engine gives at a speed on it is at its limit.
_FULL_LOAD = 0.95
# A governor holds the speed whatever the load; where the torque l n^2 is held, the speed goes with l^-1/2. Nearer to
# that than to nothing is no governor's doing. How often a sound log may be refused, and the least degrees of freedom.
_HELD, _HELD_RATE, _FEWEST_HELD = -0.25, 1e-3, 8
_BEFORE_SAMPLES, _AFTER_S, _UNTIL_S = 40, 4.0, 9.0
# Loads of one water lie within this share about a usual one, and those beyond the second are of another.
_ALIKE, _OTHER = 0.08, 0.13
# A lever came from where it was this share of its move away. Half of its play counts from so many standard deviations
# and this share of the speed on, told by so many moves.
_LAST_WAY, _PLAY_STD, _PLAY, _FEWEST_ENDS = 0.1, 5.0, 6e-4, 12


@dataclass(frozen=True, kw_only=True, slots=True)
class Found:
    """One thing that was asked of a log."""

    what: str
    """What was asked, in a few words."""
    value: float
    """What was found; not a number where the log does not tell."""
    unit: str
    """Its unit."""
    refused: str = ""
    """Why the log is refused; empty where it is not."""


def lever_follows_load(still: StillMeans) -> Found:
    """Return by how many standard deviations a still lever follows the load of the five seconds before.

    ``still``: means of lever and load where the lever stands still.
    """
    what = "still lever on the load before it"
    same = still.stretch[2:] == still.stretch[:-2]
    lever = (still.lever_v[2:] - still.lever_v[1:-1])[same]
    load = (still.load[1:-1] - still.load[:-2])[same]
    moves = np.abs(lever) > 0.0
    if np.count_nonzero(moves) < 10 or not np.any(load):
        return Found(what=what, value=float("nan"), unit="std")
    product = lever * (load - load.mean())
    length = max(round(_TOGETHER_S / MEAN_S), 1)
    sums = np.add.reduceat(product, np.arange(0, product.size, length))
    ratio = float(product.sum() / np.sqrt(np.sum(sums**2)))
    refused = ""
    if abs(ratio) > _FOLLOWS_STD:
        refused = (
            f"while it stands still, the lever follows the load of the seconds before ({abs(ratio):.0f} standard "
            "deviations): somebody, or a load controller, trims it against the load, and what the governor does cannot "
            "be told from what he does; log the demand that the control unit takes, or use hours without that."
        )
    return Found(what=what, value=ratio, unit="std", refused=refused)


def shift_of_lever(runs: Sequence[Simulated], model: ServiceModel) -> Found:
    """Return by how much the lever is late against speed and torque, beside an earlier fingerprint [ms].

    ``runs``: segments beside the simulation of that fingerprint. ``model``: it, with what the fingerprint leaves open.
    """
    rate_hz = runs[0].record.rate_hz
    reach = round(_REACH_S * rate_hz)
    shifts = np.arange(-reach, reach + 1)
    cost = np.zeros(shifts.size)
    for run in runs:
        measured = run.record.outputs["n"]
        simulated = measured - run.residuals[:, 0] / run.weight
        kept = slice(reach, measured.size - reach)
        size = float(run.residuals[:, 0].var())
        for place, shift in enumerate(shifts):
            left = (measured - np.roll(simulated, shift))[kept] * run.weight[kept]
            cost[place] += float(np.sum((left - left.mean()) ** 2)) / size
    best = int(np.clip(np.argmin(cost), 1, cost.size - 2))
    below, at, above = cost[best - 1 : best + 2]
    bend = below - 2.0 * at + above
    shift_s = -float(shifts[best] + (0.5 * (below - above) / bend if bend > 0.0 else 0.0)) / rate_hz
    open_s = _left_open_s(runs, model)
    refused = ""
    if abs(shift_s) > LATEST_S + _OPEN_STD * open_s:
        side = "early" if shift_s < 0.0 else "late"
        refused = (
            f"against the fingerprint the lever is {1e3 * abs(shift_s):.0f} +/- {1e3 * open_s:.0f} ms {side}, and "
            f"{1e3 * LATEST_S:.0f} ms are too many for delays and gains: lever, speed and torque do not share one "
            "clock (or the latency of the set point was changed); log all three with one logger, or bring its files "
            "onto one clock (shaftprint merge)."
        )
    return Found(what="clock of the lever beside the fingerprint", value=1e3 * shift_s, unit="ms", refused=refused)


def _left_open_s(runs: Sequence[Simulated], model: ServiceModel) -> float:
    """Return how far the other numbers that a fingerprint leaves open move the shift [s], one standard deviation."""
    if model.covariance is None:
        return 0.0
    columns = [
        (run.slopes[:, :, 0] - run.slopes[:, :, 0].mean(axis=1, keepdims=True)).reshape(len(model.free), -1)
        / float(run.residuals[:, 0].std())
        for run in runs
    ]
    late = model.free.index(T_SP.name)
    moved = sum(one @ one[late] for one in columns)
    towards = moved / moved[late]
    return float(np.sqrt(max(towards @ model.covariance @ towards, 0.0)))


def beside_full_load(still: StillMeans, vessel: "Vessel") -> tuple[StillMeans, Found]:
    """Return what stands still below the torque that the engine gives at most, and the share of the rest [%].

    There the engine holds its torque and no speed, as a tug does that pulls with all it has: nothing of that is a
    controller behind the lever. ``still``: means. ``vessel``: the installation, with its full-load curve.
    """
    point = vessel.working_point
    rpm = rpm_from_rev_s(still.speed_rev_s)
    torque_nm = still.load * point.driving_torque_nm / vessel.gearbox.shaft_over_brake
    torque_nm = torque_nm * (rpm / point.engine_speed_rpm) ** 2
    below = torque_nm < _FULL_LOAD * np.interp(rpm, *vessel.machine.full_load)
    share = float(np.mean(~below)) if below.size else float("nan")
    return still.only(below), Found(what="time of a still lever at full load", value=100.0 * share, unit="%")


def off_the_line(still: StillMeans, line: LeverLine) -> Found:
    """Return in which share of the still stretches the speed is not what the lever asks for.

    ``still``: means of lever and speed where the lever stands still. ``line``: what it asks for.
    """
    what = "speed off the line of the lever where it stands still"
    # the first mean of a stretch may still hold what is left of the move before it
    settled = np.flatnonzero(np.diff(still.stretch, prepend=-1.0) == 0.0)
    if not settled.size:
        return Found(what=what, value=float("nan"), unit="%")
    off_rpm = rpm_from_rev_s(still.speed_rev_s - line.speed_rev_s(still.lever_v))
    share = float(np.mean(np.abs(off_rpm[settled]) > farthest_rpm(line)))
    refused = ""
    if share > _OFF_SHARE:
        refused = (
            f"in {share:.0%} of the time in which the lever stands still, the speed is more than "
            f"{farthest_rpm(line):.0f} rpm from what it asks for: a load controller, a limit or another lever is "
            "between it and the governor; log the demand that the control unit takes."
        )
    return Found(what=what, value=100.0 * share, unit="%", refused=refused)


def torque_is_held(still: StillMeans, line: LeverLine, *, speed_rev_s: float) -> Found:
    """Return with which power of the load the speed of a still lever goes where the torque is high, beyond elsewhere.

    A governor holds it as well as at low torques, however much it hunts and whatever bend the lever has: each stretch
    is compared with itself. From which torque on it is held, if it is, the log tells: the one with most evidence
    counts.

    ``still``: means of lever, speed and load where the lever stands still. ``line``: what it asks for, which the little
    that it moves there is taken off by. ``speed_rev_s``: engine speed of the working point [rev/s].
    """
    what = "power of the load with which the speed goes at high torques, of a still lever"
    asked = line.speed_rev_s(still.lever_v)
    # a lever that asks for no speed ahead is not the one in command
    settled = np.flatnonzero((np.diff(still.stretch, prepend=-1.0) == 0.0) & (asked > 0.0))
    if not settled.size:
        return Found(what=what, value=float("nan"), unit="-")
    _, place, counts = np.unique(still.stretch[settled], return_inverse=True, return_counts=True)

    def of_stretches(values: FloatArray) -> FloatArray:
        return np.asarray(np.bincount(place, weights=values), dtype=np.float64)

    x, y = (
        values - (of_stretches(values) / counts)[place]
        for values in np.log([still.load[settled], still.speed_rev_s[settled] / asked[settled]])
    )
    torques = of_stretches(still.load[settled] * (still.speed_rev_s[settled] / speed_rev_s) ** 2) / counts
    order = np.argsort(-torques)
    half = order.size // 2
    sums = np.array([of_stretches(x * x), of_stretches(x * y), of_stretches(y * y), counts - 1.0])[:, order]
    lower = _power(sums[:, half:].sum(axis=1, keepdims=True))
    power, std, freedom = _power(np.cumsum(sums[:, :half], axis=1))
    tells = np.flatnonzero(freedom >= _FEWEST_HELD)
    if not tells.size or lower[2][0] < _FEWEST_HELD:
        return Found(what=what, value=float("nan"), unit="-")
    beyond = power[tells] - lower[0]
    ratio = beyond / np.hypot(std[tells], lower[1])
    at = int(np.argmin(np.where(beyond < _HELD, ratio, np.inf))) if np.any(beyond < _HELD) else int(np.argmin(ratio))
    last, value = int(tells[at]), float(beyond[at])
    refused = ""
    if value < _HELD and ratio[at] < -deviations(1.0 - 2.0 * _HELD_RATE / tells.size, float(freedom[last])):
        refused = (
            f"where the torque is high, from about {torques[order[last]]:.0%} of the working point's on, the speed is "
            f"not what the lever asks for: it gives way to the load with the power {power[last]:.2f}, where a governor "
            "holds it (0) and a torque that is held has -0.5; a load controller or a limit behind the lever holds the "
            "torque there: log the demand that the control unit takes, or use hours without it."
        )
    return Found(what=what, value=value, unit="-", refused=refused)


def _power(sums: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return slopes through zero, their deviations and degrees of freedom, from sums (4, cases) of xx, xy, yy and 1."""
    xx, xy, yy, count = sums
    xx = np.maximum(xx, 1e-300)
    left = np.maximum(yy - xy**2 / xx, 0.0)
    return xy / xx, np.sqrt(left / np.maximum(count - 1.0, 1.0) / xx), count - 1.0


def farthest_rpm(line: LeverLine) -> float:
    """Return how far from what the lever asks for the speed may be where it stands still [rpm]."""
    return max(_OFF_STD * line.spread_rpm, _OFF * rpm_from_rev_s(line.middle_rev_s))


def speed_is_off(segment: Segment, line: LeverLine) -> str:
    """Return why a segment cannot be used whose speed is not what the lever asks for; empty where it is.

    ``segment``: a usable segment. ``line``: what the lever asks for.
    """
    off_rpm = _off_at_end_rpm(segment, line)
    if off_rpm is not None and abs(off_rpm) > farthest_rpm(line):
        return "the speed does not come to what the lever asks for: a limit acts, or a load controller"
    return ""


def _off_at_end_rpm(segment: Segment, line: LeverLine) -> float | None:
    """Return how far the speed is at the end from what the lever asks for [rpm]; None where it has not settled."""
    if segment.start_s + segment.seconds - segment.move_end_s < _SETTLED_S:
        return None
    last = round(_END_S * segment.rate_hz / segment.every)
    # beyond the last sample there is the margin of the filter, and perhaps the next move
    asked = float(line.speed_rev_s(segment.lever_v[[-1 - Decimator(every=segment.every).half]])[0])
    return rpm_from_rev_s(float(np.mean(segment.speed_rev_s[-last:])) - asked)


def play_of_lever(segments: Sequence[Segment], line: LeverLine) -> Found:
    """Return by how much the speed hangs on the side from which the lever came, half of its play [rpm].

    Speed that the lever does not give while it takes up its play is missing in each move that turns back.

    ``segments``: usable segments. ``line``: what the lever asks for.
    """
    what = "speed by the side from which the lever came"
    rows = []
    for segment in segments:
        off_rpm = _off_at_end_rpm(segment, line)
        asked = line.speed_rev_s(segment.lever_v[: segment.lever_v.size - Decimator(every=segment.every).half])
        away = np.flatnonzero(np.abs(asked - asked[-1]) > _LAST_WAY * np.ptp(asked))
        if off_rpm is not None and away.size:
            rows.append((float(np.sign(asked[-1] - asked[away[-1]])), off_rpm))
    if len(rows) < _FEWEST_ENDS:
        return Found(what=what, value=float("nan"), unit="rpm")
    side, off = np.array(rows).T
    play, std = _through_zero(side - side.mean(), off - off.mean())
    refused = ""
    if abs(play) > _PLAY_STD * std and abs(play) > _PLAY * rpm_from_rev_s(line.middle_rev_s):
        refused = (
            f"where the lever was moved up to where it stands, the speed is {2.0 * abs(play):.1f} +/- {2.0 * std:.1f} "
            f"rpm {'lower' if play < 0.0 else 'higher'} than where it was moved down to there: the lever has play "
            "between its sensor and the governor; log the demand that the control unit takes."
        )
    return Found(what=what, value=play, unit="rpm", refused=refused)


def usual_load(loads: FloatArray) -> float:
    """Return the load that most segments have.

    ``loads``: torque over what the propeller takes at that speed, shape (segments,).
    """
    order = np.sort(np.log(np.maximum(loads, 1e-3)))
    counts = np.searchsorted(order, order + 2.0 * _ALIKE, side="right") - np.arange(order.size)
    first = int(np.argmax(counts))
    return float(np.exp(np.median(order[first : first + int(counts[first])])))


def is_other(loads: FloatArray, usual: float) -> BoolArray:
    """Return whether loads are those of another water: a model of both, quay and underway, knows neither."""
    return np.abs(loads / usual - 1.0) > _OTHER


def way_on(segments: Sequence[Segment], *, sails: bool = False) -> Found:
    """Return how much the load rises with the speed across moves: nothing at the quay, more with way on.

    ``segments``: usable segments. ``sails``: whether the vessel file says that the ship makes way.
    """
    what = "load that rises with the speed across a move"
    rows = []
    for segment in segments:
        rate = segment.rate_hz / segment.every
        after = round((segment.move_end_s - segment.start_s + _AFTER_S) * rate)
        until = min(round((segment.move_end_s - segment.start_s + _UNTIL_S) * rate), segment.speed_rev_s.size)
        before = slice(0, round((segment.move_s - segment.start_s) * rate))
        if until - after < _BEFORE_SAMPLES:
            continue
        speeds = [float(np.mean(segment.speed_rev_s[part])) for part in (before, slice(after, until))]
        loads = [
            float(np.mean(segment.torque_nm[part]) / np.mean(segment.speed_rev_s[part] ** 2))
            for part in (before, slice(after, until))
        ]
        if min(*speeds, *loads) > 0.0 and abs(np.log(speeds[1] / speeds[0])) > _LEAST_MOVE:
            rows.append((float(np.log(speeds[1] / speeds[0])), float(np.log(loads[1] / loads[0]))))
    if len(rows) < 6:
        return Found(what=what, value=float("nan"), unit="-")
    moves, loads_moved = np.array(rows).T
    slope, std = _through_zero(moves, loads_moved)
    refused = ""
    if sails and slope + _WAY_STD * std < _WAY:
        refused = (
            f"torque over the square of the speed hardly changes with the moves of the lever (exponent {slope:+.2f} "
            f"+/- {std:.2f} beyond 2): the ship makes no way, as at the quay, and the vessel file is that of a ship "
            "underway; use hours underway, or the vessel file of the quay."
        )
    elif not sails and abs(slope) > _WAY and abs(slope) > _WAY_STD * std:
        refused = (
            f"torque over the square of the speed changes with each move of the lever (exponent {slope:+.2f} +/- "
            f"{std:.2f} beyond 2): the ship has way on, or the propeller another pitch, and the model is that of the "
            "quay; use hours at the quay, or a vessel file with ship_speed_m_s for hours underway."
        )
    return Found(what=what, value=slope, unit="-", refused=refused)


def _through_zero(x: FloatArray, y: FloatArray) -> tuple[float, float]:
    """Return the slope of a line through zero and its standard deviation, whatever the scatter depends on."""
    slope = float(x @ y / (x @ x))
    return slope, float(np.sqrt(np.sum((x * (y - slope * x)) ** 2)) / (x @ x))
