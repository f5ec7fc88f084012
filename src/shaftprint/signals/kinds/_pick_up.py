"""From one speed channel to one speed signal: pulses here, instruments and encoders in files of their own."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import SpeedSignal
from shaftprint.signals._channels import Advance, blocks, find_channel, time_of
from shaftprint.signals._gaps import Gap, bridge, clock_gaps, merged
from shaftprint.signals._signals import Repair, StripAngles
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._thesis import pulse_period_speed
from shaftprint.signals.kinds._encoder_speed import judge_encoder, read_encoder
from shaftprint.signals.kinds._grid_speed import speed_on_grid
from shaftprint.signals.kinds._instrument_speed import read_instrument
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState
from shaftprint.signals.kinds._samples_a_tooth import expect_samples, fastest_turns_hz, too_slow_for_pulses
from shaftprint.signals.kinds._speed_reading import SpeedReading
from shaftprint.signals.pulses._edges import PulseLevels, find_edges, pulse_levels
from shaftprint.signals.pulses._pulses import PulseTrain, number_pulses
from shaftprint.signals.pulses._strips import find_strips, renumbered, revolutions, steady_turns, unplaced_stretches
from shaftprint.signals.pulses._teeth import number_teeth
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._sensors import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._clock import Clock
    from shaftprint.vessel._vessel import Vessel

# Over a gap longer than this the speed cannot be told from the pulses around it.
_LONGEST_GAP_S, _LONGEST_GAP_PULSES = 1.0, 8
# Teeth are as wide as the spaces between them; strips are narrow.
_UPSIDE_DOWN = 0.6
# The end of a spline is felt so many pulses further on: by half a per cent.
_REACH_PULSES = 4
# Where there are none it is looked so long [s] for pulses that are too low: of this share of the height at least, and
# so many times the noise.
_NO_PULSES = "has no pulses"
_LOOK_S, _LEAST_PULSE, _WHOLE_PULSE, _CLEAR_OF_NOISE = 5.0, 0.1, 0.9, 8.0
# Its ends hold the pulses beside it.
_INNER = 0.8


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class PulseReading(SpeedReading):
    """What one pulse channel gives: the speed on the grid and its pulses."""

    levels: PulseLevels
    """The two levels between which the channel jumps."""


class Speed(ChannelKind[SpeedSensor]):
    """Speed of the engine from pulses, an instrument or an encoder [rev/s]; the first one counts."""

    sensor, name, use, needed = "speed", "n", "speed", True

    def sources(self, recording: "Recording", vessel: "Vessel") -> tuple[Source[SpeedSensor], ...]:
        """Return the speed channels in the order of the vessel file."""
        return tuple(
            Source(
                kind=self,
                name=sensor.name,
                channel=find_channel(
                    recording,
                    sensor.channel,
                    unit=sensor.unit,
                    use=f"{self.use} {sensor.name}",
                    takes_messages=not sensor.gives_pulses,
                    sensors=vessel.sensors,
                    ship=vessel.name,
                ),
                sensor=sensor,
                vessel=vessel,
                spare=sensor is not vessel.sensors.speed[0],
            )
            for sensor in vessel.sensors.speed
        )

    def stated_hold_s(self, source: Source[SpeedSensor]) -> float | None:
        """Return that an instrument holds nothing; levels of pulses and angles of a shaft at rest say nothing."""
        return None if source.sensor.counts_turns or source.channel.is_uneven else 0.0

    def read(self, source: Source[SpeedSensor], clock: "Clock") -> SpeedReading:
        """Return the engine-side speed on the grid."""
        vessel, wheel = source.vessel, source.sensor.toothed
        if source.sensor.gives_angle:
            return read_encoder(source, clock)
        ratio = vessel.gearbox.engine_over(source.sensor.shaft)
        if not source.sensor.gives_pulses:
            astern = vessel.working_point.turns_backward(source.sensor.shaft)
            return read_instrument(source.channel, source.sensor, clock, engine_over_shaft=ratio, astern=astern)
        # teeth that pass too fast come back as slow ones: what the recording shows is not enough
        expect_samples(source.channel, wheel, rev_s_from_rpm(vessel.working_point.engine_speed_rpm) / ratio)
        return read_pick_up(
            source.channel,
            source.sensor,
            engine_over_shaft=ratio,
            mode=clock.mode,
            start_s=clock.start_s,
            rate_hz=clock.rate_hz,
            count=clock.count,
            block_samples=clock.block_samples(source.channel),
            advance=clock.advance,
            turns_hz=rev_s_from_rpm(vessel.working_point.engine_speed_rpm) / ratio,
        )

    def judge(self, source: Source[SpeedSensor], reading: Reading) -> tuple[str, ...]:
        """Return what the reader should know; of an encoder also where its speed is far from what is expected."""
        return judge_encoder(source, reading) if source.sensor.gives_angle else reading.findings

    def signal(self, source: Source[SpeedSensor], reading: Reading, steady: SteadyState) -> SpeedSignal | None:
        """Return the speed over that of the working point."""
        if not isinstance(reading, SpeedReading):
            return None
        return SpeedSignal(
            name=source.name,
            channel=source.channel.name,
            values=frozen_float(reading.values),
            reference=steady.working_point.engine_speed_rev_s,
            reference_std=steady.working_point.engine_speed_std_rev_s,
            pulse_rate_hz=reading.pulse_rate_hz,
            by_angle=isinstance(reading, PulseReading),
            averaging_s=reading.period_s,
            hold_s=reading.period_s,
            delay_s=reading.period_s,
        )


def read_pick_up(
    channel: "Channel",
    sensor: SpeedSensor,
    *,
    engine_over_shaft: float,
    mode: Literal["shaftprint", "thesis"],
    start_s: float,
    rate_hz: float,
    count: int,
    block_samples: int,
    advance: Advance | None = None,
    turns_hz: float | None = None,
) -> PulseReading:
    """Return the engine-side speed of one pick-up on the grid.

    ``channel``, ``sensor``: the pulse channel and what the vessel file says about it. ``engine_over_shaft``: speed of
    the engine over that of the sensor's shaft. ``mode``: ``"thesis"``: pulse periods between whole samples, strip
    angles left in. ``start_s``, ``rate_hz``, ``count``: the grid. ``block_samples``: samples that are read at a time;
    the result does not depend on it. ``advance``: is told the number of samples after each block. ``turns_hz``: turns
    of its shaft a second that are expected, for messages. Raises SignalError if there are no pulses, too few or too
    many faults, or the rate is too low for them.
    """
    wheel = sensor.toothed
    levels: PulseLevels | None = None
    try:
        levels = pulse_levels(channel, edge=sensor.edge, uneven_share=wheel.uneven_share)
        edges = find_edges(blocks(channel, block_samples, advance), levels)
        train, strips = numbered_strips(edges, sensor)
    except SignalError as error:
        duty = None if levels is None else levels.duty
        slow = "" if turns_hz is None else too_slow_for_pulses(channel, sensor, turns_hz, duty)
        if not slow:
            raise
        raise SignalError(
            f"channel {channel.name}: expected pulses, found none that can be counted: {slow}."
        ) from error
    expect_samples(channel, wheel, fastest_turns_hz(channel, train, wheel))
    gaps = tuple(_named(gap, channel, levels) for gap in pulse_gaps(channel, train, sensor.pulses_per_revolution))
    time_s = time_of_edges(channel, train.position)
    seconds, pulses = _counted(train, time_s, gaps)
    turn_s = seconds / (pulses / sensor.pulses_per_revolution)
    if mode == "thesis":
        speed = pulse_period_speed(
            train, sensor.pulses_per_revolution, channel, start_s=start_s, step_s=1.0 / rate_hz, count=count
        )
        period = turn_s / sensor.pulses_per_revolution
    else:
        angle = revolutions(train, train.nominal_rev if strips is None else strips.angle_rev)
        speed = speed_on_grid(time_s, angle, start_s=start_s, rate_hz=rate_hz, count=count, channel=channel.name)
        period = 0.0
    bridge(speed, gaps, start_s=start_s, rate_hz=rate_hz)
    speed *= engine_over_shaft
    return PulseReading(
        name=sensor.name,
        channel=channel.name,
        values=speed,
        pulse_rate_hz=sensor.pulses_per_revolution / turn_s,
        period_s=period,
        strips=strips,
        levels=levels,
        repairs=pulse_repairs(channel, train, gaps),
        gaps=gaps,
        findings=(*_upside_down(sensor, levels.duty), *_taken_as_even(sensor, strips)),
    )


def numbered_strips(edges: FloatArray, sensor: SpeedSensor) -> tuple[PulseTrain, StripAngles | None]:
    """Return the numbered pulses of a channel and, with several strips, the angles between them.

    Raises SignalError if there are too few pulses, too many faults, or they come from another wheel.
    """
    teeth, wheel = sensor.pulses_per_revolution, sensor.toothed
    if wheel.missing or wheel.extra:
        train = number_teeth(edges, wheel, channel=sensor.channel)
        if not steady_turns(train, teeth):
            return train, None
        return train, replace(
            find_strips(train, teeth, channel=sensor.channel), nominal_rev=frozen_float(train.nominal_rev)
        )
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
    mean = (train.position[-1] - train.position[0]) / (train.number[-1] - train.number[0])
    ends = np.concatenate([[0.0], train.position, [float(channel.count)]])
    long = np.flatnonzero(np.diff(ends) > max(_LONGEST_GAP_S * channel.rate_hz, _LONGEST_GAP_PULSES * mean))
    stretches = [(float(ends[interval]), float(ends[interval + 1])) for interval in long]
    inner = long[(long > 0) & (long < train.position.size)] - 1
    if strips > 1 and inner.size:
        stretches += unplaced_stretches(train, strips, inner)
    lost = [
        Gap(
            channel=channel.name,
            start_s=time_of(channel, one.first),
            stop_s=time_of(channel, one.last),
            reason="has teeth that cannot be told from each other yet, as where a shaft starts,"
            if one.first <= train.position[0]
            else "has teeth in another order than before, as where a shaft stops or turns back,",
        )
        for one in train.lost
    ]
    silent = [
        Gap(
            channel=channel.name,
            start_s=time_of(channel, first),
            stop_s=time_of(channel, last),
            reason=_NO_PULSES if (first, last) in stretches[: long.size] else "has too few pulses between gaps",
        )
        for first, last in sorted(stretches)
    ]
    reach_s = _REACH_PULSES * float(mean) / channel.rate_hz
    widened = [replace(gap, reach_s=reach_s) for gap in (*silent, *lost, *clock_gaps(channel))]
    return tuple(sorted(widened, key=lambda gap: gap.start_s))


def _named(gap: Gap, channel: "Channel", levels: PulseLevels) -> Gap:
    """Return a gap without pulses, one whose pulses are there but too low to be counted said to be so."""
    if gap.reason != _NO_PULSES:
        return gap
    middle = round((0.5 * (gap.start_s + gap.stop_s) - channel.start_s) * channel.rate_hz)
    half = round(0.5 * min(_LOOK_S, _INNER * (gap.stop_s - gap.start_s)) * channel.rate_hz)
    counts = np.asarray(channel.read(max(middle - half, 0), min(middle + half, channel.count)), dtype=np.float64)
    reach = levels.high - levels.low
    share = float(np.max((counts - levels.low) / reach, initial=0.0, where=np.isfinite(counts)))
    if share * abs(reach) <= _CLEAR_OF_NOISE * levels.noise or not _LEAST_PULSE < share < _WHOLE_PULSE:
        return gap
    return replace(gap, reason=f"has pulses too low to be counted, of {share:.0%} of their usual height,")


def _counted(train: PulseTrain, time_s: FloatArray, gaps: Sequence[Gap]) -> tuple[float, float]:
    """Return the time outside of gaps [s] and the number of pulses in it."""
    seconds, pulses = float(time_s[-1] - time_s[0]), float(train.number[-1] - train.number[0])
    bare = [replace(gap, reach_s=0.0) for gap in gaps]
    # gaps overlap: what two of them take out is missing once
    for first_s, last_s in merged(bare, float(time_s[0]), float(time_s[-1])):
        inside = np.flatnonzero((time_s >= first_s) & (time_s <= last_s))
        if inside.size > 1:
            seconds -= float(time_s[inside[-1]] - time_s[inside[0]])
            pulses -= float(train.number[inside[-1]] - train.number[inside[0]])
    return seconds, pulses


def _taken_as_even(sensor: SpeedSensor, strips: StripAngles | None) -> tuple[str, ...]:
    if strips is not None or sensor.pulses_per_revolution == 1:
        return ()
    return (
        f"channel {sensor.channel} has too few steady turns to find the errors of the teeth of its wheel "
        f"{sensor.wheel}, which are taken as evenly spaced",
    )


def _upside_down(sensor: SpeedSensor, duty: float) -> tuple[str, ...]:
    if duty <= _UPSIDE_DOWN:
        return ()
    other = "rising" if sensor.edge == "falling" else "falling"
    return (
        f"channel {sensor.channel} is high for {duty:.0%} of the time: its pulses seem to point the "
        f'other way, so that the ends of the strips are timed; set edge = "{other}" in the vessel '
        "file if so",
    )
