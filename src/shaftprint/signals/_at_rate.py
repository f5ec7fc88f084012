"""All channels of a recording on one clock: what is faster is filtered, what is slower or uneven joined by a spline."""

import math
from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.recording._messages import stamped_values
from shaftprint.signals._channels import blocks
from shaftprint.signals._clock import Clock
from shaftprint.signals.conditioning._decimate import decimated
from shaftprint.signals.kinds._splined_messages import comes_in_messages

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording

# A cubic spline goes through four values.
_FEWEST = 4
# Between values further apart, in periods of their channel, nothing is known.
_LONGEST_STEP = 2.5


def at_rate(recording: "Recording", rate_hz: float, *, straight: Collection[str] = ()) -> "Recording":
    """Return a recording with all channels at one rate, from the latest start to the earliest end.

    A channel that is faster goes through a filter that is flat up to a fifth of the rate and shuts at a half. Slower
    ones, and messages at times of their own, are joined by a cubic spline, which shows sines up to a fifth of their
    rate within 0.5 %, or by straight lines. Where more than one of their values in a row is missing, and a filter's
    length about missing samples, there is no number.

    ``recording``: the recording, open; closing the result closes it. ``rate_hz``: the rate [Hz]. ``straight``: names of
    slower or uneven channels that go straight from value to value, as what jumps does. Raises SignalError if the rate
    is no positive number, the channels have no time in common, or one has fewer than four values.
    """
    if not (math.isfinite(rate_hz) and rate_hz > 0.0):
        raise SignalError(f"--rate: expected a positive rate in Hz, found {rate_hz:g}.")
    channels = recording.channels.values()
    start_s = max((channel.start_s for channel in channels), default=0.0)
    stop_s = min((channel.start_s + channel.duration_s - 1.0 / channel.rate_hz for channel in channels), default=0.0)
    count = math.floor((stop_s - start_s) * rate_hz + 1e-6) + 1
    if count < 1:
        raise SignalError(
            f"{recording.path}: expected channels with a time in common, found the latest to start at {start_s:g} s "
            f"and the earliest to end at {stop_s:g} s; choose some of them (--channel)."
        )
    clock = Clock(
        start_s=start_s, rate_hz=rate_hz, count=count, mode="shaftprint", chunk_s=None, advance=lambda samples: None
    )
    moved = {name: _at_rate(channel, clock, straight=name in straight) for name, channel in recording.channels.items()}
    return replace(recording, channels=moved)


def _at_rate(channel: "Channel", clock: Clock, *, straight: bool) -> "Channel":
    if comes_in_messages(channel, clock):
        values = _joined(channel, clock.time_s, straight=straight)
    else:
        grid = clock.grid(channel)
        samples = (block.astype(np.float64) for block in blocks(channel, clock.block_samples(channel)))
        is_same_clock = grid.on_samples and grid.step == 1.0
        values = (
            np.concatenate(list(samples))[round(grid.first) :][: grid.count]
            if is_same_clock
            else decimated(samples, grid, channel=channel.name)
        )
        values = values * channel.scale + channel.offset
    return replace(
        channel,
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=clock.count,
        source=lambda start, stop: values[start:stop],
        scale=1.0,
        offset=0.0,
        clock_jumps=(),
        stamps=None,
        is_uneven=False,
    )


def _joined(channel: "Channel", grid_s: FloatArray, *, straight: bool) -> FloatArray:
    """Return values joined by straight lines or a spline; not a number where too many are missing."""
    time_s, values = stamped_values(channel, count=channel.count)
    is_number = np.isfinite(values)
    time_s, first = np.unique(time_s[is_number], return_index=True)
    values = values[is_number][first]
    if time_s.size < _FEWEST:
        raise SignalError(
            f"channel {channel.name}: expected {_FEWEST} numbers or more, found {time_s.size}; leave it out "
            "(--channel)."
        )
    joined: FloatArray = (
        np.interp(grid_s, time_s, values) if straight else scipy.interpolate.CubicSpline(time_s, values)(grid_s)
    )
    after = np.searchsorted(time_s, grid_s, side="left").clip(1, time_s.size - 1)
    is_between = np.diff(time_s)[after - 1] <= _LONGEST_STEP / channel.rate_hz
    is_inside = (grid_s >= time_s[0]) & (grid_s <= time_s[-1])
    joined[~(is_between & is_inside)] = np.nan
    return joined
