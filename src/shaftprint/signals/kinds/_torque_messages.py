"""Shaft torque that a telemetry sends in messages: what cannot be true is left out, the others are joined.

What a sender does between two messages is not told by them: a value may be that of the instant at which it is sent,
older by up to a period, or the mean since the one before. The latency of the vessel file is to hold all of it; where
that states no deviation, `survey.priors_of` counts a period's worth.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray
from shaftprint.signals._channels import blocks
from shaftprint.signals.conditioning._outliers import FaultLimits, flagged
from shaftprint.signals.conditioning._patch import Patcher
from shaftprint.signals.kinds._kind import Source
from shaftprint.signals.kinds._message_reading import MessageReading, read_messages
from shaftprint.signals.kinds._splined_messages import splined, unknown_age
from shaftprint.vessel._shaft_torque import ShaftTorqueSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock
    from shaftprint.signals._signals import Repair


def torque_messages(
    source: Source[ShaftTorqueSensor], limits: FaultLimits, clock: "Clock", latency_s: float
) -> MessageReading:
    """Return the torque of messages, or of samples slower than the grid, on the grid [unit of the channel].

    ``source``: the channel. ``limits``: what counts as a fault of it. ``clock``: the grid. ``latency_s``: time by which
    the values are late [s]. Raises SignalError if there are too few.
    """
    channel = source.channel
    wrong, repairs = _faults(channel, limits, clock)
    messages = read_messages(channel, wrong=wrong)
    reading = splined(messages, channel, clock, latency_s)
    age = (unknown_age(channel, field="sensors.shaft_torque.latency_std_s"),)
    findings = messages.findings if channel.is_uneven else ()
    return replace(reading, repairs=repairs, findings=findings + (age if source.sensor.latency_std_s is None else ()))


def _faults(channel: "Channel", limits: FaultLimits, clock: "Clock") -> "tuple[BoolArray, list[Repair]]":
    """Return which values cannot be true, shape (messages,), and what they are, at the times of their messages."""
    raw = np.concatenate(list(blocks(channel, clock.block_samples(channel), clock.advance)))
    repairs: list[Repair] = []
    patcher = Patcher(channel=channel, limits=limits, repairs=repairs)
    patched = np.concatenate(list(patcher.patched(flagged([raw], limits))))
    wrong: BoolArray = ~(patched == raw)
    for gap in patcher.gaps:
        wrong[_message_at(channel, gap.start_s) : _message_at(channel, gap.stop_s)] = True
    stamps_s = channel.stamps_s(0, channel.count)
    at_stamps = [replace(repair, time_s=float(stamps_s[_message_at(channel, repair.time_s)])) for repair in repairs]
    return wrong, at_stamps


def _message_at(channel: "Channel", by_rate_s: float) -> int:
    """Return which message a time means that was counted by the rate alone."""
    return round((by_rate_s - channel.start_s) * channel.rate_hz)
