"""The engine's control unit on the CAN bus: percent torque, load or fuel rate as it broadcasts it, by messages."""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import REGULAR, Bus, MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import RackSensor
from shaftprint.vessel._vessel import Vessel

LOWEST_PERCENT = -125.0
"""What a count of 0 means [%]; SAE J1939-71, percent torque."""

_HIGHEST_PERCENT = 125.0


class ControlUnit(Faultless, MessageSensor):
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
        logged = LoggedChannel(
            name=sensor.channel,
            unit=sensor.unit,
            scale=sensor.resolution,
            offset=0.0 if sensor.goes_with_speed else LOWEST_PERCENT,
            long_name="demand percent torque of the engine's control unit, from its CAN bus",
        )

        def in_counts(shown: FloatArray) -> FloatArray:
            if sensor.unit == "%":
                shown = shown.clip(logged.offset, _HIGHEST_PERCENT)
            return (shown - logged.offset) / logged.scale

        times = MessageTimes(bus, cycle_s=sensor.cycle_s, rng=rng)
        super().__init__(logged, times, latency_s=latency_s, rate_hz=rate_hz, in_counts=in_counts)
        self._sensor, self._vessel = sensor, vessel
        self._first_rack = first_rack

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        rack, first = stretch.rack_given, self._first_rack
        if self._sensor.goes_with_speed:
            ratio = self._vessel.working_point.turning * self._vessel.gearbox.ratio
            speed_rpm = rpm_from_rev_s(ratio * stretch.engine_speed_rev_s)
            share = self._sensor.share(speed_rpm, self._vessel.machine)
            rack, first = rack / share, first / float(share[0])
        return first / self._sensor.rack_per_unit, rack / self._sensor.rack_per_unit
