"""The logger's view of the set points: voltages, or what a control unit reports of them."""

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._setpoint import setpoint
from shaftprint.tug._tug import Tug
from shaftprint.tug.plant._demand import helm_voltage
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import Bus, MessageStream, MessageTimes
from shaftprint.tug.sensors._faults import Fault, draw_spikes
from shaftprint.tug.sensors._pulses import VOLT_PER_COUNT
from shaftprint.vessel._vessel import Vessel

PITCH_INPUT = "pitch_set_point"
"""Table of the vessel file's sensors by which a campaign names the pitch."""

_RANGE_V = 10.0


class Helm:
    """Stream of the raw counts of the set-point channel."""

    def __init__(
        self, tug: Tug, vessel: Vessel, campaign: Campaign, *, rate_hz: float, rng: np.random.Generator
    ) -> None:
        self._sensor = vessel.sensors.set_point
        self.channel = self._sensor.channel
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
        return np.rint(voltage / VOLT_PER_COUNT).clip(-32768, 32767).astype(np.int16)

    @property
    def scale(self) -> float:
        """Value of one count in the unit of the channel."""
        return VOLT_PER_COUNT / self._sensor.slope_v

    @property
    def offset(self) -> float:
        """Value of no count in the unit of the channel."""
        return float(self._sensor.reading(0.0))

    def faults(self) -> list[Fault]:
        """Return the faults of the whole recording."""
        return [
            Fault(channel=self.channel, kind="spike", time_s=sample / self._rate_hz, duration_s=1.0 / self._rate_hz)
            for sample in self._spikes.sample.tolist()
        ]


class HelmMessages:
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
        self._sensor = vessel.sensors.set_point
        self.channel = self._sensor.channel
        self._tug, self._campaign = tug, campaign
        self.offset = 0.0
        """Value of no count, in the unit of the channel."""
        self.scale = tug.set_point_resolution
        """Value of one count, in the unit of the channel."""
        self.times = MessageTimes(bus, cycle_s=cycle_s, rng=rng)
        """When its messages come."""
        self._stream = MessageStream(self.times, latency_s=self._sensor.message_latency_s, rate_hz=rate_hz)
        self._first: float | None = None

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the messages of the next stretch, shape (messages,)."""
        return self.messages(stretch)[0]

    def messages(self, stretch: Stretch) -> tuple[NDArray[np.int16], FloatArray]:
        """Return counts and times [s] of the messages of the next stretch, each of shape (messages,)."""
        voltage = helm_voltage(self._tug, self._campaign, stretch.time_s)
        # before the start the lever stood still
        self._first = float(voltage[0]) if self._first is None else self._first
        shown, time_s = self._stream.next(voltage, first=self._first)
        counts: FloatArray = np.rint(self._sensor.reading(shown) / self.scale)
        return counts.clip(-32768, 32767).astype(np.int16), time_s

    def faults(self) -> list[Fault]:
        """Return no fault: a CAN bus sends a spoilt message again."""
        return []


class PitchLever:
    """Stream of the raw counts of the channel that asks for the pitch."""

    def __init__(self, channel: str, tug: Tug, campaign: Campaign, *, rng: np.random.Generator) -> None:
        self.channel = channel
        self._campaign = campaign
        self._rms_v = tug.noise.set_point_rms_v
        self._rng = rng

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        voltage = setpoint(self._campaign, stretch.time_s, input=PITCH_INPUT)
        voltage += self._rms_v * self._rng.standard_normal(voltage.size)
        return np.rint(voltage / VOLT_PER_COUNT).clip(-32768, 32767).astype(np.int16)

    def faults(self) -> list[Fault]:
        """Return no fault."""
        return []
