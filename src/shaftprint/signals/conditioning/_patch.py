"""Putting plausible values where samples cannot be true, as the blocks go by."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, runs_of
from shaftprint.signals._channels import Counts, time_of
from shaftprint.signals._gaps import Gap
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._outliers import GOOD, HOLD, MISSING, RAIL, FaultLimits

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# A telemetry that holds its value for longer, or stays at its rail, has lost it: a gap.
_LONGEST_RUN_S = 2.0
# So long a straight line is as good as the torque itself: a fifth of a period at 4 Hz, the fastest line of most tests.
_LONGEST_MISSING_S = 0.05

_REASONS = {HOLD: "stands still", RAIL: "stays at full scale", MISSING: "has no values"}

# Crests that are cut off within a second of each other are one entry in the list.
_SAME_CLIPPING_S = 1.0


@dataclass(kw_only=True, slots=True)
class Patcher:
    """Replaces faulty samples of one channel and keeps a list of what it did.

    A run of faults is replaced by the straight line between the good samples on its two sides, or by
    their mean. A spike must stand clear of both: where the channel has really moved on, nothing is
    replaced. Crests that are cut off at the rail are listed and left as they are. A run that reaches
    the end of a block waits for the next one, so that the cut into blocks does not matter; one that is
    too long to be replaced is a gap, in which the last good value goes on.
    """

    channel: "Channel"
    """The channel, for names and times."""
    limits: FaultLimits
    """Limits with which the samples were flagged."""
    mean_of_neighbours: bool = False
    """Whether to insert the mean of the two good samples, as the thesis does."""
    repairs: list[Repair]
    """What was found, in order of time."""
    gaps: list[Gap] = field(default_factory=list)
    """Runs that were too long to be replaced, in order of time."""
    _gap_since: int | None = field(default=None, init=False)
    _gap_code: int = field(default=GOOD, init=False)
    _clipping: int = field(default=-1, init=False)
    _clipped_s: float = field(default=-np.inf, init=False)

    def patched(self, samples: Iterable[tuple[Counts, NDArray[np.uint8]]]) -> Iterator[FloatArray]:
        """Yield the samples as float64 counts, without the faults."""
        last_good = np.nan
        waiting, waiting_codes = np.empty(0), np.empty(0, dtype=np.uint8)
        done = 0
        for counts, codes in samples:
            values = np.concatenate([waiting, counts.astype(np.float64)])
            codes = np.concatenate([waiting_codes, codes])
            stop = self._patch(values, codes, done, last_good, final=False)
            if self._too_long(codes[stop:]):
                self._begin_gap(done + stop)
                self._go_on(values, codes, stop, values.size, last_good)
                stop = values.size
            waiting, waiting_codes = values[stop:], codes[stop:]
            if stop:
                yield values[:stop]
                if not np.isnan(last_good) or (codes[:stop] == GOOD).any():
                    last_good = values[stop - 1]
                done += stop
        if waiting.size:
            self._patch(waiting, waiting_codes, done, last_good, final=True)
            yield waiting
            done += waiting.size
        self._end_gap(done)

    def _patch(self, values: FloatArray, codes: NDArray[np.uint8], done: int, before: float, *, final: bool) -> int:
        """Replace the faults in place; return how many samples are settled."""
        if codes.size and codes[0] == GOOD:
            self._end_gap(done)
        for first, stop in runs_of(codes != GOOD):
            is_whole = stop < values.size or final
            if self._gap_since is not None or (is_whole and self._too_long(codes[first:stop])):
                self._begin_gap(done + first)
                self._go_on(values, codes, first, stop, before)
                if stop < values.size:
                    self._end_gap(done + stop)
                continue
            if not is_whole:
                return first
            left = values[first - 1] if first else before
            right = values[stop] if stop < values.size else left
            left = right if np.isnan(left) else left
            inside = values[first:stop]
            code = int(codes[first:stop].max())
            if code in (HOLD, MISSING) or (code == RAIL and self._stands_clear(inside, left, right)):
                self._note("dropout", done + first, inside.size)
            elif code == RAIL:
                self._note_clipping(done + first, inside.size)
                continue
            elif self._stands_clear(inside, left, right):
                self._note("outlier", done + first, inside.size)
            else:
                continue
            if self.mean_of_neighbours:
                inside[:] = 0.5 * (left + right)
            else:
                part = np.arange(1, inside.size + 1) / (inside.size + 1)
                inside[:] = left + (right - left) * part
        return values.size

    def _stands_clear(self, inside: FloatArray, left: float, right: float) -> bool:
        nearest = np.minimum(np.abs(inside - left), np.abs(inside - right))
        return bool(np.all(nearest > 0.5 * self.limits.floor))

    def _note(self, kind: str, sample: int, count: int) -> None:
        if count <= self.limits.half_window:
            kind = "outlier"
        time_s = time_of(self.channel, sample)
        self.repairs.append(Repair(channel=self.channel.name, kind=kind, time_s=time_s, count=count))

    def _note_clipping(self, sample: int, count: int) -> None:
        time_s = time_of(self.channel, sample)
        if time_s - self._clipped_s < _SAME_CLIPPING_S:
            entry = self.repairs[self._clipping]
            self.repairs[self._clipping] = replace(entry, count=entry.count + count)
        else:
            self._clipping = len(self.repairs)
            self.repairs.append(Repair(channel=self.channel.name, kind="saturated", time_s=time_s, count=count))
        self._clipped_s = time_s

    def _too_long(self, codes: NDArray[np.uint8]) -> bool:
        """Return whether a run of faults cannot be replaced."""
        longest_s = _LONGEST_MISSING_S if MISSING in codes else _LONGEST_RUN_S
        return codes.size > longest_s * self.channel.rate_hz

    def _begin_gap(self, sample: int) -> None:
        if self._gap_since is None:
            self._gap_since, self._gap_code = sample, GOOD

    def _go_on(self, values: FloatArray, codes: NDArray[np.uint8], first: int, stop: int, before: float) -> None:
        """Let the last good value go on, zero before the first one."""
        last_good = values[first - 1] if first else before
        values[first:stop] = 0.0 if np.isnan(last_good) else last_good
        self._gap_code = max(self._gap_code, int(codes[first:stop].max()))

    def _end_gap(self, sample: int) -> None:
        if self._gap_since is None:
            return
        start_s, stop_s = (time_of(self.channel, index) for index in (self._gap_since, sample))
        reason = _REASONS.get(self._gap_code, _REASONS[MISSING])
        self.gaps.append(Gap(channel=self.channel.name, start_s=start_s, stop_s=stop_s, reason=reason))
        self._gap_since = None
