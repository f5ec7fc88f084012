"""Putting plausible values where samples cannot be true, as the blocks go by."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.signals._channels import Counts, time_of
from shaftprint.signals._outliers import HOLD, RAIL, FaultLimits
from shaftprint.signals._signals import Repair

if TYPE_CHECKING:
    from shaftprint.recording import Channel

_LONGEST_RUN_S = 2.0

# Crests that are cut off within a second of each other are one entry in the list.
_SAME_CLIPPING_S = 1.0


@dataclass(kw_only=True, slots=True)
class Patcher:
    """Replaces faulty samples of one channel and keeps a list of what it did.

    A run of faults is replaced by the straight line between the good samples on its two sides, or by
    their mean. A spike must stand clear of both: where the channel has really moved on, nothing is
    replaced. Crests that are cut off at the rail are listed and left as they are. A run that reaches
    the end of a block waits for the next one, so that the cut into blocks does not matter.
    """

    channel: "Channel"
    """The channel, for names and times."""
    limits: FaultLimits
    """Limits with which the samples were flagged."""
    mean_of_neighbours: bool = False
    """Whether to insert the mean of the two good samples, as the thesis does."""
    repairs: list[Repair]
    """What was found, in order of time."""
    _clipping: int = field(default=-1, init=False)
    _clipped_s: float = field(default=-np.inf, init=False)

    def patched(self, samples: Iterable[tuple[Counts, NDArray[np.uint8]]]) -> Iterator[FloatArray]:
        """Yield the samples as float64 counts, without the faults.

        Raises
        ------
        SignalError
            If a hold or a stay at the rail lasts longer than 2 s.
        """
        last_good = np.nan
        waiting, waiting_codes = np.empty(0), np.empty(0, dtype=np.uint8)
        done = 0
        for counts, codes in samples:
            values = np.concatenate([waiting, counts.astype(np.float64)])
            codes = np.concatenate([waiting_codes, codes])
            stop = self._patch(values, codes, done, last_good, final=False)
            waiting, waiting_codes = values[stop:], codes[stop:]
            if waiting.size:
                self._expect_short(waiting_codes, done + stop)
            if stop:
                yield values[:stop]
                last_good = values[stop - 1]
                done += stop
        if waiting.size:
            self._patch(waiting, waiting_codes, done, last_good, final=True)
            yield waiting

    def _patch(self, values: FloatArray, codes: NDArray[np.uint8], done: int, before: float, *, final: bool) -> int:
        """Replace the faults in place; return how many samples are settled."""
        for first, stop in _runs(codes):
            if stop == values.size and not final:
                return first
            left = values[first - 1] if first else before
            right = values[stop] if stop < values.size else left
            left = right if np.isnan(left) else left
            inside = values[first:stop]
            code = int(codes[first:stop].max())
            if code == HOLD or (code == RAIL and self._stands_clear(inside, left, right)):
                self._expect_short(codes[first:stop], done + first)
                self._note("dropout", done + first, inside.size)
            elif code == RAIL:
                self._expect_short(codes[first:stop], done + first)
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

    def _expect_short(self, codes: NDArray[np.uint8], sample: int) -> None:
        if codes.size <= _LONGEST_RUN_S * self.channel.rate_hz:
            return
        raise SignalError(
            f"channel {self.channel.name}: expected a signal that is always alive, found it "
            f"{'at full scale' if RAIL in codes else 'dead'} for more than {_LONGEST_RUN_S:g} s from "
            f"{time_of(self.channel, sample):.1f} s on; check the sensor and its telemetry, or use "
            "another recording."
        )


def _runs(codes: NDArray[np.uint8]) -> list[tuple[int, int]]:
    """Return [first, stop) of every run of faulty samples."""
    faulty = np.flatnonzero(codes)
    if faulty.size == 0:
        return []
    breaks = np.flatnonzero(np.diff(faulty) > 1)
    firsts = faulty[np.concatenate([[0], breaks + 1])]
    stops = faulty[np.concatenate([breaks, [faulty.size - 1]])] + 1
    return list(zip(firsts.tolist(), stops.tolist(), strict=True))
