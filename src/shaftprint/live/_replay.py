"""A recording judged as if it came in now: what would have been shown."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._leg import Leg
from shaftprint.live._block import Block, DeviceMode, DeviceStatus, LiveChannel
from shaftprint.live._judgement import LineJudgement
from shaftprint.live._lines import LineJudge

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.vessel._vessel import Vessel

BLOCK_S = 0.05
"""Length of the blocks that a recording is cut into [s]."""


def judged_channels(channels: "tuple[LiveChannel, ...]", vessel: "Vessel") -> tuple[LiveChannel, ...]:
    """Return the channels whose lines are judged: the set point, and what is no pulses and goes on as evenly."""
    sensors = vessel.sensors
    pulses = {one.channel for one in sensors.speed if one.counts_turns}
    (set_point,) = (one for one in channels if one.name == sensors.set_point.channel)
    return tuple(one for one in channels if one.name not in pulses and one.rate_hz == set_point.rate_hz)


def replayed(
    recording: "Recording", vessel: "Vessel", campaign: "Campaign", *, block_s: float = BLOCK_S
) -> Iterator[tuple[float, str, tuple[LineJudgement, ...]]]:
    """Yield when a period of a test has ended [s], the name of the test, and what is known of its lines then.

    Parameters
    ----------
    recording
        Of a test, live or not.
    vessel
        What its channels are.
    campaign
        As it was played, by the time of the recording.
    block_s
        Length of the blocks [s].
    """
    by_name = {name: one for name, one in recording.channels.items() if not one.is_uneven}
    sensor = vessel.sensors.set_point.channel
    clock = recording.channel(sensor)
    channels = judged_channels(tuple(_announced(one) for one in by_name.values()), vessel)
    tests = [one for one in campaign.excitations if isinstance(one, Sine | Leg)]
    judges = [(one, LineJudge(one, zero_s=0.0, channels=channels, set_point=sensor)) for one in tests]
    samples = max(1, round(block_s * clock.rate_hz))
    for number, (first, last) in enumerate(clock.blocks(samples)):
        block = _block(number, first, last, clock, [by_name[one.name] for one in channels])
        for test, judge in judges:
            if test.start_s <= block.stop_s and block.source_s <= test.stop_s and judge.take(block):
                yield block.stop_s, test.name, judge.judgements()


def _announced(channel: "Channel") -> LiveChannel:
    return LiveChannel(name=channel.name, unit=channel.unit, rate_hz=channel.rate_hz)


def _block(number: int, first: int, last: int, clock: "Channel", channels: "list[Channel]") -> Block:
    start_s = clock.start_s + first / clock.rate_hz
    return Block(
        counter=number,
        source_s=start_s,
        span_s=(last - first) / clock.rate_hz,
        samples={one.name: one.values(first, min(last, one.count)) for one in channels if first < one.count},
        device=DeviceStatus(mode=DeviceMode.LEVER, heartbeat=0, set_point_v=0.0),
        received_s=start_s,
    )
