"""Runs of equal neighbours in the raw samples of a channel, counted while something else reads it."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.kernels._compiled import compiled

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# Runs that are shorter make nothing late that a fit would see.
_SHORTEST_S = 0.002
# The size of a change is noted in one stretch of 4096 samples in 64, wherever the blocks are cut.
_LOOKED_BITS, _LOOKED_EVERY = 12, 64


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
        # last sample, start of its run, runs that have ended
        self._state = np.array([np.nan, 0.0, 0.0])
        self._seen = 0
        self._long: list[FloatArray] = []
        self._changes: list[FloatArray] = []

    def runs(self) -> Runs:
        """Return the runs that have ended."""
        long = np.concatenate([np.empty((3, 0)), *self._long], axis=1)
        return Runs(
            channel=self._channel,
            samples=self._seen,
            count=int(self._state[2]),
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

    def _add(self, counts: NDArray[Any]) -> None:
        values = counts if counts.dtype == np.int16 else np.ascontiguousarray(counts, dtype=np.float64)
        long = np.empty((3, values.size // self._shortest + 2))
        changes = np.empty(values.size)
        found, looked = count_runs(values, self._seen, self._shortest, self._state, long, changes)
        self._long.append(long[:, :found].copy())
        self._changes.append(changes[:looked].copy())
        self._seen += values.size


@compiled(nogil=True)
def count_runs(values, first: int, shortest: int, state, long, changes) -> tuple[int, int]:  # type: ignore[no-untyped-def]
    """Go on counting with the next samples; return how many runs were long, and how many changes were noted.

    ``first`` is the number of the first sample; one that is no number is equal to none and ends no run that counts.
    """
    last, begin, ended = state[0], state[1], state[2]
    found, looked = 0, 0
    for k in range(values.size):
        value = float(values[k])
        if value != last:
            here = first + k
            change = abs(value - last)
            if change > 0.0:
                if here - begin >= shortest:
                    long[0, found], long[1, found], long[2, found] = here - begin, change, last
                    found += 1
                if (here >> _LOOKED_BITS) % _LOOKED_EVERY == 0:
                    changes[looked] = change
                    looked += 1
                ended += 1.0
            begin = here
            last = value
    state[0], state[1], state[2] = last, begin, ended
    return found, looked
