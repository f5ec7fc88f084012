"""The logger's view of the set points: voltages, or what a control unit reports of them."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import helm_voltage
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import VOLT_PER_COUNT, LoggedChannel, as_counts
from shaftprint.tug.sensors._faults import Fault, Faultless, draw_spikes
from shaftprint.vessel._set_point import SetPointSensor
from shaftprint.vessel._vessel import Vessel

PITCH_INPUT = "pitch_set_point"
"""Table of the vessel file's sensors by which a campaign names the pitch."""

_RANGE_V = 10.0


class Helm:
    """Stream of the raw counts of the set-point channel."""

    def __init__(
        self, tug: Tug, vessel: Vessel, campaign: Campaign, *, rate_hz: float, rng: np.random.Generator
    ) -> None:
        sensor = vessel.sensors.set_point
        self.logged = _set_point(sensor, scale=VOLT_PER_COUNT / sensor.slope_v, offset=float(sensor.reading(0.0)))
        self._tug = tug
        self._campaign = campaign
        self._rate_hz = rate_hz
        self._rng = rng
        self._spikes = draw_spikes(tug.noise.set_point_spike_interval_s, campaign.duration_s, rate_hz, rng)
        self._done = 0

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        voltage = helm_voltage(self._tug, self._campaign, stretch.time_s)
        noise = self._rng.standard_normal(voltage.size, dtype=np.float32)
        voltage += np.float32(self._tug.noise.set_point_rms_v) * noise
        inside = (self._spikes.sample >= self._done) & (self._spikes.sample < self._done + voltage.size)
        voltage[self._spikes.sample[inside] - self._done] = _RANGE_V * self._spikes.size[inside]
        self._done += voltage.size
        return as_counts(voltage / VOLT_PER_COUNT)

    def faults(self) -> list[Fault]:
        """Return the faults of the whole recording."""
        return [
            Fault(channel=self.logged.name, kind="spike", time_s=sample / self._rate_hz, duration_s=1.0 / self._rate_hz)
            for sample in self._spikes.sample.tolist()
        ]


class HelmMessages(Faultless, MessageSensor):
    """Stream of the raw counts of the set point that a control unit reports, message by message."""

    def __init__(
        self,
        tug: Tug,
        vessel: Vessel,
        campaign: Campaign,
        *,
        cycle_s: float,
        rate_hz: float,
        rng: np.random.Generator,
        bus: Bus,
    ) -> None:
        sensor = vessel.sensors.set_point
        super().__init__(
            _set_point(sensor, scale=tug.set_point_resolution),
            MessageTimes(bus, cycle_s=cycle_s, rng=rng),
            latency_s=sensor.message_latency_s,
            rate_hz=rate_hz,
            in_counts=lambda voltage: sensor.reading(voltage) / tug.set_point_resolution,
        )
        self._tug, self._campaign = tug, campaign

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        voltage = helm_voltage(self._tug, self._campaign, stretch.time_s)
        return float(voltage[0]), voltage


def _set_point(sensor: SetPointSensor, *, scale: float, offset: float = 0.0) -> LoggedChannel:
    return LoggedChannel(
        name=sensor.channel,
        unit=sensor.unit,
        scale=scale,
        offset=offset,
        long_name="speed set point behind the potentiometer",
    )


class PitchLever(Faultless):
    """Stream of the raw counts of the channel that asks for the pitch."""

    def __init__(self, channel: str, tug: Tug, campaign: Campaign, *, rng: np.random.Generator) -> None:
        words = "set point of the pitch of the propeller"
        self.logged = LoggedChannel(name=channel, unit="V", long_name=words)
        self._campaign = campaign
        self._rms_v = tug.noise.set_point_rms_v
        self._rng = rng

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        voltage = setpoint(self._campaign, stretch.time_s, input=PITCH_INPUT)
        voltage += self._rms_v * self._rng.standard_normal(voltage.size)
        return as_counts(voltage / VOLT_PER_COUNT)
