"""Rows that come faster than their times are printed, so that several have one stamp: their rate, and what is lost."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Times
from shaftprint.recording.readers._clock import Hole, SampleClock, clock_of_times
from shaftprint.recording.readers._printed_rate import roundest_rate

_BLOCK = 1_000_000
# With so many rows on one stamp it is coarse; with fewer where all stamps follow each other at one step, to this part
# of it, and some are doubled without one that is left out for them, as a late message leaves one out.
_ROWS, _SAME_STEP, _SAME_SHARE, _DOUBLED, _LEFT_OUT = 1.5, 0.02, 0.95, 1e-3, 0.3
_FEWEST = 3
# A pause steps by more than this many usual steps.
_PAUSE = 1.5
# Steps whose rows are further from the others' than these are lost rows, or a clock that was set.
_ODD_ROWS, _ODD_SCATTERS = 1.5, 12.0
_MOST_ODD, _MOST_ODD_SHARE = 3, 1e-3
# The clock of a computer beside that of a sampler: how far they may be apart, and how far they usually are.
_CLOCKS, _USUAL_CLOCKS = 1e-3, 2e-4


@dataclass(frozen=True, kw_only=True, slots=True)
class CoarseStamps:
    """Stamps that several rows have each."""

    rows: float
    """Rows of one stamp, in the mean."""
    rate_hz: float
    """Rate that rows and stamps give, the roundest that their resolution allows [Hz]; not a number where there is no
    whole stamp."""
    counted: int
    """How many rows there are from the first change of the stamp to the last, without pauses."""
    span_s: float
    """How long that is by the stamps [s]."""
    scatter: float
    """By how many rows a stamp may be off."""
    odd: tuple[tuple[int, int, float], ...]
    """Pauses: the row behind, the rows of the stamp before, and by how much the stamp steps there [s]."""

    def allows(self, rate_hz: float) -> bool:
        """Return whether stamps and rows do not contradict a rate."""
        off = abs(rate_hz * self.span_s - self.counted)
        return not off > self.scatter + _CLOCKS * self.counted

    def holes(self, rate_hz: float, count: int) -> tuple[Hole, ...]:
        """Return where rows are missing or the clock was set, of ``count`` rows at a rate."""
        holes: list[Hole] = []
        place = 0
        while place < len(self.odd):
            row, rows, seconds = self.odd[place]
            first, lost = row, seconds * rate_hz - rows
            # what is lost between two stamps is seen on both sides; late rows come with the next stamp
            while place + 1 < len(self.odd) and self.odd[place + 1][0] - self.odd[place + 1][1] == row:
                place += 1
                row, rows, seconds = self.odd[place]
                lost += seconds * rate_hz - rows
            place += 1
            if lost > self.scatter:
                holes.append(Hole(row=first, missing=round(lost), jump_s=0.0))
            elif lost < -self.scatter:
                holes.append(Hole(row=first, missing=0, jump_s=lost / rate_hz))
        if sum(hole.missing for hole in holes) <= count:
            return tuple(holes)
        # a pause longer than all samples is no place of lost data: the clock goes on later
        return tuple(Hole(row=one.row, missing=0, jump_s=one.jump_s + one.missing / rate_hz) for one in holes)


def clock_of_stamps(
    path: Path,
    name: str,
    count: int,
    read: Times,
    *,
    rate_hz: float | None,
    stated_hz: float | None = None,
    joins_doubled: bool = False,
) -> tuple[SampleClock, CoarseStamps | None]:
    """Return the clock of a column of times, and the stamps where several rows have each: then the rate is needed.

    ``path``, ``name``, ``count``, ``read``, ``joins_doubled``: as for `clock_of_times`. ``rate_hz``: rate that is known
    [Hz]. ``stated_hz``: rate that is taken without it where the stamps allow it [Hz]. Raises RecordingError if the
    times are those of no clock, if stamps lack their rate, or contradict it.
    """
    try:
        clock = clock_of_times(path, name, count, read, joins_doubled=joins_doubled)
    except RecordingError:
        stamps = coarse_stamps(count, read)
        if stamps is None:
            raise
    else:
        stamps = coarse_stamps(count, read) if clock.is_uneven else None
        if stamps is None:
            return clock, None
    found = f"about {round(stamps.rows, 1):g} rows with each stamp"
    if rate_hz is None and stated_hz and stamps.allows(stated_hz):
        rate_hz = stated_hz
    if rate_hz is None:
        told = f" (--sample-rate {stamps.rate_hz:g})" if np.isfinite(stamps.rate_hz) else " (--sample-rate)"
        raise RecordingError(
            f"{path}, {name}: expected times of the rows, found {found}; pass their rate, sample_rate_hz={told}."
        )
    if not stamps.allows(rate_hz):
        raise RecordingError(
            f"{path}, {name}: expected a rate that its stamps allow, {stamps.rate_hz:g} Hz for {stamps.counted} rows "
            f"in {stamps.span_s:g} s, found {rate_hz:g} Hz (sample_rate_hz=, --sample-rate); pass that of the stamps."
        )
    start_s = float(read(0, 1)[0])
    return SampleClock(rate_hz=rate_hz, start_s=start_s, holes=stamps.holes(rate_hz, count)), stamps


def coarse_stamps(count: int, read: Times) -> CoarseStamps | None:
    """Return what stamps say that several rows have each; None where each row has a time of its own.

    ``count``, ``read``: as for `clock_of_times`.
    """
    if count < _FEWEST:
        return None
    times = read(0, min(count, _BLOCK))
    first = _Steps.of(0, times)
    if first.rows.size == 0:
        longest = max(int(np.count_nonzero(times == end)) for end in (times[0], times[-1]))
        return _without_span(longest) if 2 * longest >= times.size else None
    usual = float(np.median(first.rows))
    step_s = float(np.median(first.seconds))
    if not step_s > 0.0 or not np.all(np.isfinite(first.seconds)):
        return None
    plain = (first.seconds > 0.0) & (first.seconds <= _PAUSE * step_s)
    if usual < _ROWS:
        doubled = int(np.sum(first.rows)) - first.rows.size
        same = float(np.mean(np.abs(first.seconds - step_s) <= _SAME_STEP * step_s))
        is_of_messages = np.count_nonzero(~plain) > _LEFT_OUT * doubled
        if same < _SAME_SHARE or doubled < _DOUBLED * first.rows.size or is_of_messages:
            return None
    rate_hz = float(np.sum(first.rows[plain]) / np.sum(first.seconds[plain]))
    most = max(_ODD_ROWS, _ODD_SCATTERS * float(np.median(np.abs(first.off(rate_hz)))))
    return _found(count, read, rate_hz, most) or _found(count, read, rate_hz, np.inf)


def _without_span(rows: int) -> CoarseStamps:
    """Return stamps of which not one begins and ends within the file: any rate is allowed."""
    return CoarseStamps(rows=rows, rate_hz=np.nan, counted=0, span_s=np.nan, scatter=np.inf, odd=())


def _found(count: int, read: Times, rate_hz: float, most: float) -> CoarseStamps | None:
    """Return the stamps, steps that are off by more than so many rows apart; None where these are too many."""
    counted, changes, span_s, scatter = 0, 0, 0.0, 1.0
    odd: list[tuple[int, int, float]] = []
    for steps in _all_steps(count, read):
        off = np.abs(steps.off(rate_hz))
        # written so that a time that is not a number counts as wrong
        usual = off <= most
        counted += int(np.sum(steps.rows[usual]))
        span_s += float(np.sum(steps.seconds[usual]))
        scatter = max(scatter, float(np.max(off[usual], initial=0.0)))
        changes += off.size
        odd += steps.picked(~usual)
        if len(odd) > _MOST_ODD + _MOST_ODD_SHARE * changes + 1 and np.isfinite(most):
            return None
    if not span_s > 0.0:
        return None
    loose = min(scatter + _USUAL_CLOCKS * counted, 0.5 * counted)
    rate = roundest_rate((counted - loose) / span_s, (counted + loose) / span_s, counted / span_s)
    return CoarseStamps(
        rows=counted / max(changes - len(odd), 1),
        rate_hz=rate,
        counted=counted,
        span_s=round(span_s, 9),
        scatter=scatter,
        odd=tuple(odd),
    )


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class _Steps:
    """Steps from one stamp to the next, of whole stamps."""

    behind: IntArray
    """First row of the next stamp."""
    rows: IntArray
    """Rows of the stamp."""
    seconds: FloatArray
    """By how much the next is later [s]."""
    last_row: int
    """Row of the last change; -1 where there is none."""

    @classmethod
    def of(cls, start: int, times: FloatArray) -> "_Steps":
        """Return the steps of a piece that begins at row ``start``."""
        changes = 1 + np.flatnonzero(times[1:] != times[:-1])
        return cls(
            behind=start + changes[1:],
            rows=np.diff(changes),
            seconds=np.diff(times[changes]),
            last_row=start + int(changes[-1]) if changes.size else -1,
        )

    def off(self, rate_hz: float) -> FloatArray:
        """Return by how many rows the steps are longer than their rows."""
        return self.seconds * rate_hz - self.rows

    def picked(self, chosen: BoolArray) -> list[tuple[int, int, float]]:
        """Return some of them."""
        parts = (self.behind[chosen].tolist(), self.rows[chosen].tolist(), self.seconds[chosen].tolist())
        return list(zip(*parts, strict=True))


def _all_steps(count: int, read: Times) -> Iterator[_Steps]:
    """Yield the steps of a column, in pieces."""
    start = 0
    while start < count:
        stop = min(start + _BLOCK, count)
        steps = _Steps.of(start, read(start, stop))
        yield steps
        if stop == count:
            return
        # the next piece begins before the last change, so that its stamp is counted as a whole
        start = max(steps.last_row - 1, start + 1) if steps.last_row > start + 1 else stop - 1
