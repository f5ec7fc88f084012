"""One channel of a logger file on its own clock, read on request."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any, Self, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError

Counts: TypeAlias = NDArray[np.int16] | NDArray[np.float64]
Source: TypeAlias = Callable[[int, int], NDArray[Any]]
Times: TypeAlias = Callable[[int, int], FloatArray]


# A time that is printed and read again may be off a sample by rounding.
_ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class ClockJump:
    """A place where the times of a file jump by other than whole samples: what follows is on another clock."""

    sample: int
    """Number of the first sample after it."""
    jump_s: float
    """How far the times jump beyond the step from one sample to the next and what is missing between [s]."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Channel:
    """One channel of a recording, on its own clock; ``value = counts * scale + offset``."""

    name: str
    """Name of the channel."""
    unit: str
    """Unit of the scaled value, such as ``V``; empty where the file does not say."""
    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float
    """Time of the first sample [s]."""
    count: int
    """Number of samples."""
    source: Source = field(repr=False)
    """Gives the raw counts of the samples [start, stop)."""
    scale: float = 1.0
    """Value of one count [unit]; 1 where the file holds values."""
    offset: float = 0.0
    """Value at count zero [unit]; 0 where the file holds values."""
    long_name: str = ""
    """What the channel is, in words."""
    clock_jumps: tuple[ClockJump, ...] = ()
    """Where its clock jumps, in order of time; samples that are missing in the file are not numbers."""
    stamps: Times | None = field(repr=False, default=None)
    """Gives the times of the samples [start, stop) as the file has them [s], where they say more than the rate: those
    of messages. Not a number where a sample is missing in the file; they never go back."""
    is_uneven: bool = False
    """Whether the samples lie on no clock: they are messages at the times of ``stamps``, and ``rate_hz`` is that of
    their sender."""
    is_of_edges: bool = False
    """Whether the samples were made of a list of edges: the rate is made up, and says nothing of the logger."""

    def __post_init__(self) -> None:
        """Check that the channel can be placed in time.

        Raises RecordingError if the rate is not positive, the scale is zero, a number is not finite, or messages have
        no times.
        """
        numbers = (self.rate_hz, self.start_s, self.scale, self.offset)
        if not np.all(np.isfinite(numbers)) or self.rate_hz <= 0.0 or self.scale == 0.0:
            raise RecordingError(
                f"channel {self.name}: expected a positive rate, a scale other than 0 and finite "
                f"numbers, found rate {self.rate_hz:g} Hz, start {self.start_s:g} s, "
                f"scale {self.scale:g}, offset {self.offset:g}."
            )
        if self.is_uneven and self.stamps is None:
            raise RecordingError(f"channel {self.name}: expected the times of its messages, found none.")

    @property
    def holds_counts(self) -> bool:
        """Whether the samples are counts of 16 bits, as a logger takes them; others are values."""
        return self.read(0, 0).dtype == np.int16

    @property
    def duration_s(self) -> float:
        """Length of the channel [s], each sample counted with its period."""
        if self.is_uneven and self.count:
            return float(self.time_s(self.count - 1, self.count)[0]) - self.start_s + 1.0 / self.rate_hz
        return self.count / self.rate_hz

    def read(self, start: int, stop: int) -> Counts:
        """Return the raw counts of the samples [start, stop), shape (stop - start,).

        Raises
        ------
        RecordingError
            If the samples are not in the recording or the file can no longer be read.
        """
        if not 0 <= start <= stop <= self.count:
            raise RecordingError(
                f"channel {self.name}: expected samples within [0, {self.count}), found [{start}, {stop})."
            )
        return self.source(start, stop)

    def blocks(self, samples: int) -> Iterator[tuple[int, int]]:
        """Yield first and last of its samples in blocks of so many; the last block may be shorter."""
        for start in range(0, self.count, samples):
            yield start, min(start + samples, self.count)

    def values(self, start: int, stop: int) -> FloatArray:
        """Return the samples [start, stop) in the channel's unit, shape (stop - start,).

        Raises
        ------
        RecordingError
            As ``read``.
        """
        return self.scaled(self.read(start, stop))

    def scaled(self, counts: NDArray[Any]) -> FloatArray:
        """Return raw counts in the channel's unit, of any shape."""
        values = counts.astype(np.float64)
        if self.scale != 1.0:
            values *= self.scale
        if self.offset != 0.0:
            values += self.offset
        return values

    def part(self, first: int, last: int) -> Self:
        """Return the samples [first, last) as a channel whose times are the same."""
        source, stamps = self.source, self.stamps
        start_s = self.start_s + first / self.rate_hz
        if self.is_uneven and first < last:
            start_s = float(self.time_s(first, first + 1)[0])
        return replace(
            self,
            start_s=start_s,
            count=last - first,
            clock_jumps=tuple(
                replace(jump, sample=jump.sample - first) for jump in self.clock_jumps if first < jump.sample < last
            ),
            source=lambda start, stop: source(first + start, first + stop),
            stamps=None if stamps is None else lambda start, stop: stamps(first + start, first + stop),
        )

    def on_other_clock(self, *, start_s: float, rate_hz: float) -> Self:
        """Return the same samples on another clock, by the start and rate that the channel has there."""
        stamps, first_s, ratio = self.stamps, self.start_s, self.rate_hz / rate_hz

        def moved(start: int, stop: int) -> FloatArray:
            return start_s + ratio * (cast("Times", stamps)(start, stop) - first_s)

        return replace(self, start_s=start_s, rate_hz=rate_hz, stamps=None if stamps is None else moved)

    def with_unit(self, unit: str) -> Self:
        """Return the same channel in a unit that the user gives, where the file gives none."""
        return replace(self, unit=unit)

    def time_s(self, start: int, stop: int) -> FloatArray:
        """Return the times of the samples [start, stop) [s], shape (stop - start,): by the rate, or of messages."""
        return self.stamps_s(start, stop) if self.is_uneven else self._by_rate_s(start, stop)

    def stamps_s(self, start: int, stop: int) -> FloatArray:
        """Return the times of the samples [start, stop) [s] as the file has them, shape (stop - start,)."""
        by_rate = self._by_rate_s(start, stop)
        if self.stamps is None:
            return by_rate
        stamps = self.stamps(start, stop)
        missing = np.isnan(stamps)
        return np.where(missing, by_rate, stamps) if missing.any() else stamps

    def sample_at(self, time_s: float) -> float:
        """Return how many samples, or parts of one, lie before a time; of messages whole ones."""
        if not self.is_uneven:
            return (time_s - self.start_s) * self.rate_hz
        return float(np.searchsorted(self.stamps_s(0, self.count), time_s - _ROUNDING / self.rate_hz))

    def samples_before(self, time_s: float) -> int:
        """Return the number of samples before a time; a sample at it is not before."""
        return math.ceil(self.sample_at(time_s) - _ROUNDING)

    def _by_rate_s(self, start: int, stop: int) -> FloatArray:
        return self.start_s + np.arange(start, stop) / self.rate_hz
