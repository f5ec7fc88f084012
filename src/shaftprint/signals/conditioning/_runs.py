"""Runs of equal neighbours in the raw samples of a channel, counted while something else reads it."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# Runs that are shorter make nothing late that a fit would see.
_SHORTEST_S = 0.002
# The size of a change is noted in one stretch of 4096 samples in 64, wherever the blocks are cut.
_LOOKED, _APART = 4096, 64 * 4096


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Runs:
    """Runs of equal samples in one channel."""

    channel: "Channel"
    """The channel."""
    samples: int
    """Samples that were read."""
    count: int
    """Runs, single samples too."""
    lengths: IntArray
    """Lengths of the runs of 2 ms and more [samples], shape (long,)."""
    jumps: FloatArray
    """By how much the channel changed after each of them [counts], shape (long,)."""
    values: FloatArray
    """Value of each of them [counts], shape (long,)."""
    changes: FloatArray
    """Sizes of changes from one sample to the next, from stretches all over the channel [counts], shape (changes,)."""


class RunTally:
    """What has been seen of a channel so far."""

    def __init__(self, channel: "Channel") -> None:
        self.watched = replace(channel, source=self._read)
        self._channel = channel
        self._shortest = max(2, round(_SHORTEST_S * channel.rate_hz))
        # last sample, none so far, start of its run, runs that have ended
        self._last: NDArray[Any] | None = None
        self._begin = self._ended = 0
        self._seen = 0
        self._long: list[FloatArray] = []
        self._changes: list[FloatArray] = []

    def runs(self) -> Runs:
        """Return the runs that have ended."""
        long = np.concatenate([np.empty((3, 0)), *self._long], axis=1)
        return Runs(
            channel=self._channel,
            samples=self._seen,
            count=self._ended,
            lengths=long[0].astype(np.int64),
            jumps=long[1],
            values=long[2],
            changes=np.concatenate([np.empty(0), *self._changes]),
        )

    def _read(self, start: int, stop: int) -> NDArray[Any]:
        counts = self._channel.source(start, stop)
        # whoever looks at a few samples first comes again for all
        if start <= self._seen < start + counts.size:
            self._add(counts[self._seen - start :])
        return counts

    def _add(self, values: NDArray[Any]) -> None:
        if not values.size:
            return
        # counts stay whole numbers, of which a quarter of the bytes are moved; the first sample goes on with itself
        padded = np.concatenate([values[:1] if self._last is None else self._last, values])
        counts = differs = padded[1:] != padded[:-1]
        if values.dtype.kind == "f":
            # one that is no number is equal to none and ends no run that counts
            known = ~np.isnan(padded)
            counts = differs & known[1:] & known[:-1]
        ends = np.flatnonzero(differs)
        lengths = np.diff(ends, prepend=self._begin - self._seen)
        long = np.flatnonzero(lengths >= self._shortest)
        long = long[counts[ends[long]]]
        after, before = padded[ends[long] + 1].astype(np.float64), padded[ends[long]].astype(np.float64)
        self._long.append(np.array([lengths[long], np.abs(after - before), before]))
        for first in range(self._seen & -_APART, self._seen + values.size, _APART):
            looked = slice(max(first - self._seen, 0), max(first + _LOOKED - self._seen, 0))
            where = np.flatnonzero(counts[looked]) + looked.start
            self._changes.append(np.abs(padded[where + 1].astype(np.float64) - padded[where]))
        self._begin = self._seen + int(ends[-1]) if ends.size else self._begin
        self._last, self._ended = padded[-1:].copy(), self._ended + int(np.count_nonzero(counts))
        self._seen += values.size
