"""Arming: nothing is played before channels, heartbeat and revert were seen, and somebody on the bridge has agreed."""

import asyncio
import math
from typing import TYPE_CHECKING, Protocol

import numpy as np

from shaftprint.errors import LiveError
from shaftprint.live._block import DeviceMode
from shaftprint.live._counterpart import REVERT_S
from shaftprint.live._watch import MISSING_S, Rest

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from shaftprint.arrays import FloatArray
    from shaftprint.live._counterpart import Counterpart
    from shaftprint.live._sight import Sight

ALIVE_S = 10.0
"""Time for which all channels are looked at before anything is taken over [s]."""
# The lever stands where the campaign begins, to so many volts.
_SAME_V = 0.05
# Deviation of the speed at rest over its mean: in waves and wake, and where it swings at one frequency, which then has
# this share of its power. Sound ships of the benchmarks swing by 0.6 to 1.5 %, one frequency having 0.2 to 0.63 of it.
_STEADY, _SWINGING, _OF_ONE = 0.03, 0.01, 0.7
# So long somebody has to answer the heartbeat, or to give a device that reverts late away [s].
_ANSWER_S, _LATE_S = 1.0, 2.0


class Ground(Protocol):
    """What an arming test stands on: the loop that reads blocks, records them and sends heartbeats."""

    beats: bool
    """Whether heartbeats are sent."""

    async def next(self) -> "Sight":
        """Return what the next block shows."""

    @property
    def unanswered_s(self) -> float:
        """For how long the oldest heartbeat has not been answered [s]."""


async def seen_at_rest(
    ground: Ground, counterpart: "Counterpart", *, offset_v: float, alive_s: float = ALIVE_S
) -> Rest:
    """Look at the channels for some seconds while the lever rules; return what they show at rest.

    Raises LiveError if a channel is no number or repeats itself, blocks are lost, or the lever stands elsewhere than at
    ``offset_v``.
    """
    sights: list[Sight] = [await ground.next()]
    while sights[-1].time_s - sights[0].time_s < alive_s:
        sights.append(await ground.next())
    name = counterpart.name
    mode = sights[-1].block.device.mode
    if mode is not DeviceMode.LEVER:
        raise LiveError(f'{name}: expected the lever to rule before the test, found "{mode}"; release it.')
    lost = sights[-1].block.counter - sights[0].block.counter - (len(sights) - 1)
    if lost:
        raise LiveError(f"{name}: expected every block of {alive_s:g} s, found {lost} lost; mend the link first.")
    for channel in sights[0].means:
        means = np.array([one.means.get(channel, math.nan) for one in sights])
        if not np.isfinite(means).all():
            raise LiveError(f"{name}: expected numbers in channel {channel}, found some that are none.")
        if _longest_repetition_s(sights, channel) > MISSING_S:
            raise LiveError(f"{name}: expected channel {channel} to be alive, found the same samples again and again.")
    volts = sights[-1].block.device.set_point_v
    if abs(volts - offset_v) > _SAME_V:
        raise LiveError(
            f"{name}: expected the lever at {offset_v:g} V, where the campaign begins, found {volts:.4g} V; move it "
            "there, so that nothing jumps when the test ends."
        )
    shown_v = np.array([one.set_point_v - one.block.device.set_point_v for one in sights])
    speeds = np.array([one.speed_rpm for one in sights])
    speeds = speeds[np.isfinite(speeds)]
    if speeds.size < len(sights) // 2:
        raise LiveError(f"{name}: expected an engine that runs, found no speed.")
    deviation, most = speeds.std() / speeds.mean(), _STEADY
    if _share_of_one(speeds) > _OF_ONE:
        most = _SWINGING
    if deviation > most:
        kind = "swings at one frequency" if most == _SWINGING else "wanders"
        raise LiveError(
            f"{name}: expected a speed that {kind} by at most {100.0 * most:g} % at rest, found a deviation of "
            f"{speeds.std():.3g} rpm at {speeds.mean():.5g} rpm; a governor that hunts is not tested."
        )
    return Rest(
        set_point_offset_v=float(np.median(shown_v)),
        set_point_std_v=float(shown_v.std()),
        speed_rpm=float(speeds.mean()),
        speed_std_rpm=float(speeds.std()),
        volts=volts,
    )


async def expect_revert(ground: Ground, counterpart: "Counterpart") -> float:
    """Prove that heartbeats are answered, and that without them the lever rules again; return after how long [s].

    Raises LiveError if either was not seen: a device that does not revert is never armed.
    """
    name = counterpart.name
    ground.beats = True
    first = last = await ground.next()
    while last.time_s - first.time_s < _ANSWER_S:
        last = await ground.next()
    if ground.unanswered_s > MISSING_S or not last.block.device.heartbeat:
        raise LiveError(f"{name}: expected the heartbeat back within {MISSING_S:g} s, found none.")
    last = await _taken(ground, counterpart)
    ground.beats = False
    stopped_s = last.time_s
    while True:
        last = await ground.next()
        if last.block.device.mode is DeviceMode.LEVER:
            break
        if last.time_s - stopped_s > REVERT_S + _LATE_S:
            await counterpart.release()
            raise LiveError(
                f"{name}: expected it to give the set point back to the lever within {REVERT_S:g} s without heartbeat, "
                f"found that it still rules after {last.time_s - stopped_s:.1f} s; nothing may be armed with it."
            )
    took_s = last.time_s - stopped_s
    # the block that shows it may have begun before
    if took_s - last.block.span_s > REVERT_S:
        raise LiveError(
            f"{name}: expected it to give the set point back to the lever within {REVERT_S:g} s without heartbeat, "
            f"found {took_s:.2f} s; shorten its time."
        )
    return took_s


async def taken_over(
    ground: Ground, counterpart: "Counterpart", confirm: "Callable[[str], Awaitable[bool]]"
) -> "Sight":
    """Take the set point over once somebody on the bridge has agreed; return the block that shows it.

    Raises LiveError if nobody does, or the device does not.
    """
    name = counterpart.name
    asked = asyncio.ensure_future(confirm("The lever gives way to the program at the next yes. Is the bridge ready?"))
    try:
        while not asked.done():
            await ground.next()
    finally:
        asked.cancel()
    if not asked.result():
        raise LiveError(f"{name}: expected the bridge to agree, found no; nothing was taken over.")
    ground.beats = True
    first = last = await ground.next()
    while last.block.device.heartbeat == first.block.device.heartbeat and last.time_s - first.time_s < _ANSWER_S:
        last = await ground.next()
    if not last.block.device.is_enabled:
        raise LiveError(f"{name}: expected the key on the bridge to be on, found it off.")
    return await _taken(ground, counterpart)


def _share_of_one(speeds: "FloatArray") -> float:
    """Return how much of the power of the speed is at its strongest frequency: nearly all where a governor hunts."""
    time = np.linspace(-1.0, 1.0, speeds.size)
    rest = speeds - np.polyval(np.polyfit(time, speeds, 1), time)
    power = np.abs(np.fft.rfft(rest * np.hanning(rest.size))) ** 2
    power[0] = 0.0
    strongest = int(np.argmax(power))
    return float(power[max(strongest - 1, 0) : strongest + 2].sum() / max(float(power.sum()), 1e-300))


def _longest_repetition_s(sights: "list[Sight]", channel: str) -> float:
    """Return for how long a channel has repeated the samples of a block [s]."""
    longest_s = repeated_s = 0.0
    before = None
    for sight in sights:
        samples = sight.block.samples.get(channel)
        same = before is not None and samples is not None and np.array_equal(before, samples)
        repeated_s = repeated_s + sight.block.span_s if same else 0.0
        longest_s, before = max(longest_s, repeated_s), samples
    return longest_s


async def _taken(ground: Ground, counterpart: "Counterpart") -> "Sight":
    """Take the set point over, and return the block that shows it.

    Raises LiveError if none does in time.
    """
    await counterpart.take()
    last = first = await ground.next()
    while last.block.device.mode is not DeviceMode.HELD and last.time_s - first.time_s < _ANSWER_S:
        last = await ground.next()
    if last.block.device.mode is not DeviceMode.HELD:
        raise LiveError(
            f'{counterpart.name}: expected it to take the set point over, found "{last.block.device.mode}".'
        )
    return last
