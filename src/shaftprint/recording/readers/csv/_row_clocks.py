"""When the rows of a text file were taken: by a column of times, by several, or at a rate."""

from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.arrays import IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Times
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock, printed_step
from shaftprint.recording.readers._coarse_stamps import clock_of_stamps
from shaftprint.recording.readers._gather import names_in_words
from shaftprint.recording.readers._hints import OF_HINT, expect_one_rate
from shaftprint.recording.readers._time_scale import TimeScale, time_scale
from shaftprint.recording.readers._units import seconds_in
from shaftprint.recording.readers.csv._filled_rows import (
    clock_of_rows,
    may_have_own_rows,
    only,
    own_rows,
    rows_with_values,
)
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._rows import Unpacked
from shaftprint.recording.readers.csv._validity import without

# when clocks are changed for summer time
_HOUR_S, _SUNDAY, _BEFORE = 3600.0, 6, 4
# printed times are rounded
_RATE_AGREEMENT = 1e-3
# programs round the rate that they write above the rows
_STATED_AGREEMENT = 0.02
# How far the clock of a computer and that of a sampler may be apart without a word, and how many times are looked at.
_CLOCKS, _TIMES = 3e-4, 1000
# A stamp to the second that so many rows have tells their rate, where the caller does not.
_STAMPS = 5_000


@dataclass(frozen=True, kw_only=True, slots=True)
class _Rows:
    """When the rows of some columns were taken."""

    clock: SampleClock
    """Their clock."""
    count: int
    """How many there are."""


def scale_of_rows(path: Path, header: Header, spool: Spool, count: int, asked: str) -> TimeScale:
    """Return what the numbers of the first column of times mean; dates are seconds already.

    ``count``: number of rows. ``asked``: unit that the caller gives. Raises RecordingError if neither file nor caller
    gives one, and the numbers may be in several.
    """
    if header.time_column is None or header.time_unit is None:
        return TimeScale()
    unit = header.time_unit or _unit_by_rate(header, spool.source(header.time_column), count)
    scale = _scale(path, header, spool, header.time_column, unit, count, asked)
    if header.time_unit or asked or unit in ("", "s"):
        return scale
    name = header.names[header.time_column]
    remark = f"column {name}: its unit is {unit} by the rate of {header.stated_rate_hz:g} Hz above the rows."
    return replace(scale, remark=remark)


def _unit_by_rate(header: Header, read: Times, count: int) -> str:
    """Return the unit in which times step as the rate above them says; empty where none is, or there is no rate."""
    if header.stated_rate_hz is None:
        return ""
    step = float(np.median(np.diff(read(0, min(count, _STAMPS))))) if count > 1 else 0.0
    units = ("s", "ms", "us", "ns", "min")
    stepped = ((unit, step * (seconds_in(unit) or 0.0) * header.stated_rate_hz) for unit in units)
    return next((unit for unit, steps in stepped if abs(steps - 1.0) <= _STATED_AGREEMENT), "")


def sampled(
    path: Path,
    header: Header,
    spool: Spool,
    done: Unpacked,
    rate_hz: float | None,
    scale: TimeScale,
    asked: str,
    left_out: dict[str, str],
) -> tuple[dict[str, Channel], list[str]]:
    """Return the columns as channels with one row a sample, and what has to be said of their clocks.

    Columns behind a further column of times are placed by that, and those with a value in some of the rows only by the
    times of these. ``scale``: what the first times mean. ``left_out``:
    takes columns whose own times are those of no clock. Raises RecordingError if the first times are.
    """
    read = None if header.time_column is None else scale.reading(spool.source(header.time_column))
    count = done.count
    if header.more_times and header.time_column is not None:
        count = _filled(spool, header.time_column, count)
    first, remark = _rows(path, header, read, done, count, rate_hz)
    events = None if read is None or header.more_times else _without_events(path, header, spool, done, first, read)
    if events is not None:
        first, valued = events
        remark = f"Rows without a value, at times of no sample, were left out: {count - valued.size}."
    own, others, on_own_rows, channels = first, list[str](), list[str](), {}
    for number, (name, unit) in enumerate(zip(header.names, header.units, strict=True)):
        if number == header.time_column or name in done.left_out:
            continue
        further = _further(path, header, spool, done.count, number, scale, asked)
        if further is not None:
            own = further
            others += [name] if own != first else []
            continue
        source, rows = without(spool.source(number), done.invalid.get(name)), own
        if events is not None:
            source = only(source, valued)
        elif own is first and read is not None and may_have_own_rows(done.filled[name], count):
            is_uneven = isinstance(first, RecordingError) or first.clock.is_uneven
            filled = own_rows(source, count, is_uneven=is_uneven)
            clock = None if filled is None else clock_of_rows(path, name, filled, read)
            if filled is not None and isinstance(clock, SampleClock):
                source, rows = only(source, filled), _Rows(clock=clock, count=filled.size)
                on_own_rows.append(name)
        if isinstance(rows, RecordingError):
            left_out[name] = str(rows).removeprefix(f"{path}, ")
        else:
            channel = Channel(
                name=name,
                unit=unit,
                rate_hz=rows.clock.rate_hz,
                start_s=rows.clock.start_s,
                count=rows.count,
                source=source,
            )
            channels[name] = on_clock(channel, rows.clock)
    if isinstance(first, RecordingError) and not channels:
        raise first
    by_others = f"Columns behind {names_in_words(others)} were placed by those times." if others else ""
    by_rows = (
        f"{names_in_words(on_own_rows)}: values in some of the rows only, whose times are theirs."
        if on_own_rows
        else ""
    )
    return channels, [remark, by_others, by_rows]


def _without_events(
    path: Path, header: Header, spool: Spool, done: Unpacked, first: _Rows | RecordingError, read: Times
) -> tuple[_Rows, IntArray] | None:
    """Return rows and places of those with a value, where the others, as of a logger's events, are off their clock."""
    columns = [
        column
        for column, name in enumerate(header.names)
        if column != header.time_column and name not in done.left_out and done.filled[name]
    ]
    if not columns or any(done.filled[header.names[column]] == done.count for column in columns):
        return None
    rows = rows_with_values([spool.source(column) for column in columns], done.count)
    clock = None if rows.size == done.count else clock_of_rows(path, header.names[header.time_column or 0], rows, read)
    if not isinstance(clock, SampleClock) or clock.is_uneven:
        return None
    if isinstance(first, _Rows) and not first.clock.is_uneven and len(first.clock.holes) <= len(clock.holes):
        return None
    return _Rows(clock=clock, count=rows.size), rows


def _rows(
    path: Path, header: Header, read: Times | None, done: Unpacked, count: int, rate_hz: float | None
) -> tuple[_Rows | RecordingError, str]:
    """Return the first rows, or why they have no clock where each may be of one column alone; and what has to be said.

    Raises RecordingError if rows that all columns share have no clock.
    """
    try:
        clock, remark = _clock(path, header, read, done, count, rate_hz)
    except RecordingError as error:
        if read is None or not any(may_have_own_rows(filled, count) for filled in done.filled.values()):
            raise
        return error, ""
    return _Rows(clock=clock, count=count), remark


def _further(
    path: Path, header: Header, spool: Spool, count: int, number: int, first: TimeScale, asked: str
) -> _Rows | RecordingError | None:
    """Return the rows of a further column of times, or why they have no clock; nothing where it is a channel."""
    units = dict(header.more_times)
    if number not in units:
        return None
    unit = units[number]
    try:
        filled = _filled(spool, number, count)
        if unit is None:
            clock = clock_of_times(path, f"column {header.names[number]}", filled, spool.source(number))
            return _Rows(clock=clock, count=filled)
        scale = _scale(path, header, spool, number, unit, filled, asked)
        if bool(scale.since_1970_s) != bool(first.since_1970_s):
            # the same times by another clock
            return None
        read = scale.reading(spool.source(number))
        clock = clock_of_times(path, f"column {header.names[number]}", filled, read)
    except RecordingError as error:
        return error
    later_s = scale.zero - first.zero if scale.is_of_day else scale.since_1970_s - first.since_1970_s
    return _Rows(clock=clock.later_by(later_s), count=filled)


def _filled(spool: Spool, number: int, count: int) -> int:
    """Return how many rows there are to the last one with a time: shorter columns end in empty fields."""
    with_time = np.flatnonzero(np.isfinite(spool.source(number)(0, count)))
    return int(with_time[-1]) + 1 if with_time.size else 0


def _scale(path: Path, header: Header, spool: Spool, number: int, unit: str, count: int, asked: str) -> TimeScale:
    name = f"column {header.names[number]}"
    return time_scale(path, name, count, spool.source(number), unit=unit, asked=asked)


def _clock(
    path: Path, header: Header, read: Times | None, done: Unpacked, count: int, rate_hz: float | None
) -> tuple[SampleClock, str]:
    """Return the clock of the times, or that of the rate which the caller knows, and what has to be said of it."""
    if header.time_column is None or read is None:
        return SampleClock(rate_hz=cast(float, rate_hz), start_s=header.start_s), ""
    name = f"column {header.names[header.time_column]}"
    stated_hz = header.stated_rate_hz
    clock, stamps = clock_of_stamps(
        path, name, count, read, rate_hz=rate_hz, stated_hz=stated_hz if header.dated else None, joins_doubled=True
    )
    if stamps is not None:
        lost = "; where they step further, rows are missing" if clock.holes else ""
        each = f"{round(stamps.rows, 1):g} rows have each stamp"
        return clock, f"{name}: {each}; the rows are placed by the rate of {clock.rate_hz:g} Hz{lost}."
    if rate_hz is not None:
        expect_one_rate(path, {name: clock.rate_hz, OF_HINT: rate_hz}, _RATE_AGREEMENT)
    if stated_hz and rate_hz is None and abs(clock.rate_hz / stated_hz - 1.0) > _allowed(header, clock, read, count):
        return clock, f"{name}: a rate of {clock.rate_hz:.6g} Hz, which counts; the lines above say {stated_hz:.6g} Hz."
    doubled = sum(hole.missing < 0 for hole in clock.holes)
    if doubled:
        return clock, f"{name}: {doubled} rows have the time of the row before, as at events, and count in its place."
    return clock, _change_of_hour(name, clock, read, done)


def _allowed(header: Header, clock: SampleClock, read: Times, count: int) -> float:
    """Return how far the rate of the times and the stated one may be apart without a word, by how both are printed."""
    some = read(0, min(count, _TIMES))
    return _CLOCKS + header.stated_rounded + printed_step(some) * clock.rate_hz / count


def _change_of_hour(name: str, clock: SampleClock, read: Times, done: Unpacked) -> str:
    """Return what has to be said where dates without an offset jump by an hour as clocks do in spring and autumn."""
    began = None if done.stamps is None else done.stamps.began
    for hole in clock.holes:
        off_s = hole.missing / clock.rate_hz + hole.jump_s
        if began is None or began.tzinfo is not None or abs(abs(off_s) - _HOUR_S) > 2.0 / clock.rate_hz:
            continue
        at = began + timedelta(seconds=float(read(hole.row - 1, hole.row)[0]))
        if at.weekday() == _SUNDAY and at.hour < _BEFORE:
            return (
                f"{name}: the times jump by an hour behind {at.isoformat(sep=' ', timespec='seconds')}, as clocks do "
                "that change to or from summer time; write them in UTC or with their offset."
            )
    return ""
