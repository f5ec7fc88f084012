"""Speed of a shaft from the angle that an encoder shows, in degrees, radians, turns or counts.

What the shaft turns from one sample to the next is its mean speed in between. An angle that begins again turns by less
than half of its range from sample to sample, so that the difference says whether it did. Where samples are few, or
messages at times of their own, the spline through the angles is differentiated, as that of pulses is.
"""

from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from shaftprint.arrays import FloatArray, runs_of
from shaftprint.errors import SignalError
from shaftprint.signals._channels import Counts
from shaftprint.signals._gaps import Gap, bridge, clock_gaps, gaps_of_missing, joined
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.conditioning._outliers import fault_limits
from shaftprint.signals.kinds._angle_range import angle_range, range_of_small_steps, wrapped
from shaftprint.signals.kinds._kind import Source, conditioned_on
from shaftprint.signals.kinds._message_reading import read_messages
from shaftprint.signals.kinds._speed_reading import LONGEST_GAP_VALUES, REACH_VALUES, SpeedReading
from shaftprint.signals.kinds._splined_messages import comes_in_messages
from shaftprint.signals.pulses._speed import spline_speed
from shaftprint.units import rev_s_from_rpm, rpm_from_rev_s
from shaftprint.vessel._sensors import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# Mean speeds of so long a time tell a shaft that stands still, or turns back, by this share of the usual speed.
_WINDOW_S, _STANDING = 1.0, 0.02
# Nine tenths of the time, in which a shaft may stand, are slower than what is usual.
_USUAL = 0.9
# A spline goes through three angles.
_FEWEST_ANGLES = 3
# No engine runs so far below idle or above rated speed. So far from the working point counts may be entered wrongly.
_SLOWEST, _FASTEST, _FAR = 0.7, 1.3, 1.5


def read_encoder(source: Source[SpeedSensor], clock: "Clock") -> SpeedReading:
    """Return the engine-side speed of an encoder on the grid.

    Raises SignalError if the angle stands still, begins again elsewhere than the vessel file says, or turns too far
    from sample to sample, or its counts are fewer than the samples of the grid.
    """
    channel, sensor = source.channel, source.sensor
    ratio = source.vessel.gearbox.engine_over(sensor.shaft)
    # what turns too fast comes back as slow: what the recording shows is not enough
    turns_hz = rev_s_from_rpm(source.vessel.working_point.engine_speed_rpm) / ratio
    whole = range_of_small_steps(channel, sensor, turns_hz)
    values_hz = _values_hz(channel, sensor, clock, turns_hz)
    latency_s = clock.latency_s(sensor.latency_s)
    if comes_in_messages(channel, clock):
        reading = _splined(channel, sensor, whole, clock, latency_s)
    else:
        turning = _turning(channel, sensor, whole)
        reading = conditioned_on(clock, turning, fault_limits(turning, holds=False), latency_s)
        _sharpen(reading.values, step=clock.rate_hz / channel.rate_hz)
    usual, ahead = _usual(reading.values, clock, channel.name)
    speed = ahead * reading.values
    stops = _stops(speed, usual, clock, channel.name)
    bridge(speed, stops, start_s=clock.start_s, rate_hz=clock.rate_hz)
    gaps = [gap.earlier(latency_s) for gap in reading.gaps]
    astern = source.vessel.working_point.turns_backward(sensor.shaft)
    backwards = (
        f"channel {channel.name} counts up while the shaft turns astern: its sign was turned"
        if astern
        else f"channel {channel.name} counts down while the ship moves ahead: its sign was turned"
    )
    return SpeedReading(
        name=sensor.name,
        channel=channel.name,
        values=ratio * speed,
        repairs=reading.repairs,
        gaps=tuple(sorted([*gaps, *stops], key=lambda gap: gap.start_s)),
        findings=(*reading.findings, backwards) if (ahead < 0.0) != astern else reading.findings,
        pulse_rate_hz=values_hz,
    )


def speed_channel(channel: "Channel", sensor: SpeedSensor) -> "Channel":
    """Return the speed of the shaft [rev/s] as a channel: sample ``k`` is the mean from angle ``k - 1`` to angle ``k``.

    Sample 0, before the first angle, repeats sample 1.

    Raises SignalError if the angle begins again elsewhere than the vessel file says.
    """
    return _turning(channel, sensor, angle_range(channel, sensor))


def _turning(channel: "Channel", sensor: SpeedSensor, whole: float | None) -> "Channel":
    """Return the speed of the shaft as `speed_channel` does, where the range of the angle is known."""
    counts_of_range = None if whole is None else abs(whole / channel.scale)

    def steps(start: int, stop: int) -> Counts:
        first = max(start - 1, 0)
        # the sample before comes by itself: blocks are then read from border to border
        turned = _turned(np.concatenate([channel.read(first, start), channel.read(start, stop)]), counts_of_range)
        if start > 0 or stop == 0:
            return turned
        return np.concatenate([_turned(channel.read(0, min(2, channel.count)), counts_of_range), turned])

    return replace(
        channel,
        unit="rev/s",
        start_s=channel.start_s - 0.5 / channel.rate_hz,
        scale=channel.scale * sensor.rev_per_unit * channel.rate_hz,
        offset=0.0,
        source=steps,
    )


def _turned(counts: Counts, whole: float | None) -> FloatArray:
    """Return the steps of raw counts, shape (counts - 1,); not a number where one of the two is none."""
    values = np.where(np.isfinite(counts), counts, np.nan)
    return wrapped(np.diff(values), whole)


def judge_encoder(source: Source[SpeedSensor], reading: Reading) -> tuple[str, ...]:
    """Return a finding where the speed is far from that of the working point, as with wrong counts of a turn.

    Raises SignalError if no engine of the vessel file runs at such a speed.
    """
    sensor, vessel = source.sensor, source.vessel
    found_rpm, expected_rpm = rpm_from_rev_s(float(np.median(reading.values))), vessel.working_point.engine_speed_rpm
    idle_rpm, rated_rpm = vessel.machine.lowest_governed_rpm, vessel.machine.rated_speed_rpm
    counts = "unit"
    would_do = ""
    if sensor.unit == "counts":
        counts = "counts_per_revolution"
        number = (sensor.counts_per_revolution or 0.0) * found_rpm / expected_rpm
        would_do = f", of which about {number:.0f} would give the {expected_rpm:.0f} rpm of the working point"
    if not _SLOWEST * idle_rpm < found_rpm < _FASTEST * rated_rpm:
        raise SignalError(
            f"channel {sensor.channel}: expected an engine between {idle_rpm:g} rpm, idle, and {rated_rpm:g} rpm, "
            f"rated, found {found_rpm:.0f} rpm for half of the time; correct shaft in the vessel file, or {counts}"
            f"{would_do}."
        )
    if 1.0 / _FAR < found_rpm / expected_rpm < _FAR:
        return reading.findings
    return (
        *reading.findings,
        f"channel {sensor.channel} shows {found_rpm:.0f} rpm at the engine where the working point of the vessel file "
        f"has {expected_rpm:.0f} rpm: check {counts} and shaft there",
    )


def _values_hz(channel: "Channel", sensor: SpeedSensor, clock: "Clock", turns_hz: float) -> float:
    """Return how often a second the angle is really known [Hz].

    Raises SignalError if counts come more seldom than the samples of the grid, whose steps would be taken for speed.
    """
    if sensor.unit != "counts":
        return channel.rate_hz
    counts_hz = turns_hz / sensor.rev_per_unit
    if counts_hz < clock.rate_hz:
        raise SignalError(
            f"channel {channel.name}: expected {clock.rate_hz:g} counts a second or more, one for each sample of the "
            f"signals, found {counts_hz:.3g} at the working point; record the pulses themselves, as a voltage."
        )
    return min(channel.rate_hz, counts_hz)


def _sharpen(speed: FloatArray, *, step: float) -> None:
    """Take out of a speed on the grid, in place, that it is a mean over a time of ``step`` samples of the grid.

    Such a mean shows a sine of ``x`` periods in its time by ``sinc(x) = 1 - (pi x)^2 / 6 + ...`` too small.
    """
    speed[1:-1] -= step**2 / 24.0 * np.diff(speed, 2)


def _splined(channel: "Channel", sensor: SpeedSensor, whole: float | None, clock: "Clock", latency_s: float) -> Reading:
    """Return the speed of a channel that is slower than the grid, or of messages: the slope of a spline of its angles.

    Raises SignalError if there are too few angles.
    """
    angles = _angles if channel.stamps is None else _message_angles
    reading = angles(channel, sensor, whole)
    if reading.time_s.size < _FEWEST_ANGLES:
        raise SignalError(f"channel {channel.name}: expected numbers, found none; check the export of the logger.")
    begin_s = clock.start_s + latency_s
    speed = spline_speed(
        reading.time_s, reading.angle_rev, start_s=begin_s, step_s=1.0 / clock.rate_hz, count=clock.count
    )
    gaps = tuple(replace(gap, reach_s=REACH_VALUES / channel.rate_hz) for gap in reading.gaps)
    bridge(speed, gaps, start_s=begin_s, rate_hz=clock.rate_hz)
    return Reading(values=speed, repairs=[], gaps=(*gaps, *clock_gaps(channel)), findings=reading.findings)


class _Angles(NamedTuple):
    """Angles of a shaft at times of the channel, counted on through every turn."""

    time_s: FloatArray
    angle_rev: FloatArray
    gaps: tuple[Gap, ...]
    findings: tuple[str, ...]


def _angles(channel: "Channel", sensor: SpeedSensor, whole: float | None) -> _Angles:
    """Return the angles of even samples, straight lines where some are missing."""
    turning = _turning(channel, sensor, whole)
    counts = np.asarray(turning.read(0, turning.count), dtype=np.float64)
    missing = np.isnan(counts)
    if missing.all():
        return _Angles(np.empty(0), np.empty(0), (), ())
    step_rev = joined(counts) * turning.scale / turning.rate_hz
    angle_rev = np.concatenate([np.zeros(1), np.cumsum(step_rev[1:], dtype=np.float64)])
    time_s = channel.start_s + np.arange(angle_rev.size, dtype=np.float64) / channel.rate_hz
    gaps = gaps_of_missing(turning, missing, longest=LONGEST_GAP_VALUES)
    return _Angles(time_s, angle_rev, tuple(gaps), ())


def _message_angles(channel: "Channel", sensor: SpeedSensor, whole: float | None) -> _Angles:
    """Return the angles of messages at their own times."""
    messages = read_messages(channel)
    time_s, angles = messages.for_spline(latency_s=0.0)
    step = wrapped(np.diff(angles), whole)
    angle_rev = sensor.rev_per_unit * np.concatenate([np.zeros(1), np.cumsum(step, dtype=np.float64)])
    return _Angles(time_s, angle_rev, messages.gaps, messages.findings)


def _usual(speed: FloatArray, clock: "Clock", channel: str) -> tuple[float, float]:
    """Return how fast the shaft usually turns [rev/s], and the sign with which it mostly does.

    Raises SignalError if it stands still.
    """
    means = _means(speed, clock)
    usual = float(np.quantile(np.abs(means), _USUAL))
    moving = means[np.abs(means) > _STANDING * usual]
    if not moving.size:
        raise SignalError(
            f"channel {channel}: expected an angle that turns, found one that stands still; check the encoder, its "
            "coupling and its counter."
        )
    return usual, float(np.sign(np.median(moving))) or 1.0


def _stops(speed: FloatArray, usual: float, clock: "Clock", channel: str) -> list[Gap]:
    """Return where the shaft stands still or turns back: nothing of a propulsion line can be measured there."""
    means = _means(speed, clock)
    length_s = _WINDOW_S if means.size > 1 else speed.size / clock.rate_hz
    gaps = []
    for first, stop in runs_of(means < _STANDING * usual):
        turns_back = means[first:stop].min() < -_STANDING * usual
        gaps.append(
            Gap(
                channel=channel,
                start_s=clock.start_s + first / clock.rate_hz,
                stop_s=clock.start_s + (stop - 1) / clock.rate_hz + length_s,
                reason="shows a shaft that turns back" if turns_back else "stands still",
            )
        )
    return gaps


def _means(speed: FloatArray, clock: "Clock") -> FloatArray:
    """Return the mean speeds of all windows of a second, shape (windows,)."""
    width = min(round(_WINDOW_S * clock.rate_hz), speed.size)
    turned = np.concatenate([[0.0], np.cumsum(speed)])
    means: FloatArray = (turned[width:] - turned[:-width]) / width
    return means
