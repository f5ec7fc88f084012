"""Speed of a shaft from an instrument that gives a speed: rpm, Hz, rad/s, m/s, or volts and milliamperes with a line.

A channel as fast as the signals is repaired and filtered as torque is. A slower one is joined by a cubic spline, which
shows a sine too small by the same factor as the spline through pulses of that rate. Messages at times of their own are
joined the same way.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from shaftprint.errors import SignalError
from shaftprint.signals._channels import blocks
from shaftprint.signals._gaps import bridge, clock_gaps, gaps_of_missing, joined
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import FaultLimits, fault_limits
from shaftprint.signals.kinds._current_loop import alive_counts
from shaftprint.signals.kinds._kind import conditioned_on
from shaftprint.signals.kinds._message_reading import expect_within, read_messages
from shaftprint.signals.kinds._speed_reading import LONGEST_GAP_VALUES, REACH_VALUES, SpeedReading
from shaftprint.signals.kinds._splined_messages import comes_in_messages, no_numbers, splined, unknown_age
from shaftprint.vessel._current_loop import LIVE_ZERO_MA
from shaftprint.vessel._sensors import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# A line through zero speed at 4 mA, to this share of the speed at 20 mA.
_AT_ZERO = 0.02


def read_instrument(
    channel: "Channel", sensor: SpeedSensor, clock: "Clock", *, engine_over_shaft: float, astern: bool = False
) -> SpeedReading:
    """Return the engine-side speed of an instrument on the grid.

    ``channel``, ``sensor``: the channel and what the vessel file says about it. ``clock``: the grid.
    ``engine_over_shaft``: speed of the engine over that of the sensor's shaft. ``astern``: whether the shaft turns
    astern: instruments show that as a speed below zero, or do not tell. Raises SignalError if the channel holds no
    numbers, or a speed below zero throughout.
    """
    latency_s = clock.latency_s(sensor.latency_s)
    if not comes_in_messages(channel, clock):
        reading = conditioned_on(clock, channel, instrument_limits(channel, sensor), latency_s)
    else:
        reading = _splined(channel, sensor, clock, latency_s)
        if sensor.latency_std_s is None:
            age = unknown_age(channel, field="latency_std_s of its sensors.speed")
            reading = replace(reading, findings=(*reading.findings, age))
    shown = reading.of(sensor.speed_rev_s, earlier_s=latency_s)
    ahead = -1.0 if astern and shown.values.mean() < 0.0 else 1.0
    shown = shown.of(lambda speed: ahead * engine_over_shaft * speed)
    mean_rpm = 60.0 * float(shown.values.mean())
    if not mean_rpm > 0.0:
        raise SignalError(
            f"channel {channel.name}: expected a speed ahead, found a mean of {mean_rpm:.4g} rpm at the "
            "engine; correct unit, rpm_per_unit and rpm_at_zero in the vessel file, or the sign of the channel, or "
            'state direction = "astern" of its working point where the shaft turned so.'
        )
    return SpeedReading(
        values=shown.values,
        repairs=shown.repairs,
        gaps=shown.gaps,
        sent=shown.sent,
        name=sensor.name,
        channel=channel.name,
        pulse_rate_hz=channel.rate_hz,
        findings=reading.findings,
    )


def instrument_limits(channel: "Channel", sensor: SpeedSensor) -> FaultLimits:
    """Return what counts as a fault of an instrument: of 4 to 20 mA what is clearly outside."""
    limits = fault_limits(channel, holds=False)
    if sensor.unit != "mA":
        return limits
    zero, full = sensor.speed_rev_s([LIVE_ZERO_MA, 20.0])
    if abs(zero) > _AT_ZERO * abs(full):
        return limits
    lowest, highest = alive_counts(channel)
    return replace(limits, lowest=lowest, highest=highest)


def _splined(channel: "Channel", sensor: SpeedSensor, clock: "Clock", latency_s: float) -> Reading:
    """Return a channel that is slower than the grid, in its own unit on the grid."""
    limits = instrument_limits(channel, sensor)
    if channel.stamps is not None:
        return _splined_messages(channel, limits, clock, latency_s)
    counts = np.concatenate([part.astype(np.float64) for part in blocks(channel, clock.block_samples(channel))])
    missing = np.isnan(counts) | (counts <= limits.lowest) | (counts >= limits.highest)
    if missing.all():
        raise no_numbers(channel)
    values = joined(np.where(missing, np.nan, counts)) * channel.scale + channel.offset
    time_s = channel.start_s - latency_s + np.arange(values.size) / channel.rate_hz
    on_grid = scipy.interpolate.CubicSpline(time_s, values)(clock.time_s.clip(time_s[0], time_s[-1]))
    reach_s = REACH_VALUES / channel.rate_hz
    gaps = gaps_of_missing(channel, missing, longest=LONGEST_GAP_VALUES, reach_s=reach_s)
    bridge(on_grid, gaps, start_s=clock.start_s + latency_s, rate_hz=clock.rate_hz)
    return Reading(values=on_grid, repairs=[], gaps=(*gaps, *clock_gaps(channel)))


def _splined_messages(channel: "Channel", limits: FaultLimits, clock: "Clock", latency_s: float) -> Reading:
    """Return messages at times of their own, in their own unit on the grid."""
    ends = sorted(end * channel.scale + channel.offset for end in (limits.lowest, limits.highest))
    came = read_messages(channel, lowest=ends[0], highest=ends[1])
    expect_within(came, channel, lowest=ends[0], highest=ends[1])
    return splined(came, channel, clock, latency_s)
