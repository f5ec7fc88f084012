"""Finding one uniform clock in a column of times, with holes or jumps in it, or the period of who sends as it likes."""

from collections.abc import Callable, Hashable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Self, TypeVar

import numpy as np

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, ClockJump, Times
from shaftprint.recording.readers._epoch import LATER_THAN_ANY_TEST_S
from shaftprint.recording.readers._steady_step import without_stray_ends

_BLOCK = 1_000_000
_Key = TypeVar("_Key", bound=Hashable)

# Times are printed with few decimals: a step may be off by this part of the mean step, as may be the place
# of a sample on the uniform grid. A sample that is missing or doubled is off by a whole step.
_STEP_TOLERANCE = 0.5

# A logger that lost data did so at a few places; times that jump more often are those of messages.
_MOST_HOLES, _MOST_HOLES_SHARE = 3, 1e-3
# What is between two pauses longer than all samples; fewer rows are times that are wrong.
_FEWEST_OF_A_PART = 10
# A hole is whole samples long to this part of a step, where times are printed exactly.
_WHOLE = 0.02

# Times that are off the clock by more than this part of a step, and by more than their printing explains, are kept,
# unless they come faster than any sender's: the stamps of a logger's own samples say less than its clock.
_JITTER, _BY_PRINTING, _FASTEST_SENDER_HZ = 0.02, 1.5, 200.0
_MOST_DECIMALS, _PRINTED = 6, 1e-3
# A spreadsheet shows, and saves, so many digits of a number: -2.50E-02 is all that is left of -0.024975.
_FEWEST_DIGITS, _MOST_DIGITS, _LONGEST_ROUNDED, _RATE_DIGITS = 3, 6, 10_000_000, 6
# With fewer times a sender is not known; of one, most steps are near its period.
_FEWEST_MESSAGES, _MOST_NEAR = 100, 0.5
# Where more than this part of them are equal, the others are none of the sender's.
_MOST_SAME = 0.95


@dataclass(frozen=True, kw_only=True, slots=True)
class Hole:
    """A place where the times of a file do not go on by one step."""

    row: int
    """First row after it, counted from 0."""
    missing: int
    """Samples that are missing before that row; -1 where it has the time of the row before, whose place it takes."""
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
    stamps: Times | None = None
    """Gives the times of the rows [start, stop) [s], where they say more than the rate."""
    is_uneven: bool = False
    """Whether the times are those of messages, which lie on no clock; the rate is then that of their sender."""

    def later_by(self, seconds: float) -> Self:
        """Return the same clock with all times later by some seconds."""
        stamps = self.stamps
        return replace(
            self,
            start_s=seconds + self.start_s,
            stamps=None if stamps is None else lambda start, stop: seconds + stamps(start, stop),
        )


def kept_clocks(find: Callable[[_Key], SampleClock]) -> Callable[[_Key], SampleClock]:
    """Return what finds the clock that channels share once for all of them, or once why there is none.

    ``find``: gives the clock of a group of channels, or raises a ``RecordingError``.
    """
    clocks: dict[_Key, SampleClock | RecordingError] = {}

    def clock_of(key: _Key) -> SampleClock:
        if key not in clocks:
            try:
                clocks[key] = find(key)
            except RecordingError as error:
                clocks[key] = error
        clock = clocks[key]
        if isinstance(clock, RecordingError):
            raise clock
        return clock

    return clock_of


def on_clock(channel: Channel, clock: SampleClock) -> Channel:
    """Return a channel with its rows at their places on the clock: values that are not numbers fill the holes."""
    if not clock.holes:
        return replace(channel, stamps=clock.stamps, is_uneven=clock.is_uneven)
    rows = np.array([0, *(hole.row for hole in clock.holes), channel.count])
    before = np.cumsum([0, *(hole.missing for hole in clock.holes)])

    def spread(of_rows: Times, start: int, stop: int) -> FloatArray:
        values = np.full(stop - start, np.nan)
        for first, last, shift in zip(rows[:-1].tolist(), rows[1:].tolist(), before.tolist(), strict=True):
            begin, end = max(start - shift, first), min(stop - shift, last)
            if begin < end:
                values[begin + shift - start : end + shift - start] = of_rows(begin, end)
        return values

    stamps = clock.stamps
    jumps = tuple(
        ClockJump(sample=hole.row + int(shift), jump_s=hole.jump_s)
        for hole, shift in zip(clock.holes, before[1:], strict=True)
        if hole.jump_s != 0.0
    )
    count = channel.count + int(before[-1])
    return replace(
        channel,
        count=count,
        source=partial(spread, channel.values),
        scale=1.0,
        offset=0.0,
        clock_jumps=jumps,
        stamps=None if stamps is None else partial(spread, stamps),
    )


def clock_of_times(path: Path, name: str, count: int, read: Times, *, joins_doubled: bool = False) -> SampleClock:
    """Return the clock of a column of times, or the times themselves where they are those of messages.

    A bus, a network or a program that polls passes values on about when their sender likes. Where such times stay
    within half a step of a clock, the clock is returned with the times beside it; where they do not, the times with
    the period of their sender, the mean of the steps that are near the median.

    ``path``, ``name``, ``count``, ``read``: as for `uniform_clock`. ``joins_doubled``: whether of two rows of one time,
    as simulation tools write them at events, the later counts; else the clock is set back there. Raises RecordingError
    if the times are neither those of a clock nor those of messages: they go back, or have no usual step.
    """
    try:
        clock, off_s = _uniform_clock(path, name, count, read, joins_doubled=joins_doubled)
    except RecordingError:
        other = _rounded_clock(count, read) or _message_clock(count, read)
        if other is None:
            raise
        return other
    if clock.rate_hz > _FASTEST_SENDER_HZ or off_s <= _JITTER / clock.rate_hz:
        return clock
    printed_s = _BY_PRINTING * printed_step(read(0, min(count, 1000))) / np.sqrt(12.0)
    return replace(clock, stamps=read) if off_s > printed_s else clock


def _rounded_clock(count: int, read: Times) -> SampleClock | None:
    """Return the clock of times of which a few digits are left, so that some are the same; nothing of others.

    Each has to lie on the clock within half of its own last digit, those near zero most closely. Of the rates at which
    all do, the one with the fewest digits is taken.
    """
    if not _FEWEST_MESSAGES <= count <= _LONGEST_ROUNDED:
        return None
    times = read(0, count)
    if not (np.all(np.isfinite(times)) and np.all(np.diff(times) >= 0.0) and times[0] < times[-1]):
        return None
    size = np.abs(times)
    size[size == 0.0] = np.min(size[size > 0.0])
    for digits in range(_FEWEST_DIGITS, _MOST_DIGITS + 1):
        last = 10.0 ** (np.floor(np.log10(size) + 1e-9) + 1 - digits)
        if np.all(np.abs(times / last - np.rint(times / last)) < _PRINTED):
            return _clock_within(times, (0.5 + _WHOLE) * last)
    return None


def _clock_within(times: FloatArray, off_s: FloatArray) -> SampleClock | None:
    """Return the clock from which each time is off by no more than stated; nothing where there is none."""
    rows = np.arange(times.size, dtype=np.float64)
    rate_hz = 1.0 / float(np.polyfit(rows, times, 1, w=1.0 / off_s)[0])
    for digits in range(1, _RATE_DIGITS + 1):
        rounded_hz = float(f"{rate_hz:.{digits}g}")
        starts = times - rows / rounded_hz
        earliest, latest = float(np.max(starts - off_s)), float(np.min(starts + off_s))
        if earliest <= latest:
            return SampleClock(rate_hz=rounded_hz, start_s=0.5 * (earliest + latest))
    return None


def _message_clock(count: int, read: Times) -> SampleClock | None:
    """Return what is known of times that lie on no clock; nothing where they are no messages of one sender."""
    if count < _FEWEST_MESSAGES:
        return None
    step = float(np.median(np.diff(read(0, min(count, _BLOCK)))))
    if not step > 0.0:
        return None
    near, seconds, same, same_s = 0, 0.0, 0, 0.0
    for start in range(0, count - 1, _BLOCK):
        steps = np.diff(read(start, min(start + _BLOCK + 1, count)))
        # written so that a time that is not a number counts as wrong
        if not np.all(steps >= 0.0):
            return None
        usual, equal = (np.abs(steps - step) <= share * step for share in (_STEP_TOLERANCE, _WHOLE))
        near, seconds = near + int(np.count_nonzero(usual)), seconds + float(steps[usual].sum())
        same, same_s = same + int(np.count_nonzero(equal)), same_s + float(steps[equal].sum())
    first, last = float(read(0, 1)[0]), float(read(count - 1, count)[0])
    if near < _MOST_NEAR * (count - 1) or (last - first) * near > 2.0 * count * seconds:
        return None
    if same > _MOST_SAME * near:
        # a row that was put between two others says nothing of the period
        near, seconds = same, same_s
    return SampleClock(rate_hz=float(f"{near / seconds:.6g}"), start_s=first, stamps=read, is_uneven=True)


def rows_between_cuts(count: int, read: Times) -> tuple[int, int]:
    """Return the first row on the clock, and the one behind the last: programs that cut a file make a row at each end.

    ``count``, ``read``: as for `uniform_clock`.
    """
    if count < _FEWEST_OF_A_PART:
        return 0, count
    begin, end = np.diff(read(0, min(count, 1001))), np.diff(read(max(count - 1001, 0), count))
    step = float(np.median(begin))
    is_off = [
        bool(0.0 < odd < (1.0 - _WHOLE) * step and np.all(np.abs(others - step) <= _WHOLE * step))
        for odd, others in ((begin[0], begin[1:-1]), (end[-1], end[1:-1]))
    ]
    return int(is_off[0]), count - is_off[1]


def printed_step(times: FloatArray) -> float:
    """Return the last decimal with which times are printed [s]; 0 where they have more than six."""
    for decimals in range(_MOST_DECIMALS + 1):
        places = times * 10.0**decimals
        if np.all(np.abs(places - np.rint(places)) < _PRINTED):
            return 10.0**-decimals
    return 0.0


def uniform_clock(path: Path, name: str, count: int, read: Times) -> SampleClock:
    """Return the clock of a column of times, which must be uniform but for a few holes.

    The rate is the number of steps over the whole time, rounded to nine digits because printed times are
    rounded too. Where the first time or the last is a stray, the others give it.

    ``path``, ``name``: file and column, for messages. ``count``: number of times. ``read``: gives the times [start,
    stop) [s]. Raises RecordingError if there are fewer than two times, or steps are not the others' at more places than
    a logger loses data at; the message names the row.
    """
    clock, _ = _uniform_clock(path, name, count, read)
    return clock


def _uniform_clock(
    path: Path, name: str, count: int, read: Times, *, joins_doubled: bool = False
) -> tuple[SampleClock, float]:
    """Return the clock, and the standard deviation of the times about it [s]."""
    if count < 2:
        raise RecordingError(f"{path}, {name}: expected at least 2 rows of times, found {count}.")
    first, last = float(read(0, 1)[0]), float(read(count - 1, count)[0])
    steps = np.diff(read(0, min(count, 1001)))
    steps = steps[np.isfinite(steps)]
    step = float(np.median(steps)) if steps.size else np.nan
    if not step > 0.0:
        forward = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 0.0
        raise _anew(path, name, np.flatnonzero(steps < 0.0) + 1, read, forward) or RecordingError(
            f"{path}, {name}: expected ascending times, found a step of {step:g} s."
        )
    holes = _holes(path, name, count, read, step, joins_doubled=joins_doubled)
    # when each stretch would begin on the clock, were nothing missing and no jump
    rows = np.array([0, *(hole.row for hole in holes)])
    missing = np.cumsum([0, *(hole.missing for hole in holes)])
    jumped = np.cumsum([0.0, *(hole.jump_s for hole in holes)])
    mean_step = (last - float(jumped[-1]) - first) / (count - 1 + int(missing[-1]))

    def even(start: int, stop: int) -> tuple[FloatArray, FloatArray]:
        """Return the places of rows on the clock, and their times without jumps."""
        places, times = np.arange(start, stop, dtype=np.float64), read(start, stop)
        if not holes:
            return places, times
        stretch = np.searchsorted(rows, places, side="right") - 1
        return places + missing[stretch], times - jumped[stretch]

    first, mean_step = without_stray_ends(count, even, first, mean_step)
    squares = total = 0.0
    for start in range(0, count, _BLOCK):
        places, away = even(start, min(start + _BLOCK, count))
        away = away - (first + mean_step * places)
        squares, total = squares + float(away @ away), total + float(away.sum())
        off = np.abs(away)
        worst = int(np.argmax(off))
        if off[worst] > _STEP_TOLERANCE * mean_step:
            raise RecordingError(
                f"{path}, {name}: expected a uniform clock, found row {start + worst + 1} off by {off[worst]:g} s; "
                "the sample rate changes within the file."
            )
    clock = SampleClock(rate_hz=float(f"{1.0 / mean_step:.9g}"), start_s=first, holes=holes)
    return clock, float(np.sqrt(max(squares / count - (total / count) ** 2, 0.0)))


def _holes(path: Path, name: str, count: int, read: Times, step: float, *, joins_doubled: bool) -> tuple[Hole, ...]:
    """Return the places where a step is not the others'.

    Raises RecordingError if there are too many of them, a time is not a number, or more is missing than there is.
    """
    rows, jumps = _odd_steps(count, read, step)
    if rows.size == 0:
        return ()
    if rows.size > _MOST_HOLES + _MOST_HOLES_SHARE * count or not np.all(np.isfinite(jumps)):
        # a time that is missing or goes back is the cause, a step that is a little long is not
        if blocks := _anew(path, name, rows[jumps < 0.0], read, step):
            raise blocks
        worst = int(np.argmax(np.where(np.isfinite(jumps), jumps < 0.0, 2)))
        raise _not_uniform(path, name, step, float(jumps[worst]), int(rows[worst]))
    edges = np.array([0, *rows.tolist(), count])
    longest = int(np.argmax(np.diff(edges)))
    begin, end = int(edges[longest]), int(edges[longest + 1])
    ends_s = [float(read(row, row + 1)[0]) for row in (begin, end - 1)]
    # the longest stretch knows the step better than one step does
    exact = (ends_s[1] - ends_s[0]) / (end - 1 - begin) if end - begin > 2 else step
    jitter = float(np.max(np.abs(np.diff(read(begin, min(begin + 1001, end))) - exact), initial=0.0))
    holes = []
    for row, jump in zip(rows.tolist(), jumps.tolist(), strict=True):
        places = max(round(jump / exact), 0 if joins_doubled and jump == 0.0 else 1)
        remainder = jump - places * exact
        allowed = _WHOLE * exact + jitter * (2.0 + places / (end - begin))
        holes.append(Hole(row=row, missing=places - 1, jump_s=0.0 if abs(remainder) <= allowed else remainder))
    missing = sum(hole.missing for hole in holes)
    is_pause = bool(np.diff(edges).min() >= _FEWEST_OF_A_PART) and missing * exact <= LATER_THAN_ANY_TEST_S
    if missing > count and not is_pause:
        raise _not_uniform(path, name, step, float(jumps[np.argmax(jumps)]), int(rows[np.argmax(jumps)]))
    if missing > count:
        # a pause longer than all samples is no place of lost data: the clock goes on later
        return tuple(Hole(row=hole.row, missing=0, jump_s=hole.jump_s + hole.missing * exact) for hole in holes)
    return tuple(holes)


def _odd_steps(count: int, read: Times, step: float) -> tuple[IntArray, FloatArray]:
    """Return the rows before which a step is not the others', and those steps [s]."""
    rows, jumps = [np.empty(0, dtype=np.int64)], [np.empty(0)]
    for start in range(0, count - 1, _BLOCK):
        steps = np.diff(read(start, min(start + _BLOCK + 1, count)))
        # written so that a time that is not a number counts as wrong
        wrong = np.flatnonzero(~(np.abs(steps - step) <= _STEP_TOLERANCE * step))
        rows.append(start + wrong + 1)
        jumps.append(steps[wrong])
    return np.concatenate(rows), np.concatenate(jumps)


def _anew(path: Path, name: str, rows: IntArray, read: Times, step: float) -> RecordingError | None:
    """Return that times begin again at several rows, as where a loop writes blocks; None where they do not.

    ``rows``: before which the times go back.
    """
    begin = float(read(0, 1)[0])
    if rows.size <= _MOST_HOLES or any(
        abs(float(read(row, row + 1)[0]) - begin) > step for row in rows[:1000].tolist()
    ):
        return None
    return RecordingError(
        f"{path}, {name}: expected ascending times, found that they begin again in {rows.size} rows, first before row "
        f"{int(rows[0]) + 1}. Where a loop writes blocks of rows, when each came is not in the file: let it write "
        "times that go on, or dates. Where a logger was started anew, cut the file there."
    )


def _not_uniform(path: Path, name: str, step: float, jump: float, row: int) -> RecordingError:
    if not np.isfinite(jump):
        return RecordingError(
            f"{path}, {name}: expected a time in each row, found none in row {row + 1}; leave out rows without a time."
        )
    if jump < 0.0:
        return RecordingError(
            f"{path}, {name}: expected ascending times, found one that goes back by {-jump:g} s before row {row + 1}, "
            "as where a logger begins again; cut the file there."
        )
    return RecordingError(
        f"{path}, {name}: expected a step of {step:g} s, found {jump:g} s before row {row + 1}; "
        "resample the file or cut it there."
    )
