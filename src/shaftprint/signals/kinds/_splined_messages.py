"""Messages at times of their own on the common grid, joined by a cubic spline."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import scipy

from shaftprint.errors import SignalError
from shaftprint.signals._gaps import bridge
from shaftprint.signals.conditioning._condition import SentValues
from shaftprint.signals.kinds._message_reading import MessageReading
from shaftprint.signals.kinds._speed_reading import REACH_VALUES
from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# A cubic spline goes through four values.
_FEWEST_MESSAGES = 4


def comes_in_messages(channel: "Channel", clock: "Clock") -> bool:
    """Return whether a spline has to join the values of a channel: they are slower than the grid, or on no clock."""
    return channel.is_uneven or channel.rate_hz < clock.rate_hz


def splined(messages: MessageReading, channel: "Channel", clock: "Clock", latency_s: float) -> MessageReading:
    """Return messages with their values on the grid, in the unit of the channel, and what their holes cost there.

    ``messages``: what was read; times are those of the messages, also in what is returned. ``channel``: where they come
    from. ``clock``: the grid. ``latency_s``: time by which they are late [s]. Raises SignalError if there are fewer
    than four.
    """
    time_s, values = messages.for_spline(latency_s=latency_s)
    if time_s.size < _FEWEST_MESSAGES:
        raise no_numbers(channel)
    on_grid = scipy.interpolate.CubicSpline(time_s, values)(clock.time_s.clip(time_s[0], time_s[-1]))
    gaps = tuple(replace(gap, reach_s=REACH_VALUES / channel.rate_hz) for gap in messages.gaps)
    bridge(on_grid, gaps, start_s=clock.start_s + latency_s, rate_hz=clock.rate_hz)
    sent = SentValues(time_s=time_s, values=values, rate_hz=channel.rate_hz)
    return replace(messages, values=on_grid, gaps=gaps, sent=sent)


def unknown_age(channel: "Channel", *, field: str) -> str:
    """Return what is assumed of messages whose age the vessel file does not limit.

    ``channel``: where they come from. ``field``: where the vessel file would.
    """
    period_ms = MILLI / channel.rate_hz
    return (
        f"Values of channel {channel.name} may be up to a message of {period_ms:.3g} ms old, or means since the one "
        f"before: {period_ms / math.sqrt(12.0):.2g} ms are counted beside their latency; state {field} where it is "
        "known better."
    )


def no_numbers(channel: "Channel") -> SignalError:
    """Return the error of a channel without numbers."""
    return SignalError(f"channel {channel.name}: expected numbers, found none; check the export of the logger.")
