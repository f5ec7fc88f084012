"""Finding one uniform clock in a column of times, and the places where it has holes or jumps."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, ClockJump

_BLOCK = 1_000_000

# Times are printed with few decimals: a step may be off by this part of the mean step, as may be the place
# of a sample on the uniform grid. A sample that is missing or doubled is off by a whole step.
_STEP_TOLERANCE = 0.5

# A logger that lost data did so at a few places; times that jump more often are those of messages.
_MOST_HOLES, _MOST_HOLES_SHARE = 3, 1e-3
# A hole is whole samples long to this part of a step, where times are printed exactly.
_WHOLE = 0.02


@dataclass(frozen=True, kw_only=True, slots=True)
class Hole:
    """A place where the times of a file do not go on by one step."""

    row: int
    """First row after it, counted from 0."""
    missing: int
    """Samples that are missing before that row."""
    jump_s: float
    """How far the times jump besides [s]; 0 where whole samples are missing."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SampleClock:
    """When the samples of a channel were taken."""

    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float
    """Time of the first sample [s]."""
    holes: tuple[Hole, ...] = ()
    """Where samples are missing or the clock jumps, in order of time."""


def on_clock(channel: Channel, clock: SampleClock) -> Channel:
    """Return a channel with its rows at their places on the clock: values that are not numbers fill the holes."""
    if not clock.holes:
        return channel
    rows = np.array([0, *(hole.row for hole in clock.holes), channel.count])
    before = np.cumsum([0, *(hole.missing for hole in clock.holes)])

    def read(start: int, stop: int) -> NDArray[Any]:
        values = np.full(stop - start, np.nan)
        for first, last, shift in zip(rows[:-1].tolist(), rows[1:].tolist(), before.tolist(), strict=True):
            begin, end = max(start - shift, first), min(stop - shift, last)
            if begin < end:
                values[begin + shift - start : end + shift - start] = channel.values(begin, end)
        return values

    jumps = tuple(
        ClockJump(sample=hole.row + int(shift), jump_s=hole.jump_s)
        for hole, shift in zip(clock.holes, before[1:], strict=True)
        if hole.jump_s != 0.0
    )
    count = channel.count + int(before[-1])
    return replace(channel, count=count, source=read, scale=1.0, offset=0.0, clock_jumps=jumps)


def uniform_clock(path: Path, name: str, count: int, read: Callable[[int, int], FloatArray]) -> SampleClock:
    """Return the clock of a column of times, which must be uniform but for a few holes.

    The rate is the number of steps over the whole time, rounded to nine digits because printed times are
    rounded too.

    Parameters
    ----------
    path, name
        File and column, for messages.
    count
        Number of times.
    read
        Gives the times [start, stop) [s].

    Raises
    ------
    RecordingError
        If there are fewer than two times, or steps are not the others' at more places than a logger loses data at;
        the message names the row.
    """
    if count < 2:
        raise RecordingError(f"{path}, {name}: expected at least 2 rows of times, found {count}.")
    first, last = float(read(0, 1)[0]), float(read(count - 1, count)[0])
    steps = np.diff(read(0, min(count, 1001)))
    steps = steps[np.isfinite(steps)]
    step = float(np.median(steps)) if steps.size else np.nan
    if not step > 0.0:
        raise RecordingError(f"{path}, {name}: expected ascending times, found a step of {step:g} s.")
    holes = _holes(path, name, count, read, step)
    # when each stretch would begin on the clock, were nothing missing and no jump
    rows = np.array([0, *(hole.row for hole in holes)])
    missing = np.cumsum([0, *(hole.missing for hole in holes)])
    jumped = np.cumsum([0.0, *(hole.jump_s for hole in holes)])
    mean_step = (last - float(jumped[-1]) - first) / (count - 1 + int(missing[-1]))
    for start in range(0, count, _BLOCK):
        stop = min(start + _BLOCK, count)
        row = np.arange(start, stop)
        stretch = np.searchsorted(rows, row, side="right") - 1 if holes else np.zeros(row.size, dtype=np.intp)
        off = np.abs(read(start, stop) - jumped[stretch] - (first + mean_step * (row + missing[stretch])))
        worst = int(np.argmax(off))
        if off[worst] > _STEP_TOLERANCE * mean_step:
            raise RecordingError(
                f"{path}, {name}: expected a uniform clock, found row {start + worst + 1} off by {off[worst]:g} s; "
                "the sample rate changes within the file."
            )
    return SampleClock(rate_hz=float(f"{1.0 / mean_step:.9g}"), start_s=first, holes=holes)


def _holes(path: Path, name: str, count: int, read: Callable[[int, int], FloatArray], step: float) -> tuple[Hole, ...]:
    """Return the places where a step is not the others'.

    Raises
    ------
    RecordingError
        If there are too many of them, a time is not a number, or more is missing than there is.
    """
    rows, jumps = _odd_steps(count, read, step)
    if rows.size == 0:
        return ()
    if rows.size > _MOST_HOLES + _MOST_HOLES_SHARE * count or not np.all(np.isfinite(jumps)):
        raise _not_uniform(path, name, step, float(jumps[0]), int(rows[0]))
    edges = np.array([0, *rows.tolist(), count])
    longest = int(np.argmax(np.diff(edges)))
    begin, end = int(edges[longest]), int(edges[longest + 1])
    ends_s = [float(read(row, row + 1)[0]) for row in (begin, end - 1)]
    # the longest stretch knows the step better than one step does
    exact = (ends_s[1] - ends_s[0]) / (end - 1 - begin) if end - begin > 2 else step
    jitter = float(np.max(np.abs(np.diff(read(begin, min(begin + 1001, end))) - exact), initial=0.0))
    holes = []
    for row, jump in zip(rows.tolist(), jumps.tolist(), strict=True):
        places = max(round(jump / exact), 1)
        remainder = jump - places * exact
        allowed = _WHOLE * exact + jitter * (2.0 + places / (end - begin))
        holes.append(Hole(row=row, missing=places - 1, jump_s=0.0 if abs(remainder) <= allowed else remainder))
    if sum(hole.missing for hole in holes) > count:
        raise _not_uniform(path, name, step, float(jumps[np.argmax(jumps)]), int(rows[np.argmax(jumps)]))
    return tuple(holes)


def _odd_steps(count: int, read: Callable[[int, int], FloatArray], step: float) -> tuple[IntArray, FloatArray]:
    """Return the rows before which a step is not the others', and those steps [s]."""
    rows, jumps = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for start in range(0, count - 1, _BLOCK):
        steps = np.diff(read(start, min(start + _BLOCK + 1, count)))
        # written so that a time that is not a number counts as wrong
        wrong = np.flatnonzero(~(np.abs(steps - step) <= _STEP_TOLERANCE * step))
        rows.append(start + wrong + 1)
        jumps.append(steps[wrong])
    return np.concatenate(rows), np.concatenate(jumps)


def _not_uniform(path: Path, name: str, step: float, jump: float, row: int) -> RecordingError:
    return RecordingError(
        f"{path}, {name}: expected a step of {step:g} s, found {jump:g} s before row {row + 1}; "
        "resample the file or cut it there."
    )
