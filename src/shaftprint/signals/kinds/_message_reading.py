"""Messages as they came: the values that there are, each at its own time, and the holes between them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.errors import SignalError
from shaftprint.reasons import Note
from shaftprint.recording._messages import Messages, messages_of, stamped_values
from shaftprint.signals._gaps import Gap
from shaftprint.signals.conditioning._condition import Reading

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MessageReading(Reading):
    """A channel of messages that was read: nothing stands between them."""

    time_s: FloatArray
    """Time of each value [s], shape (values,)."""
    messages: Messages
    """What they tell of their sender."""

    def for_spline(self, *, latency_s: float) -> tuple[FloatArray, FloatArray]:
        """Return times, so much earlier [s], and values, (messages,) each, without the later of two at one time.

        Messages at one time give no spline.
        """
        time_s, first = np.unique(self.time_s - latency_s, return_index=True)
        return time_s, self.values[first]


def expect_within(came: "MessageReading", channel: "Channel", *, lowest: float = -np.inf, highest: float) -> None:
    """Raise SignalError if all numbers of a channel are beyond its smallest and largest value [unit]."""
    _, values = stamped_values(channel, count=channel.count)
    values = values[np.isfinite(values)]
    if came.values.size or not values.size:
        return
    allowed = f"at most {highest:g}" if lowest == -np.inf else f"{lowest:g} to {highest:g}"
    raise SignalError(
        f"channel {channel.name}: expected values of {allowed} {channel.unit}, found {values.min():.4g} to "
        f"{values.max():.4g}; correct the unit or the scale of the channel in the vessel file."
    )


def read_messages(
    channel: "Channel", *, lowest: float = -np.inf, highest: float = np.inf, wrong: BoolArray | None = None
) -> MessageReading:
    """Return the messages of a channel that hold a value, with the holes between them.

    ``channel``: a channel with ``stamps``. ``lowest``, ``highest``: smallest and largest value [unit]: what is beyond
    says that there is none. ``wrong``: which messages do not count beside those, shape (messages,).
    """
    time_s, values = stamped_values(channel, count=channel.count)
    # written so that what is not a number counts as missing
    is_value = (values >= lowest) & (values <= highest) & np.isfinite(values)
    if wrong is not None:
        is_value &= ~wrong
    values, time_s = values[is_value], time_s[is_value]
    messages = messages_of(time_s, values, period_s=1.0 / channel.rate_hz)
    gaps = tuple(
        Gap(channel=channel.name, start_s=hole.start_s, stop_s=hole.stop_s, reason="has no messages")
        for hole in messages.holes
    )
    return MessageReading(
        values=values,
        time_s=time_s,
        messages=messages,
        repairs=(),
        gaps=gaps,
        findings=(Note(f"Channel {channel.name} has times of its own: {messages.sentence}."),),
    )
