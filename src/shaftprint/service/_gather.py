"""One pass through the logs: the segments, what stood still between them, and what the ship was doing."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.errors import ServiceError
from shaftprint.service._log import RECORD_HZ, Block, LeftOut, blocks
from shaftprint.service._moves import (
    APART_S,
    BEFORE_S,
    KEEP_S,
    LONGEST_S,
    MARGIN_S,
    SHORTEST_S,
    Move,
    moves_of,
    moving,
)  # fmt: skip
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.service._states import AHEAD, CLUTCH_OUT, IDLE, NOT_TOLD, STATES, state_of, state_of_seconds
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain.nonlinear._orders import orders_in
from shaftprint.units import SECONDS_PER_MINUTE

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# Length of the means of which still stretches are made [s].
MEAN_S = 5.0
# Stretches that tell of the lever's line, and the least of them, with the range of speeds that they span.
_FEWEST, _LEAST_RANGE = 5, 0.05
# Scatter of the still stretches about the line beyond which the lever is not what the governor follows, over the speed.
_LARGEST_SPREAD = 0.013
# Levers and their cards bend by so much: the slope changes by this share a volt.
_BEND_STD_PER_V = 0.004


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StillMeans:
    """Means over five seconds each in which the lever stands still and the ship goes ahead, in order of time."""

    lever_v: FloatArray
    """Set point [V], shape (means,)."""
    speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (means,)."""
    load: FloatArray
    """Torque over the square of the speed, over that of the working point, shape (means,)."""
    stretch: FloatArray
    """Number of the still stretch of each, shape (means,)."""

    def only(self, kept: BoolArray) -> "StillMeans":
        """Return some of them, those of ``kept``, shape (means,)."""
        return StillMeans(
            lever_v=frozen_float(self.lever_v[kept]),
            speed_rev_s=frozen_float(self.speed_rev_s[kept]),
            load=frozen_float(self.load[kept]),
            stretch=frozen_float(self.stretch[kept]),
        )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Gathered:
    """What the logs hold."""

    segments: tuple[Segment, ...]
    """One for each move of the lever, usable or not, in order of time."""
    still: StillMeans
    """What stood still between them."""
    seconds: Mapping[str, float]
    """How long the ship was doing what [s]."""
    left_out: tuple[LeftOut, ...]
    """Stretches that could not be read."""
    spans_s: Mapping[str, tuple[float, float]]
    """From when to when each log goes, in its own seconds [s]."""
    began: datetime | None
    """When the first of them began; None where it does not say."""


def gather(
    logs: Sequence[str | Path], vessel: "Vessel", *, progress: Callable[[float], None] | None = None
) -> Gathered:
    """Return what logs of service hold, from one reading; memory does not grow with what lies between the moves.

    ``logs``: files, in order of time. ``vessel``: the installation. ``progress``: is told the share that is done, 0 to
    1. Raises ServiceError if a log does not show what a governor does; RecordingError if a file cannot be read.
    """
    left_out: list[LeftOut] = []
    segments: list[Segment] = []
    seconds: dict[str, float] = dict.fromkeys(STATES, 0.0)
    still: list[FloatArray] = []
    spans_s: dict[str, tuple[float, float]] = {}
    stretches, began = 0, None
    for block in blocks(logs, vessel, keep_s=KEEP_S, told=left_out.append, progress=progress):
        if not spans_s and block.began is not None:
            began = block.began + timedelta(seconds=block.start_s)
        states = _states(block, vessel)
        new_s = block.start_s + (block.lever_v.size - block.new) / block.rate_hz
        spans_s[block.log] = (
            spans_s.get(block.log, (new_s, 0.0))[0],
            float(block.start_s + block.lever_v.size / block.rate_hz),
        )
        for state in states[states.size - block.new // round(block.rate_hz) :]:
            seconds[STATES[state]] += 1.0
        segments += [_segment(block, move, states, vessel) for move in _moves(block, vessel)]
        means, stretches = _still(block, states, vessel, stretches)
        still.append(means)
    every = np.concatenate(still) if still else np.zeros((0, 4))
    return Gathered(
        segments=tuple(segments),
        still=StillMeans(
            lever_v=frozen_float(every[:, 0]),
            speed_rev_s=frozen_float(every[:, 1]),
            load=frozen_float(every[:, 2]),
            stretch=frozen_float(every[:, 3]),
        ),
        seconds={state: length for state, length in seconds.items() if length},
        left_out=tuple(left_out),
        spans_s=spans_s,
        began=began,
    )


def range_v(vessel: "Vessel") -> float:
    """Return the change of the set point from standing to the speed of the working point, as far as it is known [V]."""
    sensor = vessel.sensors.set_point
    shown = sensor.table_rpm
    if shown is not None:
        slope = (shown[-1][1] - shown[0][1]) / (shown[-1][0] - shown[0][0]) / sensor.slope_v
        return vessel.working_point.engine_speed_rpm / slope
    if sensor.unit == "rpm":
        return vessel.working_point.engine_speed_rpm * sensor.slope_v
    # half of what a lever can show: 5 V, 50 %, 8 mA
    return {"V": 5.0, "%": 50.0, "mA": 8.0}[sensor.unit] * sensor.slope_v


def _moves(block: Block, vessel: "Vessel") -> list[Move]:
    """Return the moves that are to be cut out of a block: those that it shows whole and the one before did not."""
    margin = MARGIN_S * block.rate_hz
    overlap = block.lever_v.size - block.new
    found = moves_of(block, range_v=range_v(vessel))
    return [move for move in found if move.stop + margin >= overlap and (move.is_complete or not block.goes_on)]


def _states(block: Block, vessel: "Vessel") -> NDArray[np.int8]:
    """Return what the ship was doing in each second of a block, the last one ending with it."""
    length = round(block.rate_hz)
    first = block.lever_v.size % length
    whole = block.whole[first:].reshape(-1, length).all(axis=1)
    speed, torque = (values[first:].reshape(-1, length).mean(axis=1) for values in (block.speed_rev_s, block.torque_nm))
    states = state_of_seconds(speed, torque, vessel)
    # a torque that stands still near nothing is no gauge that is dead
    return np.where(whole | (states == CLUTCH_OUT), states, NOT_TOLD).astype(np.int8)


def _still(block: Block, states: NDArray[np.int8], vessel: "Vessel", number: int) -> tuple[FloatArray, int]:
    """Return means of still stretches of the new part of a block, shape (means, 4), and how many stretches there are.

    Lever, speed, load and number of the stretch.
    """
    rate = block.rate_hz
    moves = moving(block.lever_v, rate, range_v=range_v(vessel)) | ~block.whole
    moved = np.concatenate([[0], np.cumsum(moves)])
    length, settle = round(MEAN_S * rate), round(APART_S * rate)
    fresh = block.lever_v.size - block.new
    point = vessel.working_point
    begins = np.arange(fresh, block.lever_v.size - length + 1, length)
    stops, befores = begins + length, np.maximum(begins - settle, 0)
    elsewhere = np.concatenate([[0], np.cumsum(states != AHEAD)])
    first = np.maximum(states.size - ((block.lever_v.size - befores) / rate).astype(np.int64), 0)
    last = np.minimum(first + ((stops - befores) / rate).astype(np.int64), states.size)
    good = (moved[stops] == moved[befores]) & (begins >= settle) & (elsewhere[last] == elsewhere[first])
    whole = slice(fresh, fresh + begins.size * length)
    lever, speed, torque = (
        values[whole].reshape(-1, length)[good] for values in (block.lever_v, block.speed_rev_s, block.torque_nm)
    )
    square = np.mean((speed * SECONDS_PER_MINUTE / point.engine_speed_rpm) ** 2, axis=1)
    load = torque.mean(axis=1) / point.driving_torque_nm / square
    # means that do not follow on each other are of another stretch
    anew = np.diff(np.flatnonzero(good), prepend=-2) > 1
    numbers = number + np.cumsum(anew)
    rows = np.column_stack([lever.mean(axis=1), speed.mean(axis=1), load, numbers.astype(np.float64)])
    return rows, int(numbers[-1]) if numbers.size else number


def _segment(block: Block, move: Move, states: NDArray[np.int8], vessel: "Vessel") -> Segment:
    """Return a move cut out of a block, with the reason why it cannot be used where there is one."""
    every = round(block.rate_hz / RECORD_HZ)
    half = Decimator(every=every).half
    count = (move.stop - 1 - move.start) // every + 1 if move.stop > move.start else 0
    fine = slice(move.start - half, move.start + (count - 1) * every + half + 1)
    size = block.lever_v.size
    inside = slice(max(fine.start, 0), min(max(fine.stop, 1), size))
    from_end = [int(np.ceil((size - at) / block.rate_hz)) for at in (inside.start, inside.stop)]
    doing = states[max(states.size - from_end[0], 0) : max(states.size - from_end[1], 1)]
    reason = _why_not(block, move, doing, count / RECORD_HZ, fits=fine.start >= 0 and fine.stop <= size)
    common: Any = {
        "log": block.log,
        "start_s": block.start_s + move.start / block.rate_hz,
        "move_s": block.start_s + move.first / block.rate_hz,
        "move_end_s": block.start_s + move.last / block.rate_hz,
        "rate_hz": block.rate_hz,
        "every": every,
        "state": state_of(doing),
        "reason": reason,
    }
    if reason:
        empty = frozen_float(np.zeros(0))
        return Segment(**common, lever_v=frozen_float(block.lever_v[inside].copy()), speed_rev_s=empty, torque_nm=empty)
    decimator = Decimator(every=every)
    speed, torque = block.speed_rev_s[fine], block.torque_nm[fine]
    orders = (1.0, *(float(order) for order in vessel.machine.torque_orders[:1]), 1.0 / vessel.gearbox.ratio)
    torque = torque - orders_in(torque, speed, block.rate_hz, orders)
    return Segment(
        **common,
        # a copy: a view would keep the hour around it in memory
        lever_v=frozen_float(block.lever_v[fine].copy()),
        speed_rev_s=frozen_float(decimator.filtered(speed)),
        torque_nm=frozen_float(decimator.filtered(torque)),
    )


def _why_not(block: Block, move: Move, doing: NDArray[np.int8], seconds: float, *, fits: bool) -> str:
    """Return why a move cannot be used; empty where it can."""
    if not fits or (not move.is_complete and move.stop >= block.lever_v.size):
        return "the log begins or ends there"
    if not block.whole[max(move.start, 0) : move.stop].all():
        return "a channel is missing there"
    if np.any(doing == IDLE):
        return "the lever is on idle, where it asks for nothing"
    if not np.all(doing == AHEAD):
        return f"the ship was not ahead all the time ({state_of(doing)})"
    before = max(move.first - round(APART_S * block.rate_hz), 0)
    if move.first - before < APART_S * block.rate_hz - 1.0:
        return "the log begins or ends there"
    if seconds < SHORTEST_S:
        return f"the lever moves again within {SHORTEST_S - BEFORE_S:g} s"
    if seconds > LONGEST_S:
        return f"the lever goes on moving for more than {LONGEST_S:g} s"
    return ""


def lever_line(still: StillMeans) -> LeverLine:
    """Return the line of the lever from where it stands still: a governor holds the speed that is asked for.

    Raises ServiceError if too little stood still, at too few speeds, or the speed does not follow the lever.
    """
    numbers = np.unique(still.stretch)
    levels = np.array(
        [[x[still.stretch == k].mean() for x in (still.lever_v, still.speed_rev_s)] for k in numbers]
    ).reshape(-1, 2)
    weight = np.array([np.sum(still.stretch == k) for k in numbers], dtype=np.float64)
    needed = f"lever: expected {_FEWEST} or more stretches of {APART_S + MEAN_S:g} s and more where it stands still"
    if levels.shape[0] < _FEWEST:
        raise ServiceError(f"{needed} with the ship ahead, found {levels.shape[0]}; give more logs.")
    if np.ptp(levels[:, 1]) < _LEAST_RANGE * levels[:, 1].mean():
        low, high = (SECONDS_PER_MINUTE * float(of(levels[:, 1])) for of in (np.min, np.max))
        raise ServiceError(
            f"{needed} at several speeds ahead, found {levels.shape[0]} between {low:.0f} and {high:.0f} rpm; give "
            "logs of hours in which the speed was changed."
        )
    keep, bend, spread = np.ones(weight.size, dtype=np.bool_), 0.0, 0.0
    for _ in range(3):
        middle = np.average(levels[keep], axis=0, weights=weight[keep])
        moved = levels - middle
        slope = float(np.sum((weight * moved[:, 0] * moved[:, 1])[keep]) / np.sum((weight * moved[:, 0] ** 2)[keep]))
        if spread > 0.0:
            middle_rev_s, slope, bend = _bent(moved[keep], weight[keep], slope, spread)
            middle = middle + np.array([0.0, middle_rev_s])
            moved = levels - middle
        left = moved[:, 1] - slope * moved[:, 0] * (1.0 + 0.5 * bend * moved[:, 0])
        spread = 1.4826 * float(np.median(np.abs(left[keep])))
        keep = np.abs(left) <= max(5.0 * spread, 1e-9)
    if spread > _LARGEST_SPREAD * middle[1]:
        raise ServiceError(
            f"lever: expected a speed that follows the lever within {100.0 * _LARGEST_SPREAD:g} % where it stands "
            f"still, found a scatter of {spread * SECONDS_PER_MINUTE:.0f} rpm; the channel of sensors.set_point is not "
            "what the governor follows: log the demand that the control unit takes."
        )
    return LeverLine(
        slope_rev_s_per_v=slope,
        middle_v=float(middle[0]),
        middle_rev_s=float(middle[1]),
        spread_rpm=spread * SECONDS_PER_MINUTE,
        stretches=int(keep.sum()),
        bend_per_v=bend,
    )


def _bent(moved: FloatArray, weight: FloatArray, slope: float, spread: float) -> tuple[float, float, float]:
    """Return speed in the middle, slope there and bend of a line, as far as its scatter tells the bend.

    ``moved``: set points and speeds from the middle, shape (stretches, 2). ``weight``: length of each. ``slope``: that
    of the straight line. ``spread``: scatter of a stretch of usual length.
    """
    volts, speed = moved.T
    rows = np.stack([np.ones(volts.size), volts, 0.5 * slope * volts**2], axis=1)
    precision = weight / (np.mean(weight) * spread**2)
    known = np.diag([0.0, 0.0, _BEND_STD_PER_V**-2])
    middle, new_slope, bend = np.linalg.solve(
        rows.T @ (precision[:, None] * rows) + known, rows.T @ (precision * speed)
    )
    return float(middle), float(new_slope), float(bend * slope / new_slope)
