"""The log of the ship: speed through the water, value by value."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._faults import Fault
from shaftprint.vessel._sensors import ShipSpeedSensor


class SpeedLog:
    """Stream of the raw counts of the ship's speed, on the clock of the log.

    Each value is the speed a latency ago with noise of its own, in steps.
    """

    def __init__(
        self,
        sensor: ShipSpeedSensor,
        *,
        noise_m_s: float,
        shown: float = 1.0,
        first_speed_m_s: float,
        rate_hz: float,
        rng: np.random.Generator,
    ) -> None:
        self.channel = sensor.channel
        self.unit = sensor.unit
        """Unit of the channel."""
        self.cycle_s = sensor.cycle_s
        """Time from one value to the next [s]."""
        self.start_s = float(rng.uniform(0.0, sensor.cycle_s))
        """Time of the first value [s]."""
        self.scale = sensor.resolution
        """Value of one count, in the unit of the channel."""
        self._m_s_per_count = sensor.m_s_per_unit * sensor.resolution
        self._noise_m_s = noise_m_s
        self._shown = shown
        self._latency_s = sensor.latency_s
        self._rate_hz = rate_hz
        self._rng = rng
        self._sent = 0
        self._passed = 0
        # before the start the ship ran steadily
        self._tail: FloatArray = np.full(self._kept(), first_speed_m_s)

    def _kept(self) -> int:
        """Return how many samples a later value can ask for: its latency, its own cycle and the samples around."""
        return int(np.ceil((self._latency_s + self.cycle_s) * self._rate_hz)) + 2

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the values of the next stretch, shape (values,)."""
        speed = np.concatenate([self._tail, stretch.ship_speed_m_s])
        begin = self._passed - self._tail.size
        self._passed += stretch.ship_speed_m_s.size
        most = int(self._passed / (self.cycle_s * self._rate_hz)) + 2
        time = self.start_s + self.cycle_s * np.arange(self._sent, most)
        position = (time - self._latency_s) * self._rate_hz
        position = position[(time * self._rate_hz < self._passed) & (position < self._passed - 1)]
        self._sent += position.size
        before = np.floor(position).astype(np.int64)
        part = position - before
        shown = self._shown * ((1.0 - part) * speed[before - begin] + part * speed[before - begin + 1])
        shown += self._noise_m_s * self._rng.standard_normal(shown.size)
        self._tail = speed[-self._kept() :]
        counts: FloatArray = np.rint(shown / self._m_s_per_count)
        return counts.clip(-32768, 32767).astype(np.int16)

    def faults(self) -> list[Fault]:
        """Return no fault."""
        return []
