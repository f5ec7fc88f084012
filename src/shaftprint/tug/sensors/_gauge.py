"""The torque gauge: strain gauges and telemetry with everything that they add to the shaft torque."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray, IntArray
from shaftprint.kernels._compiled import compiled
from shaftprint.tug._noise import Noise
from shaftprint.tug.plant._voyage import Stretch
from shaftprint.tug.sensors._bus import MessageSensor, MessageTimes
from shaftprint.tug.sensors._counts import LoggedChannel
from shaftprint.tug.sensors._faults import Fault, draw_dropouts, draw_spikes
from shaftprint.vessel._vessel import Vessel

LOW_PASS_HZ = 500.0
"""Corner of the first-order low-pass filter in the telemetry [Hz]."""

# The logger takes a little more than full scale: 10.24 V where the telemetry gives 10 V.
_HEADROOM = 1.024


class _Telemetry(NamedTuple):
    """Constants of the telemetry, in units of N m and samples."""

    delay: float
    """Pure delay before the low-pass filter [samples]."""
    smoothing: float
    """Share of the newest value in the low-pass filter."""
    full_scale_nm: float
    resolution_nm: float
    """Step of the telemetry [N m], 0 for none."""
    zero_nm: float
    nm_per_count: float
    order: FloatArray
    """Orders of the propeller shaft, shape (orders,)."""
    amplitude: FloatArray
    """Amplitude of each order as a fraction of the load, shape (orders,)."""
    phase_rev: FloatArray
    """Phase of each order at angle zero [rev], shape (orders,)."""
    load_nm_s2: float
    """Load over the square of the shaft speed [N m s2]."""


@compiled(inline="always")
def _to_count(torque_nm, telemetry):  # type: ignore[no-untyped-def]
    """Return what the logger stores for a torque after the telemetry's steps and limits."""
    if telemetry.resolution_nm > 0.0:
        torque_nm = telemetry.resolution_nm * np.rint(torque_nm / telemetry.resolution_nm)
    torque_nm = min(max(torque_nm, -telemetry.full_scale_nm), telemetry.full_scale_nm)
    count = np.rint((torque_nm + telemetry.zero_nm) / telemetry.nm_per_count)
    return int(min(max(count, -32768.0), 32767.0))


class _Memory(NamedTuple):
    """What the read-out carries from chunk to chunk."""

    history: FloatArray
    """Ring of the true torques; its size is a power of two."""
    smooth: FloatArray
    """Value of the low-pass filter, shape (1,)."""
    place: IntArray
    """Samples done, next spike, next dropout and last count, shape (4,)."""


@compiled(inline="always")
def _ripple(angle, telemetry):  # type: ignore[no-untyped-def]
    """Return the sum of the orders at a shaft angle as a fraction of the load."""
    ripple = 0.0
    for i in range(telemetry.order.size):
        turns = telemetry.order[i] * angle + telemetry.phase_rev[i]
        ripple += telemetry.amplitude[i] * math.sin(2.0 * math.pi * (turns - math.floor(turns)))
    return ripple


@compiled(nogil=True)
def _read_out(  # type: ignore[no-untyped-def]
    torque, angle, speed, broadband, telemetry, memory, spikes, dropouts, counts
) -> None:
    """Fill the counts of one chunk: late torque, orders and noise through the low-pass filter, then the faults."""
    history, counters = memory.history, memory.place
    mask = history.size - 1
    delay = int(np.floor(telemetry.delay))
    part = telemetry.delay - delay
    smooth = memory.smooth[0]
    sample, spike, drop, last = counters[0], counters[1], counters[2], counters[3]
    for j in range(torque.size):
        history[sample & mask] = torque[j]
        late = (1.0 - part) * history[(sample - delay) & mask] + part * history[(sample - delay - 1) & mask]
        load = telemetry.load_nm_s2 * speed[j] * speed[j]
        disturbed = late + load * (_ripple(angle[j], telemetry) + broadband[j])
        smooth += telemetry.smoothing * (disturbed - smooth)
        count = _to_count(smooth, telemetry)
        if spike < spikes.sample.size and sample == spikes.sample[spike]:
            count = _to_count(spikes.size[spike] * telemetry.full_scale_nm, telemetry)
            spike += 1
        if drop < dropouts.start.size and sample >= dropouts.start[drop]:
            count = last if dropouts.holds[drop] == 1 else _to_count(-telemetry.full_scale_nm, telemetry)
            if sample + 1 >= dropouts.stop[drop]:
                drop += 1
        last = count
        counts[j] = count
        sample += 1
    memory.smooth[0] = smooth
    counters[0], counters[1], counters[2], counters[3] = sample, spike, drop, last


class TorqueGauge:
    """Stream of the raw counts of the torque channel."""

    def __init__(
        self,
        noise: Noise,
        vessel: Vessel,
        *,
        load_nm_s2: float,
        zero_offset_nm: float,
        first_torque_nm: float,
        duration_s: float,
        rate_hz: float,
        rng: np.random.Generator,
        averaging_s: float = 0.0,
    ) -> None:
        sensor = vessel.sensors.shaft_torque
        self._rng = rng
        self._rate_hz = rate_hz
        self.logged = LoggedChannel(
            name=sensor.channel,
            unit=sensor.unit,
            scale=_HEADROOM * sensor.full_scale_nm / abs(sensor.scale_nm_per_unit) / 32768.0,
            offset=sensor.live_zero,
            long_name="torque telemetry of the propeller shaft",
        )
        orders = shaft_orders(noise, vessel)
        smoothing = 1.0 - math.exp(-2.0 * math.pi * LOW_PASS_HZ / rate_hz)
        # the latency of the vessel file is that of the whole telemetry: those of its filter and mean are parts of it
        later_s = sensor.latency_s - 0.5 * averaging_s
        delay = max(0.0, later_s * rate_hz - (1.0 - smoothing) / smoothing)
        self._telemetry = _Telemetry(
            delay=delay,
            smoothing=smoothing,
            full_scale_nm=sensor.full_scale_nm,
            resolution_nm=sensor.resolution_nm or 0.0,
            zero_nm=sensor.zero_nm + zero_offset_nm,
            nm_per_count=self.logged.scale * sensor.scale_nm_per_unit,
            order=np.array(list(orders)),
            amplitude=np.array(list(orders.values())),
            phase_rev=rng.uniform(0.0, 1.0, len(orders)),
            load_nm_s2=load_nm_s2,
        )
        self._broadband = noise.torque_broadband_rms
        self._spikes = draw_spikes(noise.torque_spike_interval_s, duration_s, rate_hz, rng)
        self._dropouts = draw_dropouts(noise, duration_s, rate_hz, rng)
        self._memory = _Memory(
            history=np.full(1 << math.ceil(math.log2(delay + 4.0)), first_torque_nm),
            smooth=np.array([first_torque_nm]),
            place=np.zeros(4, dtype=np.int64),
        )

    def next(self, stretch: Stretch) -> NDArray[np.int16]:
        """Return the counts of the next stretch, shape (steps,)."""
        counts = np.empty(stretch.time_s.size, dtype=np.int16)
        broadband = self._rng.standard_normal(counts.size, dtype=np.float32) * np.float32(self._broadband)
        _read_out(
            stretch.shaft_torque_nm,
            stretch.shaft_angle_rev,
            stretch.shaft_speed_rev_s,
            broadband,
            self._telemetry,
            self._memory,
            self._spikes,
            self._dropouts,
            counts,
        )
        return counts

    def faults(self) -> list[Fault]:
        """Return the faults of the whole recording."""
        rate = self._rate_hz
        spikes = [
            Fault(channel=self.logged.name, kind="spike", time_s=sample / rate, duration_s=1.0 / rate)
            for sample in self._spikes.sample.tolist()
        ]
        drops = zip(
            self._dropouts.start.tolist(), self._dropouts.stop.tolist(), self._dropouts.holds.tolist(), strict=True
        )
        return spikes + [
            Fault(
                channel=self.logged.name,
                kind="hold" if holds else "rail",
                time_s=start / rate,
                duration_s=(stop - start) / rate,
            )
            for start, stop, holds in drops
        ]


class TorqueMessages(MessageSensor):
    """Stream of the raw counts of a torque that its telemetry sends message by message."""

    def __init__(self, gauge: TorqueGauge, times: MessageTimes, *, averaging_s: float, rate_hz: float) -> None:
        # messages carry counts of the gauge, which is late already
        super().__init__(gauge.logged, times, latency_s=0.0, rate_hz=rate_hz, in_counts=lambda counts: counts)
        self.faults = gauge.faults
        self._gauge = gauge
        self._tail: FloatArray | None = None
        self._length = round(averaging_s * rate_hz) + 1

    def _quantity(self, stretch: Stretch) -> tuple[float, FloatArray]:
        counts = self._gauge.next(stretch).astype(np.float64)
        if self._tail is None:
            self._tail = np.full(self._length - 1, counts[0])
        longer = np.concatenate([self._tail, counts])
        self._tail = longer[longer.size - (self._length - 1) :]
        means = np.lib.stride_tricks.sliding_window_view(longer, self._length).mean(axis=1)
        return float(counts[0]), means


def shaft_orders(noise: Noise, vessel: Vessel) -> dict[float, float]:
    """Return the orders of the propeller shaft in the torque with their amplitudes as fractions of the load.

    The rigid line carries none of them: they are torsional vibration around the first mode and above, which the gauge
    sees and once-a-revolution speeds do not (half an engine order would alias, but is below 0.1 % of the speed).
    """
    ratio = vessel.gearbox.ratio
    blades = float(vessel.propeller.blades)
    orders = {1.0: noise.shaft_order, blades: noise.blade_order, 2.0 * blades: noise.twice_blade_order}
    engine = vessel.engine
    if engine is None:
        return orders
    firings_per_turn = engine.cylinders * 2.0 / engine.strokes_per_cycle
    cycle = {ratio * 2.0 / engine.strokes_per_cycle: noise.half_order}
    return orders | cycle | {ratio * firings_per_turn: noise.firing_order}
