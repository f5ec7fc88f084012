"""From one pulse channel to one speed signal."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.signals._channels import Advance, blocks, time_of
from shaftprint.signals._edges import find_edges, pulse_levels
from shaftprint.signals._gaps import Gap, bridge, clock_gaps
from shaftprint.signals._pulses import PulseTrain, number_pulses
from shaftprint.signals._signals import Repair, SpeedSignal, StripAngles
from shaftprint.signals._speed import spline_speed
from shaftprint.signals._strips import find_strips, renumbered, revolutions, unplaced_stretches
from shaftprint.signals._thesis import pulse_period_speed

if TYPE_CHECKING:
    from shaftprint.recording import Channel
    from shaftprint.vessel import SpeedSensor

# Over a gap longer than this the speed cannot be told from the pulses around it.
_LONGEST_GAP_S, _LONGEST_GAP_PULSES = 1.0, 8
# The end of a spline is felt so many pulses further on: by half a per cent.
_REACH_PULSES = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class PickUp:
    """What one pulse channel gives."""

    speed: SpeedSignal
    """The speed on the grid."""
    strips: StripAngles | None
    """Angles between the strips, where there are several."""
    repairs: tuple[Repair, ...]
    """Pulses that were missing or doubled."""
    gaps: tuple[Gap, ...]
    """Stretches without pulses, in order of time."""
    findings: tuple[str, ...]
    """What the reader should know."""


def read_pick_up(
    channel: "Channel",
    sensor: "SpeedSensor",
    *,
    gear_ratio: float,
    mode: Literal["shaftprint", "thesis"],
    start_s: float,
    rate_hz: float,
    count: int,
    block_samples: int,
    advance: Advance | None = None,
) -> PickUp:
    """Return the engine-side speed of one pick-up on the grid.

    Parameters
    ----------
    channel, sensor
        The pulse channel and what the vessel file says about it.
    gear_ratio
        Engine speed over propeller-shaft speed.
    mode
        ``"thesis"``: pulse periods between whole samples, strip angles left in.
    start_s, rate_hz, count
        The grid.
    block_samples
        Samples that are read at a time; the result does not depend on it.
    advance
        Is told the number of samples after each block.

    Raises
    ------
    SignalError
        If there are no pulses, too few or too many faults.
    """
    levels = pulse_levels(channel, edge=sensor.edge)
    edges = find_edges(blocks(channel, block_samples, advance), levels)
    train, strips = numbered_strips(edges, sensor)
    gaps = pulse_gaps(channel, train, sensor.pulses_per_revolution)
    ratio = gear_ratio if sensor.shaft == "propeller" else 1.0
    time_s = time_of_edges(channel, train.position)
    seconds, pulses = _counted(train, time_s, gaps)
    turn_s = seconds / (pulses / sensor.pulses_per_revolution)
    if mode == "thesis":
        speed = pulse_period_speed(
            train, sensor.pulses_per_revolution, channel, start_s=start_s, step_s=1.0 / rate_hz, count=count
        )
        period = turn_s / sensor.pulses_per_revolution
    else:
        angle = train.number.astype(np.float64) if strips is None else revolutions(train, strips.angle_rev)
        speed = spline_speed(time_s, angle, start_s=start_s, step_s=1.0 / rate_hz, count=count)
        period = 0.0
    bridge(speed, gaps, start_s=start_s, rate_hz=rate_hz)
    speed *= ratio
    return PickUp(
        speed=SpeedSignal(
            name=sensor.name,
            channel=channel.name,
            speed_rev_s=frozen_float(speed),
            pulse_rate_hz=sensor.pulses_per_revolution / turn_s,
            averaging_s=period,
            hold_s=period,
            delay_s=period,
        ),
        strips=strips,
        repairs=pulse_repairs(channel, train, gaps),
        gaps=gaps,
        findings=_upside_down(sensor, levels.duty),
    )


def numbered_strips(edges: FloatArray, sensor: "SpeedSensor") -> tuple[PulseTrain, StripAngles | None]:
    """Return the numbered pulses of a channel and, with several strips, the angles between them.

    Raises
    ------
    SignalError
        If there are too few pulses or too many faults.
    """
    train = number_pulses(edges, channel=sensor.channel)
    if sensor.pulses_per_revolution == 1:
        return train, None
    number, _ = renumbered(train, sensor.pulses_per_revolution)
    train = replace(train, number=number)
    return train, find_strips(train, sensor.pulses_per_revolution, channel=sensor.channel)


def time_of_edges(channel: "Channel", position: FloatArray) -> FloatArray:
    """Return the times of edges in seconds of the recording, shape of ``position``."""
    return channel.start_s + position / channel.rate_hz


def pulse_repairs(channel: "Channel", train: PulseTrain, gaps: Sequence[Gap]) -> tuple[Repair, ...]:
    """Return the faults of a pulse train outside of its gaps as repairs, in order of time."""
    repairs = (
        Repair(
            channel=channel.name,
            kind=fault.kind,
            time_s=time_of(channel, fault.position),
            count=fault.count,
        )
        for fault in train.faults
    )
    return tuple(repair for repair in repairs if not any(gap.start_s < repair.time_s < gap.stop_s for gap in gaps))


def pulse_gaps(channel: "Channel", train: PulseTrain, strips: int) -> tuple[Gap, ...]:
    """Return the stretches of more than a second and eight pulses in which there are none, in order of time.

    With several strips a stretch behind a gap that is too short to show at which strip it begins belongs to the gap.
    """
    mean = (train.position[-1] - train.position[0]) / train.number[-1]
    ends = np.concatenate([[0.0], train.position, [float(channel.count)]])
    long = np.flatnonzero(np.diff(ends) > max(_LONGEST_GAP_S * channel.rate_hz, _LONGEST_GAP_PULSES * mean))
    stretches = [(float(ends[place]), float(ends[place + 1])) for place in long]
    inner = long[(long > 0) & (long < train.position.size)] - 1
    if strips > 1 and inner.size:
        stretches += unplaced_stretches(train, strips, inner)
    silent = [
        Gap(
            channel=channel.name,
            start_s=time_of(channel, first),
            stop_s=time_of(channel, last),
            reason="has no pulses" if (first, last) in stretches[: long.size] else "has too few pulses between gaps",
        )
        for first, last in sorted(stretches)
    ]
    reach_s = _REACH_PULSES * float(mean) / channel.rate_hz
    found = [replace(gap, reach_s=reach_s) for gap in (*silent, *clock_gaps(channel))]
    return tuple(sorted(found, key=lambda gap: gap.start_s))


def _counted(train: PulseTrain, time_s: FloatArray, gaps: Sequence[Gap]) -> tuple[float, float]:
    """Return the time outside of gaps [s] and the number of pulses in it."""
    seconds, pulses = float(time_s[-1] - time_s[0]), float(train.number[-1])
    for gap in gaps:
        inside = np.flatnonzero((time_s >= gap.start_s) & (time_s <= gap.stop_s))
        if inside.size > 1:
            seconds -= float(time_s[inside[-1]] - time_s[inside[0]])
            pulses -= float(train.number[inside[-1]] - train.number[inside[0]])
    return seconds, pulses


def _upside_down(sensor: "SpeedSensor", duty: float) -> tuple[str, ...]:
    if duty <= 0.5:
        return ()
    other = "rising" if sensor.edge == "falling" else "falling"
    return (
        f"channel {sensor.channel} is high for {duty:.0%} of the time: its pulses seem to point the "
        f'other way, so that the ends of the strips are timed; set edge = "{other}" in the vessel '
        "file if so",
    )
