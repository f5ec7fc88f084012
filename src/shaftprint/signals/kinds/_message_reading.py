"""Messages as they came: the values that there are, each at its own time, and the holes between them."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.recording import Messages, messages_of
from shaftprint.signals._channels import DEFAULT_BLOCK_SAMPLES
from shaftprint.signals._gaps import Gap
from shaftprint.signals.conditioning import Reading

if TYPE_CHECKING:
    from shaftprint.recording import Channel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MessageReading(Reading):
    """A channel of messages that was read: nothing stands between them."""

    time_s: FloatArray
    """Time of each value [s], shape (values,)."""
    messages: Messages
    """What they tell of their sender."""


def read_messages(channel: "Channel", *, lowest: float = -np.inf, highest: float = np.inf) -> MessageReading:
    """Return the messages of a channel that hold a value, with the holes between them.

    Parameters
    ----------
    channel
        A channel with ``stamps``.
    lowest, highest
        Smallest and largest value [unit]: what is beyond says that there is none.
    """
    blocks = range(0, channel.count, DEFAULT_BLOCK_SAMPLES)
    spans = [(start, min(start + DEFAULT_BLOCK_SAMPLES, channel.count)) for start in blocks]
    values = np.concatenate([channel.values(*span) for span in spans])
    time_s = np.concatenate([channel.stamps_s(*span) for span in spans])
    # written so that what is not a number counts as missing
    is_value = (values >= lowest) & (values <= highest) & np.isfinite(values)
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
        findings=(f"Channel {channel.name} has times of its own: {messages.sentence}.",),
    )
