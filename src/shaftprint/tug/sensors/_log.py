"""The log of the ship: speed through the water, value by value."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import REGULAR, MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.vessel._sensors import ShipSpeedSensor


class SpeedLog(Faultless, MessageSensor):
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
        def in_counts(speed_m_s: FloatArray) -> FloatArray:
            noise = noise_m_s * rng.standard_normal(speed_m_s.size)
            return (shown * speed_m_s + noise) / (sensor.m_s_per_unit * sensor.resolution)

        logged = LoggedChannel(
            name=sensor.channel,
            unit=sensor.unit,
            scale=sensor.resolution,
            long_name="speed of the ship through the water, from its log",
        )
        times = MessageTimes(REGULAR, cycle_s=sensor.cycle_s, rng=rng)
        super().__init__(logged, times, latency_s=sensor.latency_s, rate_hz=rate_hz, in_counts=in_counts)
        self._first_speed_m_s = first_speed_m_s

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        return self._first_speed_m_s, stretch.ship_speed_m_s
