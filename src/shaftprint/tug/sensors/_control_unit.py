"""The engine's control unit on the CAN bus: percent torque as it broadcasts it, message by message."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageStream, MessageTimes
from shaftprint.tug.sensors._faults import Fault
from shaftprint.vessel import RackSensor

LOWEST_PERCENT = -125.0
"""What a count of 0 means [%]; SAE J1939-71, percent torque."""

_HIGHEST_PERCENT = 125.0

REGULAR = Bus()
"""A bus on which every message comes, and at its cycle."""


class ControlUnit:
    """Stream of the raw counts of the percent torque, at the times of its messages.

    Each message carries the rack that the governor gave a latency ago, as a percentage in steps.
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
        # before the start the line ran steadily
        self._first_rack = first_rack
        self._stream = MessageStream(self.times, latency_s=latency_s, rate_hz=rate_hz)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        rack, time_s = self._stream.next(stretch.rack_given, first=self._first_rack)
        percent = (100.0 * rack).clip(LOWEST_PERCENT, _HIGHEST_PERCENT)
        counts: FloatArray = np.rint((percent - LOWEST_PERCENT) / self.scale)
        return counts.astype(np.int16), time_s

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []
