"""Jumps between two levels, as a shift register makes them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign._binary_sequence import BinarySequence

_ORDERS = range(3, 13)
_FEWEST_JUMPS = 8
# A jump is off its clock by this share of one at most.
_OFF_CLOCK = 0.2
# So many clocks are looked for in the sequence; so many periods have to follow.
_COMPARED, _FEWEST_PERIODS = 64, 1.5


@dataclass(frozen=True, kw_only=True, slots=True)
class Hold:
    """A level at which the set point stands."""

    level_v: float
    """The level [V]."""
    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""

    @property
    def length_s(self) -> float:
        """How long it lasts [s]."""
        return self.end_s - self.begin_s


@dataclass(frozen=True, kw_only=True, slots=True)
class RegisterMatch:
    """A binary sequence in a list of holds."""

    order: int
    """Length of the shift register."""
    first_clock: int
    """Clock of its period with which it begins."""
    clock_s: float
    """Its clock [s]."""
    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""
    level_v: float
    """Middle of its values [V]."""
    amplitude_v: float
    """Half of the distance between them [V]."""


def two_valued(holds: Sequence[Hold], *, tolerance_v: float) -> tuple[int, int] | None:
    """Return the longest run of holds that alternate between two levels, as first and the one behind the last."""
    best, first = (0, 0), 0
    for k in range(len(holds)):
        if k - first >= 2 and abs(holds[k].level_v - holds[k - 2].level_v) > tolerance_v:
            first = k - 1
        if k + 1 - first > best[1] - best[0]:
            best = first, k + 1
    return best if best[1] - best[0] > _FEWEST_JUMPS else None


def register_of(holds: Sequence[Hold]) -> RegisterMatch | None:
    """Return the binary sequence that holds at two levels are; None where they are no such sequence.

    Jumps inside count; how long the first and last hold last is no news where the set point stood before and after.
    """
    jumps = np.array([hold.begin_s for hold in holds[1:]])
    lengths = np.diff(jumps)
    clock = _clock(jumps, lengths)
    if clock is None:
        return None
    clock_s, counts = clock
    before = max(round((jumps[0] - holds[0].begin_s) / clock_s), 1)
    after = max(int((holds[-1].end_s - jumps[-1]) / clock_s + _OFF_CLOCK), 1)
    high = np.array([hold.level_v for hold in holds])
    upper = high > 0.5 * (high.min() + high.max())
    signs = np.repeat(np.where(upper, 1.0, -1.0), [before, *counts, after])
    match = _matched(signs, before)
    if match is None:
        return None
    order, rotation, begin, end = match
    grid_s = float(np.mean(jumps - clock_s * np.concatenate([[0], np.cumsum(counts)])))
    levels = [float(np.median(high[side])) for side in (upper, ~upper)]
    return RegisterMatch(
        order=order,
        first_clock=rotation,
        clock_s=clock_s,
        begin_s=grid_s + (begin - before) * clock_s,
        end_s=min(grid_s + (end - before) * clock_s, holds[-1].end_s),
        level_v=0.5 * (levels[0] + levels[1]),
        amplitude_v=0.5 * (levels[0] - levels[1]),
    )


def begun_behind_ramp(match: RegisterMatch, ramp_to_v: float) -> RegisterMatch:
    """Return a sequence that begins where a ramp has come to its first value.

    Where it seems to begin with a jump from there, its first clock was taken for the end of the ramp.
    """
    signs = _sequence(match.order)
    if abs(match.level_v + match.amplitude_v * signs[match.first_clock] - ramp_to_v) <= match.amplitude_v:
        return match
    return replace(match, begin_s=match.begin_s - match.clock_s, first_clock=(match.first_clock - 1) % signs.size)


def _clock(jumps_s: FloatArray, lengths_s: FloatArray) -> tuple[float, list[int]] | None:
    """Return the clock [s] of jumps, and how many of it lie between one and the next; None where there is none."""
    clock_s = float(np.min(lengths_s))
    for _ in range(3):
        counts = np.rint(lengths_s / clock_s)
        if np.any(counts < 1):
            return None
        clock_s = float(lengths_s @ counts / (counts @ counts))
    places = np.concatenate([[0.0], np.cumsum(counts)])
    clock_s, first_s = np.polyfit(places, jumps_s, 1)
    if np.max(np.abs(jumps_s - first_s - clock_s * places)) > _OFF_CLOCK * clock_s:
        return None
    return float(clock_s), [int(count) for count in counts]


def _matched(signs: FloatArray, before: int) -> tuple[int, int, int, int] | None:
    """Return order, first clock, and the clocks from which to which signs are a register's; None where they are none.

    The first and the last hold may be longer than the sequence has them: the set point stood there before or after.
    """
    for order in _ORDERS:
        period = _sequence(order)
        if signs.size < period.size:
            return None
        length = min(_COMPARED, signs.size - before, period.size)
        tiled = np.concatenate([period, period[:length]])
        windows = np.lib.stride_tricks.sliding_window_view(tiled, length)[: period.size]
        for rotation in np.flatnonzero((windows == signs[before : before + length]).all(axis=1)).tolist():
            wrong = np.flatnonzero(np.resize(np.roll(period, before - rotation), signs.size) != signs)
            begin = int(wrong[wrong < before].max()) + 1 if np.any(wrong < before) else 0
            end = int(wrong[wrong >= before].min()) if np.any(wrong >= before) else signs.size
            if end - begin < _FEWEST_PERIODS * period.size:
                continue
            # between two legs the set point waits at the value with which the sequence would go on
            end -= 1 if end < signs.size else 0
            return order, int((rotation - before + begin) % period.size), begin, end
    return None


def _sequence(order: int) -> FloatArray:
    """Return one period of the sequence of an order."""
    clocks = 2 * ((1 << order) - 1)
    made = BinarySequence(
        name="B",
        level_v=0.0,
        amplitude_v=1.0,
        clock_s=1.0,
        order=order,
        start_s=0.0,
        settled_s=0.0,
        stop_s=2.0 * clocks,
    )
    return made.signs
