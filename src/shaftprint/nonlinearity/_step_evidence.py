"""Rise, overshoot, torque peak and settling of every step, beside those of a linear governor."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.nonlinearity._fit import ABSENT, GOVERNOR, Fit, foretold
from shaftprint.nonlinearity._record import Record, block_means
from shaftprint.nonlinearity._tails import chi_square_tail

if TYPE_CHECKING:
    from shaftprint.campaign import Campaign, Staircase

NUMBERS = ("rise", "overshoot", "torque peak", "settling")
"""Rise from 10 to 90 % [s], overshoot over the step [-], largest change of torque over its final change [-], time until
the speed stays within 5 % [s]."""

_BEFORE_S = 2.0
_LONGEST_S = 12.0
_SMOOTHED_S = 0.1
_SETTLED = 0.05
_MOST_NOISE = 24
_LEAST_STEP = 0.02


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class StepEvidence:
    """Numbers of every step; curves are changes from the level before over the change to the level asked for."""

    names: tuple[str, ...]
    """Staircase and number of each step."""
    rising: BoolArray
    """Whether it raises the speed, shape (steps,)."""
    size: FloatArray
    """Change of the set point [-], shape (steps,)."""
    measured: FloatArray
    """Numbers of the measured step, in the order of `NUMBERS`, shape (steps, 4)."""
    expected: FloatArray
    """Numbers of the linear governor on a quadratic propeller, shape (steps, 4)."""
    std: FloatArray
    """Standard deviation of measured minus expected, from the noise before the steps, shape (steps, 4)."""
    up_minus_down: FloatArray
    """Mean of measured minus expected of the rising steps less that of the falling ones, shape (4,)."""
    up_minus_down_std: FloatArray
    """Its standard deviation, shape (4,)."""
    p_value: FloatArray
    """Probability of that asymmetry by chance, each number alone, shape (4,); 1 where there are not both. The least of
    four, times four, falls below 5 % in 15 % of linear recordings."""
    time_s: FloatArray
    """Time since the jump of the curves [s], shape (samples,)."""
    speed: FloatArray
    """Speed of each step, 0 before and 1 at the level asked for, shape (steps, samples)."""
    torque: FloatArray
    """Shaft torque of each step over its expected final change, shape (steps, samples)."""
    expected_speed: FloatArray
    """Speed that was expected, shape (steps, samples)."""
    expected_torque: FloatArray
    """Torque that was expected, shape (steps, samples)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        object.__setattr__(self, "rising", frozen_bool(self.rising))
        for name in self.__slots__[2:]:
            object.__setattr__(self, name, frozen_float(getattr(self, name)))


def step_evidence(record: Record, found: Fit, campaign: "Campaign") -> StepEvidence:
    """Measure every step and simulate it without any limit."""
    linear = {**ABSENT, **{name: found.values[name] for name in GOVERNOR}}
    engine, speed = foretold(record, linear, inertia_s=record.upstream_s + record.downstream_s)
    torque = engine - record.upstream_s * np.gradient(speed, record.step_s)
    pairs = [np.stack([record.speed, record.shaft_torque]), np.stack([speed, torque])]
    length = round(_SMOOTHED_S / record.step_s)
    traces = [np.stack([block_means(row, length) for row in pair]) for pair in pairs]
    time, asked = block_means(record.time_s, length), block_means(record.set_point, length)
    noise = traces[0] - traces[1]
    lost = np.interp(time, record.value_time_s, np.isinf(record.load).astype(np.float64)) > 0.0
    span = _span_s(campaign)
    names, rows = [], []
    for stairs in campaign.staircases:
        for number in range(1, len(stairs.levels_v)):
            row = _one_step(stairs, number, span, time, asked, traces, noise, lost)
            if row is not None:
                names.append(f"{stairs.name}/{number}")
                rows.append(row)
    return _collected(names, rows, span, length * record.step_s)


def _span_s(campaign: "Campaign") -> float:
    dwell = min((stairs.dwell_s for stairs in campaign.staircases), default=_LONGEST_S)
    return float(min(dwell, _LONGEST_S))


def _one_step(
    stairs: "Staircase",
    number: int,
    span_s: float,
    time: FloatArray,
    asked: FloatArray,
    traces: list[FloatArray],
    noise: FloatArray,
    lost: BoolArray,
) -> tuple[float, FloatArray, FloatArray, FloatArray, FloatArray] | None:
    """Return size, measured and expected numbers, their std and the four curves.

    Nothing is returned for a step that is too small or touched by a gap.
    """
    step_s = float(time[1] - time[0])
    jump_s = stairs.start_s + number * stairs.dwell_s
    jump = int(np.searchsorted(time, jump_s))
    before, after = round(_BEFORE_S / step_s), round(span_s / step_s)
    if jump < before + 2 or jump + after > time.size or lost[jump - before : jump + after].any():
        return None
    levels = float(asked[jump - before : jump - 1].mean()), float(asked[jump + after // 2 : jump + after - 1].mean())
    size = levels[1] - levels[0]
    if abs(size) < _LEAST_STEP:
        return None
    change = np.array([size, (1.0 + levels[1]) ** 2 - (1.0 + levels[0]) ** 2])[:, np.newaxis]
    start = np.array([levels[0], (1.0 + levels[0]) ** 2])[:, np.newaxis]
    here = slice(jump - before, jump + after)
    curves = [(trace[:, here] - start) / change for trace in traces]
    ends = [k for k in _quiet_places(stairs, time, before + after) if not lost[k - after - before : k].any()]
    quiet = [noise[:, k - after - before : k] / change for k in ends]
    shaken = np.array([_numbers(curves[1] + one, before, step_s) for one in quiet[:_MOST_NOISE]])
    std = shaken.std(axis=0, ddof=1) if len(shaken) > 2 else np.full(len(NUMBERS), np.nan)
    measured, expected = (_numbers(curve, before, step_s) for curve in curves)
    if len(shaken):
        # noise alone makes a step overshoot and settle late: expected is what the noise makes of it on average
        expected = shaken.mean(axis=0)
    return size, measured, expected, std, np.concatenate(curves)


def _quiet_places(stairs: "Staircase", time: FloatArray, length: int) -> list[int]:
    """Return the ends of stretches of noise before the staircase and at the ends of its levels."""
    first = int(np.searchsorted(time, stairs.start_s))
    last = int(np.searchsorted(time, stairs.stop_s))
    return [k for k in range(length, last, max(length // 3, 1)) if k <= first or k % 2 == 0][-_MOST_NOISE:]


def _numbers(curves: FloatArray, before: int, step_s: float) -> FloatArray:
    """Return the four numbers of one step from its speed and torque, shape (4,)."""
    speed, torque = curves[0, before:], curves[1, before:]
    reached = [int(np.argmax(speed >= share)) if np.any(speed >= share) else speed.size for share in (0.1, 0.9)]
    outside = np.flatnonzero(np.abs(speed - 1.0) > _SETTLED)
    settled = (int(outside[-1]) + 1 if outside.size else 0) * step_s
    return np.array([(reached[1] - reached[0]) * step_s, speed.max() - 1.0, torque.max(), settled])


def _collected(
    names: list[str], rows: list[tuple[float, FloatArray, FloatArray, FloatArray, FloatArray]], span: float, step: float
) -> StepEvidence:
    size = np.array([row[0] for row in rows])
    rising = size > 0.0
    measured, expected, std = (np.array([row[k] for row in rows]).reshape(-1, len(NUMBERS)) for k in (1, 2, 3))
    samples = round(_BEFORE_S / step) + round(span / step)
    curves = np.array([row[4] for row in rows]).reshape(-1, 4, samples)
    differences, deviations, chances = _asymmetry(measured - expected, std, rising)
    return StepEvidence(
        names=tuple(names),
        rising=rising,
        size=size,
        measured=measured,
        expected=expected,
        std=std,
        up_minus_down=differences,
        up_minus_down_std=deviations,
        p_value=chances,
        time_s=(np.arange(samples, dtype=np.float64) + 0.5) * step - _BEFORE_S,
        speed=curves[:, 0],
        torque=curves[:, 1],
        expected_speed=curves[:, 2],
        expected_torque=curves[:, 3],
    )


def _asymmetry(excess: FloatArray, std: FloatArray, rising: BoolArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return rising minus falling of each number with standard deviation and probability by chance."""
    if not rising.any() or rising.all():
        nothing = np.full(len(NUMBERS), np.nan)
        return nothing, nothing, np.ones(len(NUMBERS))
    difference = excess[rising].mean(axis=0) - excess[~rising].mean(axis=0)
    variance = sum((std[chosen] ** 2).sum(axis=0) / np.count_nonzero(chosen) ** 2 for chosen in (rising, ~rising))
    deviation = np.sqrt(variance)
    safe = np.maximum(deviation, 1e-12)
    chances = np.array([chi_square_tail(float(z) ** 2, 1) if np.isfinite(z) else 1.0 for z in difference / safe])
    return difference, deviation, chances
