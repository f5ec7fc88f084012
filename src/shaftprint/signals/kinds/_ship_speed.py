"""Speed of the ship from a log, brought on the common grid.

Tests underway look at the ship below half a hertz, far below the rate of a log: values are joined by straight lines,
and what that does to a sine is known.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float, in_blocks
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, ChannelSignal
from shaftprint.signals._channels import blocks
from shaftprint.signals._gaps import clock_gaps, gaps_of_missing, joined
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState, steady_parts
from shaftprint.signals.kinds._message_reading import read_messages
from shaftprint.signals.levels._steady import SteadyStretch
from shaftprint.signals.levels._working_point import mean_of_stretches
from shaftprint.vessel._sensors import ShipSpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# Below this a ship is moored, whatever its log says [m/s].
_NO_WAY_M_S = 0.2

_HELD_RATE = 2.0
_SAME_SENDER = 1e-2
# A ship gains little speed in so short a time.
_LONGEST_GAP_S = 2.0


class ShipSpeed(ChannelKind[ShipSpeedSensor]):
    """Speed of the ship from its log [m/s], where the ship has way on."""

    sensor, name, use, role = "ship_speed", "v_s", "speed of the ship", ChannelRole.SIDE
    takes_messages = True
    absence = "the ship had no way on"

    def stated_hold_s(self, source: Source[ShipSpeedSensor]) -> None:
        """Return that equal samples say nothing: a log gives a value once in a while, as its cycle says."""
        return

    def read(self, source: Source[ShipSpeedSensor], clock: "Clock") -> Reading:
        """Return the speed on the grid."""
        latency_s = clock.latency_s(source.sensor.latency_s)
        return read_ship_speed(source.channel, source.sensor, clock, latency_s=latency_s)

    def signal(self, source: Source[ShipSpeedSensor], reading: Reading, steady: SteadyState) -> ChannelSignal | None:
        """Return the speed over that of the working point; nothing where the ship had no way on."""
        return ship_speed_signal(reading.values, source.channel, source.sensor, steady.clock, steady.stretches)


def read_ship_speed(channel: "Channel", sensor: ShipSpeedSensor, clock: "Clock", *, latency_s: float) -> Reading:
    """Return the speed of the ship [m/s] on the common grid, with what is missing.

    ``channel``: the log, one sample a value or held on the clock of the logger. ``sensor``: what the vessel file says
    of it. ``clock``: the grid. ``latency_s``: time by which the channel is taken to be late [s]. Raises SignalError if
    the channel is slower than the vessel file says, or does not cover the test.
    """
    # the period of a sender is known from its messages only
    if channel.rate_hz * sensor.cycle_s < 1.0 - (_SAME_SENDER if channel.is_uneven else 1e-6):
        raise SignalError(
            f"channel {channel.name}: expected {1.0 / sensor.cycle_s:g} values a second or more, as cycle_s = "
            f"{sensor.cycle_s:g} says, found {channel.rate_hz:g}; correct cycle_s in the vessel file."
        )
    messages = read_messages(channel) if channel.is_uneven else None
    if messages is None:
        counts = np.concatenate([part.astype(np.float64) for part in blocks(channel, clock.block_samples(channel))])
        speed = sensor.m_s_per_unit * (counts * channel.scale + channel.offset)
        time = channel.start_s - latency_s + np.arange(speed.size) / channel.rate_hz
    else:
        speed, time = sensor.m_s_per_unit * messages.values, messages.time_s - latency_s
    if np.isnan(speed).all():
        raise SignalError(
            f"channel {channel.name}: expected numbers, found none; take [sensors.ship_speed] out of the vessel file."
        )
    grid = clock.time_s
    margin = latency_s + 2.0 * sensor.cycle_s
    if grid[0] < time[0] - margin or grid[-1] > time[-1] + margin:
        raise SignalError(
            f"channel {channel.name}: expected the speed of the ship from {grid[0]:.1f} to {grid[-1]:.1f} s, found it "
            f"from {time[0]:.1f} to {time[-1]:.1f} s; take [sensors.ship_speed] out where it was not logged throughout."
        )
    if messages is not None:
        late = (
            replace(gap.earlier(latency_s), reach_s=sensor.cycle_s)
            for gap in messages.gaps
            if gap.stop_s - gap.start_s > _LONGEST_GAP_S
        )
        return replace(messages, values=np.interp(grid, time, speed), gaps=tuple(late))
    longest = _LONGEST_GAP_S * channel.rate_hz
    found = gaps_of_missing(channel, np.isnan(speed), longest=longest, reach_s=sensor.cycle_s)
    gaps = (gap.earlier(latency_s) for gap in found)
    values = np.interp(grid, time, joined(speed))
    return Reading(values=values, repairs=[], gaps=(*gaps, *clock_gaps(channel)))


def ship_speed_signal(
    speed_m_s: FloatArray,
    channel: "Channel",
    sensor: ShipSpeedSensor,
    clock: "Clock",
    stretches: tuple[SteadyStretch, ...],
) -> ChannelSignal | None:
    """Return the speed of the ship with its working point; nothing where the ship had no way on.

    ``speed_m_s``: what `read_ship_speed` gives. ``channel``, ``sensor``, ``clock``: where it comes from. ``stretches``:
    where the line stands still at the working point.
    """
    block = max(round(clock.rate_hz), 1)
    parts = steady_parts(speed_m_s, clock, stretches)
    means = [in_blocks(part, block).mean(axis=1) for part in parts]
    mean, std = mean_of_stretches(
        [float(part.mean()) for part in means],
        [float(part.std(ddof=1) / np.sqrt(part.size)) for part in means],
        np.array([stretch.duration_s for stretch in stretches]),
    )
    if mean < _NO_WAY_M_S:
        return None
    held = channel.rate_hz * sensor.cycle_s >= _HELD_RATE
    return ChannelSignal(
        name=ShipSpeed.name,
        channel=channel.name,
        role=ShipSpeed.role,
        values=frozen_float(speed_m_s),
        cycle_s=sensor.cycle_s,
        hold_s=sensor.cycle_s if held else 0.0,
        join_s=0.0 if held else 1.0 / channel.rate_hz,
        reference=mean,
        reference_std=std,
    )
