"""The engine's control unit on the CAN bus: percent torque as it broadcasts it, message by message."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant import Stretch
from shaftprint.tug.sensors._faults import Fault
from shaftprint.vessel import RackSensor

LOWEST_PERCENT = -125.0
"""What a count of 0 means [%]; SAE J1939-71, percent torque."""

_HIGHEST_PERCENT = 125.0


class ControlUnit:
    """Stream of the raw counts of the percent torque, on the clock of the control unit.

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
    ) -> None:
        self.channel = sensor.channel
        self.cycle_s = sensor.cycle_s
        """Time from one message to the next [s]."""
        self.start_s = float(rng.uniform(0.0, sensor.cycle_s))
        """Time of the first message [s]: the bus does not wait for the logger."""
        self.scale = sensor.resolution_percent
        """Value of one count [%]."""
        self._rate_hz = rate_hz
        self._latency_s = latency_s
        self._sent = 0
        self._passed = 0
        # before the start the line ran steadily
        self._tail: FloatArray = np.full(int(np.ceil(latency_s * rate_hz)) + 2, first_rack)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        rack = np.concatenate([self._tail, stretch.rack_given])
        begin = self._passed - self._tail.size
        self._passed += stretch.rack_given.size
        most = int(self._passed / (self.cycle_s * self._rate_hz)) + 2
        message = self.start_s + self.cycle_s * np.arange(self._sent, most)
        position = (message - self._latency_s) * self._rate_hz
        position = position[(message * self._rate_hz < self._passed) & (position < self._passed - 1)]
        self._sent += position.size
        # in samples since the start, so that the result does not depend on how the time is cut into stretches
        before = np.floor(position).astype(np.int64)
        part = position - before
        percent = 100.0 * ((1.0 - part) * rack[before - begin] + part * rack[before - begin + 1])
        # all that a later message can ask for: its latency, its own cycle and the sample before
        kept = int(np.ceil((self._latency_s + self.cycle_s) * self._rate_hz)) + 2
        self._tail = rack[-kept:]
        counts: FloatArray = np.rint((percent.clip(LOWEST_PERCENT, _HIGHEST_PERCENT) - LOWEST_PERCENT) / self.scale)
        return counts.astype(np.int16)

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []
