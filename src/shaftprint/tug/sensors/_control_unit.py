"""The engine's control unit on the CAN bus: percent torque, load or fuel rate as it broadcasts it, by messages."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageStream, MessageTimes
from shaftprint.tug.sensors._faults import Fault
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import RackSensor
from shaftprint.vessel._vessel import Vessel

LOWEST_PERCENT = -125.0
"""What a count of 0 means [%]; SAE J1939-71, percent torque."""

_HIGHEST_PERCENT = 125.0

REGULAR = Bus()
"""A bus on which every message comes, and at its cycle."""


class ControlUnit:
    """Stream of the raw counts of the percent torque, load or fuel rate, at the times of its messages.

    Each message carries the rack that the governor gave a latency ago, in steps.
    """

    def __init__(
        self,
        sensor: RackSensor,
        vessel: Vessel,
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
        self.scale = sensor.resolution
        """Value of one count, in the unit of the channel."""
        self.unit = sensor.unit
        """Unit of the channel."""
        self.offset = 0.0 if sensor.goes_with_speed else LOWEST_PERCENT
        """Value of no count, in the unit of the channel."""
        self._sensor, self._vessel = sensor, vessel
        # before the start the line ran steadily
        self._first_rack = first_rack
        self._stream = MessageStream(self.times, latency_s=latency_s, rate_hz=rate_hz)

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        rack, first = stretch.rack_given, self._first_rack
        if self._sensor.goes_with_speed:
            ratio = self._vessel.working_point.turning * self._vessel.gearbox.ratio
            speed_rpm = rpm_from_rev_s(ratio * stretch.engine_speed_rev_s)
            share = self._sensor.share(speed_rpm, self._vessel.machine)
            rack, first = rack / share, first / float(share[0])
        shown, time_s = self._stream.next(rack / self._sensor.rack_per_unit, first=first / self._sensor.rack_per_unit)
        if self.unit == "%":
            shown = shown.clip(self.offset, _HIGHEST_PERCENT)
        counts: FloatArray = np.rint((shown - self.offset) / self.scale)
        return counts.astype(np.int16), time_s

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []
