"""When the messages of a CAN bus come: on the cycle of their sender, early or late by chance, and some never."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import SettingsError
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._counts import LoggedChannel, as_counts

# Evenly spread by half a cycle either way: with more, a message would overtake the one before.
_MOST_JITTER = 0.5 / np.sqrt(3.0)


@dataclass(frozen=True, kw_only=True, slots=True)
class Bus:
    """How regularly a logger sees the messages of a bus."""

    jitter: float = 0.0
    """Standard deviation of the time of a message about its cycle, over the cycle."""
    lost: float = 0.0
    """Share of the messages that are missing."""
    waits: bool = False
    """Whether only the messages come early or late, while their values keep the cycle."""

    @classmethod
    def of(cls, tug: Tug) -> "Bus":
        """Return the bus of a simulated ship.

        Raises SettingsError if messages would overtake each other, or none would be left.
        """
        if not 0.0 <= tug.message_jitter < _MOST_JITTER:
            raise SettingsError(
                f"message_jitter: expected 0 to {_MOST_JITTER:.3f} of a cycle, found {tug.message_jitter:g}."
            )
        if not 0.0 <= tug.messages_lost < 1.0:
            raise SettingsError(f"messages_lost: expected a share from 0 to below 1, found {tug.messages_lost:g}.")
        return cls(jitter=tug.message_jitter, lost=tug.messages_lost, waits=tug.messages_wait)

    @property
    def is_regular(self) -> bool:
        """Whether every message comes, and at its cycle."""
        return self.jitter == 0.0 and self.lost == 0.0


REGULAR = Bus()
"""A bus on which every message comes, and at its cycle."""


class MessageTimes:
    """Stream of the times of one message; the result does not depend on how the time is cut into stretches."""

    def __init__(self, bus: Bus, *, cycle_s: float, rng: np.random.Generator) -> None:
        self.cycle_s = cycle_s
        """Time from one message to the next [s]."""
        self.start_s = float(rng.uniform(0.0, cycle_s))
        """Time of the first message, were it at its cycle [s]: the bus does not wait for the logger."""
        self.is_regular = bus.is_regular
        """Whether every message comes, and at its cycle."""
        self._bus, self._rng = bus, rng
        self._sent = 0
        self._waiting: FloatArray = np.empty((0, 2))

    def before(self, stop_s: float) -> tuple[FloatArray, FloatArray]:
        """Return the messages that come before a time and were not returned yet.

        ``stop_s``: the time [s]. Returns when they came and when their values were taken [s], each of shape
        (messages,).
        """
        most = max(int((stop_s - self.start_s) / self.cycle_s) + 2 - self._sent, 0)
        cycle = np.arange(self._sent, self._sent + most)
        drawn = np.zeros((most, 2))
        if not self.is_regular:
            new = self._rng.uniform(size=(max(most - len(self._waiting), 0), 2))
            self._waiting = np.concatenate([self._waiting, new])
            drawn = self._waiting[:most]
        jitter_s = self._bus.jitter * self.cycle_s * np.sqrt(12.0) * (drawn[:, 0] - 0.5)
        due_s = self.start_s + self.cycle_s * cycle
        time_s = due_s + (0.0 if self.is_regular else jitter_s)
        # a value that waits must be there, too
        come = np.maximum(time_s, due_s) < stop_s
        self._sent += int(np.count_nonzero(come))
        self._waiting = self._waiting[int(np.count_nonzero(come)) :]
        is_logged = (time_s >= 0.0) & (drawn[:, 1] >= self._bus.lost)
        logged = come & is_logged
        return time_s[logged], (due_s if self._bus.waits else time_s)[logged]


class MessageStream:
    """Stream of a quantity as messages carry it: what it was a latency before each of them came.

    A message that the recording just misses at its end is left out.
    """

    def __init__(self, times: MessageTimes, *, latency_s: float, rate_hz: float) -> None:
        self.times = times
        """When the messages come."""
        self._latency_s = latency_s
        self._rate_hz = rate_hz
        self._passed = 0
        self._tail: FloatArray = np.empty(0)

    def next(self, values: FloatArray, *, first: float) -> tuple[FloatArray, FloatArray]:
        """Return what the messages of the next samples carry, and their times [s], each of shape (messages,).

        ``values``: the quantity, sample by sample, shape (samples,). ``first``: what it was before the start.
        """
        # all that a later message can ask for: its latency, its own cycle either way and the sample before
        kept = int(np.ceil((self._latency_s + 2.0 * self.times.cycle_s) * self._rate_hz)) + 2
        longer = np.concatenate([self._tail if self._passed else np.full(kept, first), values])
        begin = self._passed + values.size - longer.size
        self._passed += values.size
        # both the message and the sample after what it carries are there
        seen_s = min(self._passed, self._passed - 1 + self._latency_s * self._rate_hz) / self._rate_hz
        time_s, taken_s = self.times.before(seen_s)
        position = (taken_s - self._latency_s) * self._rate_hz
        # in samples since the start, so that the result does not depend on how the time is cut into stretches
        before = np.floor(position).astype(np.int64)
        part = position - before
        self._tail = longer[-kept:]
        return (1.0 - part) * longer[before - begin] + part * longer[before - begin + 1], time_s


class MessageSensor(ABC):
    """Stream of the raw counts of a quantity that comes message by message."""

    def __init__(
        self,
        logged: LoggedChannel,
        times: MessageTimes,
        *,
        latency_s: float,
        rate_hz: float,
        in_counts: Callable[[FloatArray], FloatArray] | None = None,
    ) -> None:
        """Begin before the first stretch.

        ``in_counts``: how many counts the channel shows of what messages carry; None where that is in its unit.
        """
        self.logged, self.times = logged, times
        self._in_counts = in_counts
        self._stream = MessageStream(times, latency_s=latency_s, rate_hz=rate_hz)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        before, values = self._quantity(stretch)
        carried, time_s = self._stream.next(values, first=before)
        if self._in_counts is None:
            return as_counts((carried - self.logged.offset) / self.logged.scale), time_s
        return as_counts(self._in_counts(carried)), time_s

    @abstractmethod
    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        """Return what the quantity was before the start, in steady running, and what it is, sample by sample."""
