"""The demand inside the control unit, as it reports it on the CAN bus."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.tug.sensors._speed_meter import SPEED_STEP_RPM
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import DemandSensor


class DemandMessages(Faultless, MessageSensor):
    """Stream of the raw counts of the desired engine speed, message by message."""

    def __init__(self, sensor: DemandSensor, *, rate_hz: float, rng: np.random.Generator, bus: Bus) -> None:
        logged = LoggedChannel(
            name=sensor.channel,
            unit="rpm",
            scale=SPEED_STEP_RPM,
            long_name="desired engine speed of the control unit, from its CAN bus",
        )
        times = MessageTimes(bus, cycle_s=sensor.cycle_s, rng=rng)
        super().__init__(logged, times, latency_s=sensor.latency_s, rate_hz=rate_hz)

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        rpm = rpm_from_rev_s(stretch.demand_rev_s)
        return float(rpm[0]), rpm
