"""An instrument that gives the speed of a shaft itself: in a unit of speed, in Hz, or as volts or milliamperes."""

import math

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import LoggedChannel, as_counts
from shaftprint.tug.sensors._faults import Faultless
from shaftprint.tug.sensors._late import Late
from shaftprint.tug.sensors._turns import motion_of, turns_of
from shaftprint.vessel._sensors import SpeedSensor
from shaftprint.vessel._vessel import Vessel

# Counts at 30 % above rated speed, which no engine reaches.
_HIGHEST_COUNT = 32_000

SPEED_STEP_RPM = 0.125
"""Step of the engine speed in a message; SAE J1939-71, SPN 190."""


class SpeedMeter(Faultless):
    """Stream of the raw counts of one speed, a latency late, with white noise."""

    def __init__(
        self, sensor: SpeedSensor, tug: Tug, vessel: Vessel, *, rate_hz: float, rng: np.random.Generator
    ) -> None:
        self._sensor, self._turns = sensor, turns_of(sensor, vessel)
        highest_rev_s = 1.3 * vessel.machine.rated_speed_rpm / 60.0 * abs(self._turns) / vessel.gearbox.ratio
        self._per_rev_s, at_rest = _line(sensor)
        self.logged = LoggedChannel(
            name=sensor.channel,
            unit=sensor.unit,
            scale=self._per_rev_s * highest_rev_s / _HIGHEST_COUNT,
            offset=at_rest,
            long_name=_words(sensor),
        )
        self._noise_rev_s = tug.speed_meter_noise * highest_rev_s
        # before the start the line ran steadily
        self._late = Late(sensor.latency_s * rate_hz)
        self._rng = rng

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        shown = self._late.next(self._turns * motion_of(self._sensor, stretch)[0])
        shown += self._noise_rev_s * self._rng.standard_normal(shown.size)
        return as_counts(shown * self._per_rev_s / self.logged.scale)


class SpeedMessages(Faultless, MessageSensor):
    """Stream of the raw counts of one speed in rpm that a control unit sends, message by message."""

    def __init__(
        self, sensor: SpeedSensor, vessel: Vessel, *, cycle_s: float, rate_hz: float, rng: np.random.Generator, bus: Bus
    ) -> None:
        logged = LoggedChannel(name=sensor.channel, unit=sensor.unit, scale=SPEED_STEP_RPM, long_name=_words(sensor))
        times = MessageTimes(bus, cycle_s=cycle_s, rng=rng)
        super().__init__(logged, times, latency_s=sensor.latency_s, rate_hz=rate_hz)
        self._sensor, self._turns = sensor, turns_of(sensor, vessel)

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        rpm = 60.0 * self._turns * motion_of(self._sensor, stretch)[0]
        return float(rpm[0]), rpm


def _words(sensor: SpeedSensor) -> str:
    return f"speed of the {sensor.shaft} shaft"


def _line(sensor: SpeedSensor) -> tuple[float, float]:
    """Return what the channel shows for one turn a second, and at rest, in its unit."""
    if sensor.unit in ("V", "mA"):
        rpm_per_unit, rpm_at_zero = sensor.rpm_per_unit or 1.0, sensor.rpm_at_zero or 0.0
        return 60.0 / rpm_per_unit, -rpm_at_zero / rpm_per_unit
    pulses = sensor.toothed.counted + sensor.toothed.extra
    circumference_m = math.pi * (sensor.diameter_m or 0.0)
    shown = {"rpm": 60.0, "rev/s": 1.0, "rad/s": 2.0 * math.pi, "deg/s": 360.0, "Hz": pulses, "m/s": circumference_m}
    return float(shown[sensor.unit]), 0.0
