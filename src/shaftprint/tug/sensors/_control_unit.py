"""The engine's control unit on the CAN bus: percent torque as it broadcasts it, message by message."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageTimes
from shaftprint.tug.sensors._faults import Fault
from shaftprint.vessel import RackSensor

LOWEST_PERCENT = -125.0
"""What a count of 0 means [%]; SAE J1939-71, percent torque."""

_HIGHEST_PERCENT = 125.0

REGULAR = Bus()
"""A bus on which every message comes, and at its cycle."""


class ControlUnit:
    """Stream of the raw counts of the percent torque, at the times of its messages.

    Each message carries the rack that the governor gave a latency ago, as a percentage in steps. A message that the
    recording just misses at its end is left out.
    """

    def __init__(
        self,
        sensor: RackSensor,
        *,
        latency_s: float,
        first_rack: float,
        rate_hz: float,
        rng: np.random.Generator,
        bus: Bus = REGULAR,
    ) -> None:
        self.channel = sensor.channel
        self.times = MessageTimes(bus, cycle_s=sensor.cycle_s, rng=rng)
        """When its messages come."""
        self.scale = sensor.resolution_percent
        """Value of one count [%]."""
        self._rate_hz = rate_hz
        self._latency_s = latency_s
        self._passed = 0
        # before the start the line ran steadily
        self._tail: FloatArray = np.full(int(np.ceil((latency_s + sensor.cycle_s) * rate_hz)) + 2, first_rack)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        rack = np.concatenate([self._tail, stretch.rack_given])
        begin = self._passed - self._tail.size
        self._passed += stretch.rack_given.size
        # both the message and the sample after what it carries are there
        seen_s = min(self._passed, self._passed - 1 + self._latency_s * self._rate_hz) / self._rate_hz
        time_s = self.times.before(seen_s)
        position = (time_s - self._latency_s) * self._rate_hz
        # in samples since the start, so that the result does not depend on how the time is cut into stretches
        before = np.floor(position).astype(np.int64)
        part = position - before
        percent = 100.0 * ((1.0 - part) * rack[before - begin] + part * rack[before - begin + 1])
        # all that a later message can ask for: its latency, its own cycle either way and the sample before
        kept = int(np.ceil((self._latency_s + 2.0 * self.times.cycle_s) * self._rate_hz)) + 2
        self._tail = rack[-kept:]
        counts: FloatArray = np.rint((percent.clip(LOWEST_PERCENT, _HIGHEST_PERCENT) - LOWEST_PERCENT) / self.scale)
        return counts.astype(np.int16), time_s

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []
