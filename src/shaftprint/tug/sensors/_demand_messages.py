"""The demand inside the control unit, as it reports it on the CAN bus."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageStream, MessageTimes
from shaftprint.tug.sensors._faults import Fault
from shaftprint.tug.sensors._speed_meter import SPEED_STEP_RPM
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import DemandSensor


class DemandMessages:
    """Stream of the raw counts of the desired engine speed, message by message."""

    def __init__(self, sensor: DemandSensor, *, rate_hz: float, rng: np.random.Generator, bus: Bus) -> None:
        self.channel = sensor.channel
        self.offset = 0.0
        """Value of no count [rpm]."""
        self.scale = SPEED_STEP_RPM
        """Value of one count [rpm]."""
        self.times = MessageTimes(bus, cycle_s=sensor.cycle_s, rng=rng)
        """When its messages come."""
        self._stream = MessageStream(self.times, latency_s=sensor.latency_s, rate_hz=rate_hz)
        self._first: float | None = None

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        rpm = rpm_from_rev_s(stretch.demand_rev_s)
        # before the start the lever stood still
        self._first = float(rpm[0]) if self._first is None else self._first
        shown, time_s = self._stream.next(rpm, first=self._first)
        return np.rint(shown / self.scale).clip(-32768, 32767).astype(np.int16), time_s

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []
