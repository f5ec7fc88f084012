"""When the rows of a text file were taken: by a column of times, by several, or at a rate."""

from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import cast

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Times
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._time_scale import TimeScale, time_scale
from shaftprint.recording.readers.csv._header import Header
from shaftprint.recording.readers.csv._rows import Unpacked

# when clocks are changed for summer time
_HOUR_S, _SUNDAY, _BEFORE = 3600.0, 6, 4
# printed times are rounded
_RATE_AGREEMENT = 1e-3
# A stamp to the second that so many rows have tells their rate, where the caller does not.
_STAMPS = 5_000
_SHOWN = 5


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
    return _scale(path, header, spool, header.time_column, header.time_unit, count, asked)


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

    Columns behind a further column of times are placed by that. ``scale``: what the first times mean. ``left_out``:
    takes columns whose own times are those of no clock. Raises RecordingError if the first times are.
    """
    read = None if header.time_column is None else scale.reading(spool.source(header.time_column))
    count = done.count
    if header.more_times and header.time_column is not None:
        count = _filled(spool, header.time_column, count)
    clock, remark = _clock(path, header, read, done, count, rate_hz)
    first: _Rows | RecordingError = _Rows(clock=clock, count=count)
    own, others, channels = first, [], {}
    for number, (name, unit) in enumerate(zip(header.names, header.units, strict=True)):
        if number == header.time_column or name in done.left_out:
            continue
        further = _further(path, header, spool, done.count, number, scale, asked)
        if further is not None:
            own = further
            others += [name] if own != first else []
        elif isinstance(own, RecordingError):
            left_out[name] = str(own).removeprefix(f"{path}, ")
        else:
            channel = Channel(
                name=name,
                unit=unit,
                rate_hz=own.clock.rate_hz,
                start_s=own.clock.start_s,
                count=own.count,
                source=spool.source(number),
            )
            channels[name] = on_clock(channel, own.clock)
    more = f" and {len(others) - _SHOWN} more" if len(others) > _SHOWN else ""
    by_others = f"Columns behind {', '.join(others[:_SHOWN])}{more} were placed by those times." if others else ""
    return channels, [remark, by_others]


def _further(
    path: Path, header: Header, spool: Spool, count: int, number: int, first: TimeScale, asked: str
) -> _Rows | RecordingError | None:
    """Return the rows of a further column of times, or why they have no clock; nothing where it is a channel."""
    unit = dict(header.more_times).get(number)
    if unit is None:
        return None
    try:
        filled = _filled(spool, number, count)
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
    rows = _rows_of_a_stamp(read, done.count) if header.dated else 1
    if rows > 1 and rate_hz is None:
        raise RecordingError(
            f"{path}, {name}: expected times of the rows, found about {rows} rows with each stamp; pass their rate, "
            f"sample_rate_hz= (--sample-rate {rows})."
        )
    if rows > 1:
        remark = f"{name}: {rows} rows have each stamp; the rows are placed by the rate of {rate_hz:g} Hz."
        return SampleClock(rate_hz=cast(float, rate_hz), start_s=0.0), remark
    clock = clock_of_times(path, name, count, read)
    if rate_hz is not None and abs(clock.rate_hz / rate_hz - 1.0) > _RATE_AGREEMENT:
        raise RecordingError(
            f"{path}: expected one sample rate, found {clock.rate_hz:g} Hz in {name} and {rate_hz:g} Hz in the hint."
        )
    return clock, _change_of_hour(name, clock, read, done)


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


def _rows_of_a_stamp(read: Times, count: int) -> int:
    """Return how many rows have one stamp, in most places."""
    seconds = read(0, min(count, _STAMPS))
    changes = np.flatnonzero(np.diff(seconds))
    if 2 * changes.size > seconds.size or changes.size < 2:
        return 1
    return int(np.median(np.diff(changes)))
