"""What a channel shows, on a grid of its own clock: for comparing two recordings before they share a clock."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channels import DEFAULT_BLOCK_SAMPLES, blocks, expect_one_clock
from shaftprint.signals._gaps import joined
from shaftprint.signals.conditioning._condition import conditioned
from shaftprint.signals.conditioning._decimate import SampleGrid
from shaftprint.signals.conditioning._outliers import fault_limits
from shaftprint.signals.kinds._encoder_speed import speed_channel
from shaftprint.signals.kinds._pick_up import read_pick_up

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.vessel._sensors import SpeedSensor


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Content:
    """What a channel shows."""

    name: str
    """Name of the channel."""
    start_s: float
    """Time of the first value on the channel's clock [s]."""
    rate_hz: float
    """Values a second of that clock [Hz]."""
    values: FloatArray
    """Speed in rev/s of a speed channel, else the channel's own unit, shape (samples,)."""

    @property
    def time_s(self) -> FloatArray:
        """Times of the values on the channel's clock [s], shape (samples,)."""
        return self.start_s + np.arange(self.values.size) / self.rate_hz


def content_of(channel: "Channel", sensor: "SpeedSensor | None" = None, *, rate_hz: float) -> Content:
    """Return what a channel shows, free of faults and of what is faster than the grid.

    Parameters
    ----------
    channel
        The channel.
    sensor
        What the vessel file says about it where it holds pulses, a speed or the angle of an encoder: then the speed of
        that shaft is shown.
    rate_hz
        Rate of the grid [Hz]; that of the channel where it is slower and holds no pulses.

    Raises
    ------
    SignalError
        If the channel has no samples, no number among them, or pulses cannot be told.
    """
    if channel.count == 0:
        raise SignalError(f"channel {channel.name}: expected samples, found none.")
    if sensor is not None and sensor.counts_turns:
        expect_one_clock(channel, "pulses or an angle")
    if sensor is not None and sensor.gives_angle:
        channel, sensor = speed_channel(channel, sensor), None
    pulses = sensor if sensor is not None and sensor.gives_pulses else None
    if pulses is None and (channel.stamps is not None or channel.rate_hz <= rate_hz):
        counts = np.concatenate(list(blocks(channel, DEFAULT_BLOCK_SAMPLES))).astype(np.float64)
        rate_hz = min(channel.rate_hz, rate_hz)
        if channel.stamps is None:
            values = joined(counts) * channel.scale + channel.offset
        else:
            # each at its own stamp: on a clock that begins with the first of them all would err by its jitter
            there = ~np.isnan(counts)
            if not there.any():
                raise SignalError(f"channel {channel.name}: expected samples, found none that is a number.")
            even_s = channel.start_s + np.arange(int(channel.duration_s * rate_hz)) / rate_hz
            values = np.interp(even_s, channel.stamps_s(0, channel.count)[there], counts[there])
            values = values * channel.scale + channel.offset
    elif pulses is None:
        step = channel.rate_hz / rate_hz
        grid = SampleGrid(first=0.0, step=step, count=int((channel.count - 1) / step) + 1)
        limits = fault_limits(channel, holds=False)
        values = conditioned(channel, limits, grid, mode="shaftprint", block_samples=DEFAULT_BLOCK_SAMPLES).values
    else:
        values = read_pick_up(
            channel,
            pulses,
            engine_over_shaft=1.0,
            mode="shaftprint",
            start_s=channel.start_s,
            rate_hz=rate_hz,
            count=int(channel.duration_s * rate_hz),
            block_samples=DEFAULT_BLOCK_SAMPLES,
        ).values
    if sensor is not None and pulses is None:
        values = sensor.speed_rev_s(values)
    return Content(name=channel.name, start_s=channel.start_s, rate_hz=rate_hz, values=frozen_float(values))
