"""Fuel rack from percent torque, percent load or fuel rate on the CAN bus, at the times of the messages.

It is not brought on the common grid: between messages that come every 10 to 100 ms nothing is known, and whatever an
interpolation put there would bend the response. Spectra are measured on the channel's own clock, or at the times of the
messages where the file has them.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float, in_blocks, runs_of
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import ChannelRole, MessageSignal
from shaftprint.signals._channels import blocks, time_of
from shaftprint.signals._gaps import Coverage, Gap, clock_gaps, joined
from shaftprint.signals._signals import Repair
from shaftprint.signals.conditioning._condition import Reading
from shaftprint.signals.kinds._kind import ChannelKind, Source, SteadyState
from shaftprint.signals.kinds._message_reading import MessageReading, read_messages
from shaftprint.signals.levels._steady import SteadyStretch
from shaftprint.signals.levels._working_point import find_working_point
from shaftprint.units import rpm_from_rev_s
from shaftprint.vessel._sensors import RackSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals._clock import Clock

# Beyond the range of the message stand "error" and "not available" (SAE J1939-71).
_HIGHEST_PERCENT, _HIGHEST_L_H = 125.0, 3212.75
_LONGEST_GAP_S = 2.0

# A logger that repeats each value on its own clock: means of a tenth of a cycle keep the memory low.
_PARTS_OF_A_CYCLE = 10
_SAME_RATE, _HELD_RATE = 0.1, 2.0
_BLOCK_S = 1.0


class Rack(ChannelKind[RackSensor]):
    """Fuel rack that the governor gives [fraction]: 1 gives rated torque at rated speed."""

    sensor, name, use, role, own_clock = "rack", "X", "fuel rack", ChannelRole.SIDE, True
    takes_messages = True

    def stated_hold_s(self, source: Source[RackSensor]) -> float | None:
        """Return the cycle of its message."""
        return None if source.channel.is_uneven else source.sensor.cycle_s

    def read(self, source: Source[RackSensor], clock: "Clock") -> Reading:
        """Return the rack at the times of its messages."""
        return read_rack(source.channel, source.sensor, block_samples=clock.block_samples(source.channel))

    def signal(self, source: Source[RackSensor], reading: Reading, steady: SteadyState) -> MessageSignal:
        """Return the rack with the working point that belongs to the mean load of the test."""
        torque_nm = find_working_point(steady.stretches).shaft_torque_nm

        def share(time_s: FloatArray) -> FloatArray:
            speed_rpm = rpm_from_rev_s(np.interp(time_s, steady.clock.time_s, steady.speed_rev_s))
            return source.sensor.share(speed_rpm, source.vessel.machine)

        return rack_signal(
            reading.values,
            source.channel,
            source.sensor,
            steady.stretches,
            latency_s=steady.clock.latency_s(source.sensor.latency_s),
            gaps=reading.gaps,
            time_s=reading.time_s if isinstance(reading, MessageReading) else None,
            load=steady.working_point.shaft_torque_nm / torque_nm,
            share=share if source.sensor.goes_with_speed else None,
        )


def read_rack(channel: "Channel", sensor: RackSensor, *, block_samples: int) -> Reading:
    """Return the fuel rack [fraction], one value a message or a part of one, with what was repaired and is missing.

    ``channel``: percent torque, one sample a message or held on the clock of the logger. ``sensor``: what the vessel
    file says of it. ``block_samples``: samples that are read at a time; the result does not depend on it. Raises
    SignalError if the rate is not that of the messages, no torque is ever available, or the channel never moves.
    """
    group = _samples_together(channel, sensor)
    if channel.is_uneven or (channel.stamps is not None and not _is_held(channel, sensor)):
        return _read_messages(channel, sensor)
    shown = np.concatenate(list(_means(channel, group, block_samples, highest=_highest(sensor))))
    repairs, gaps = _bridge(shown, channel, sensor, group)
    _expect_moving(shown, channel, sensor)
    return Reading(values=sensor.rack_per_unit * shown, repairs=repairs, gaps=tuple(gaps))


def _highest(sensor: RackSensor) -> float:
    return _HIGHEST_PERCENT if sensor.unit == "%" else _HIGHEST_L_H


def _expect_moving(shown: FloatArray, channel: "Channel", sensor: RackSensor) -> None:
    if np.ptp(shown) == 0.0:
        raise SignalError(
            f"channel {channel.name}: expected a {sensor.words} that moves, found {shown[0]:g} {sensor.unit} from "
            "beginning to end; check the message it was taken from, or take [sensors.rack] out of the vessel file."
        )


def _read_messages(channel: "Channel", sensor: RackSensor) -> MessageReading:
    """Return the messages that hold a torque, at their own times; nothing is put between them."""
    reading = read_messages(channel, highest=_highest(sensor))
    if not reading.values.size:
        raise _nothing_available(channel, sensor)
    _expect_moving(reading.values, channel, sensor)
    kept_s = reading.messages.value_period_s
    if not _is_held(channel, sensor) and kept_s > _HELD_RATE * sensor.cycle_s:
        raise SignalError(
            f"channel {channel.name}: expected a new value every {sensor.cycle_s:g} s, as cycle_s says, found each "
            f"sent again for {kept_s:.3g} s; set cycle_s to that in the vessel file."
        )
    return replace(reading, values=sensor.rack_per_unit * reading.values)


def rack_signal(
    fraction: FloatArray,
    channel: "Channel",
    sensor: RackSensor,
    stretches: tuple[SteadyStretch, ...],
    *,
    latency_s: float,
    gaps: tuple[Gap, ...] = (),
    time_s: FloatArray | None = None,
    load: float = 1.0,
    share: Callable[[FloatArray], FloatArray] | None = None,
) -> MessageSignal:
    """Return the fuel rack with its clock, its sampling and its working point.

    ``fraction``: fuel rack as `read_rack` gives it, shape (values,). ``channel``, ``sensor``: where it comes from.
    ``stretches``: where the line stands still at the working point. ``latency_s``: time by which the channel is taken
    to be late [s]. ``gaps``: where no torque was available. ``time_s``: time of each value, where those are messages at
    times of their own [s], shape (values,). ``load``: torque of the working point over that of the stretches; the rack
    follows it. ``share``: rack over ``fraction`` at some times [s], where it hangs on the speed beside the value.
    Raises SignalError if the channel does not cover any of the stretches, or the rack is not positive there.
    """
    held = _is_held(channel, sensor)
    group = _samples_together(channel, sensor) if time_s is None else 1
    rate_hz, start_s = channel.rate_hz / group, time_of(channel, 0.5 * (group - 1)) - latency_s
    times = start_s + np.arange(fraction.size) / rate_hz if time_s is None else time_s - latency_s
    if share is not None:
        fraction = fraction * share(times)
    resolution = sensor.rack_per_unit * sensor.resolution
    covered = Coverage(gaps=gaps)
    uninterrupted = [stretch for stretch in stretches if not covered.missing(stretch.start_s, stretch.stop_s)]
    inside = [_between(fraction, times, rate_hz, stretch) for stretch in uninterrupted]
    mean, std = _working_point(inside, rate_hz, resolution)
    if not mean > 0.0:
        value = "none there" if np.isnan(mean) else f"{mean / sensor.rack_per_unit:.3g} {sensor.unit}"
        raise SignalError(
            f"channel {channel.name}: expected a positive {sensor.words} while the line stands still, as near "
            f"{stretches[0].start_s:.0f} s, found {value}; check the message it was taken from and when it was logged."
        )
    return MessageSignal(
        name=Rack.name,
        channel=channel.name,
        values=frozen_float(fraction),
        rate_hz=rate_hz,
        start_s=float(times[0]),
        times=None if time_s is None else frozen_float(times),
        resolution=resolution,
        cycle_s=sensor.cycle_s if held else 1.0 / channel.rate_hz,
        averaging_s=group / channel.rate_hz if group > 1 else 0.0,
        hold_s=sensor.cycle_s if held else 0.0,
        reference=mean * load,
        reference_std=std * load,
        gaps=tuple(gap.earlier(latency_s) for gap in gaps),
    )


def _is_held(channel: "Channel", sensor: RackSensor) -> bool:
    """Return whether the channel holds each message until the next one, on the clock of a logger."""
    return channel.rate_hz * sensor.cycle_s >= _HELD_RATE


def _samples_together(channel: "Channel", sensor: RackSensor) -> int:
    """Return how many samples make one value: one where they are messages, a part of a cycle where they are held."""
    for_one = channel.rate_hz * sensor.cycle_s
    if for_one >= _HELD_RATE:
        return max(int(for_one / _PARTS_OF_A_CYCLE), 1)
    if abs(for_one - 1.0) > _SAME_RATE:
        raise SignalError(
            f"channel {channel.name}: expected {1.0 / sensor.cycle_s:g} samples a second, one a message as cycle_s = "
            f"{sensor.cycle_s:g} says, or at least twice as many where each is held, found {channel.rate_hz:g}; "
            "correct cycle_s in the vessel file."
        )
    return 1


def _means(channel: "Channel", group: int, block_samples: int, *, highest: float) -> Iterator[FloatArray]:
    """Yield the means of so many samples in the unit of the channel, not a number where no value was available."""
    waiting = np.empty(0)
    for counts in blocks(channel, block_samples):
        shown = np.concatenate([waiting, channel.scaled(counts)])
        count = shown.size - shown.size % group
        waiting = shown[count:]
        parts = shown[:count].reshape(-1, group)
        available = parts <= highest
        number = available.sum(axis=1)
        mean = np.where(available, parts, 0.0).sum(axis=1) / np.maximum(number, 1)
        yield np.where(number > 0, mean, np.nan)


def _bridge(shown: FloatArray, channel: "Channel", sensor: RackSensor, group: int) -> tuple[list[Repair], list[Gap]]:
    """Put straight lines where no value was available; what is longer than 2 s is a gap."""
    missing = np.isnan(shown)
    if missing.all():
        raise _nothing_available(channel, sensor)
    repairs, gaps = [], []
    for first, stop in runs_of(missing):
        start_s, stop_s = time_of(channel, first * group), time_of(channel, stop * group)
        if stop_s - start_s > _LONGEST_GAP_S:
            gaps.append(
                Gap(
                    channel=channel.name,
                    start_s=start_s,
                    stop_s=stop_s,
                    reason=f"has no {sensor.words.split()[-1]} available",
                )
            )
        else:
            repairs.append(Repair(channel=channel.name, kind="dropout", time_s=start_s, count=(stop - first) * group))
    shown[:] = joined(shown)
    return repairs, [*gaps, *clock_gaps(channel)]


def _nothing_available(channel: "Channel", sensor: RackSensor) -> SignalError:
    return SignalError(
        f"channel {channel.name}: expected {sensor.words}, found only values above {_highest(sensor):g} {sensor.unit}, "
        "which mean that none is available, or no numbers; use another recording, or take [sensors.rack] out of the "
        "vessel file."
    )


def _between(fraction: FloatArray, times: FloatArray, rate_hz: float, stretch: SteadyStretch) -> FloatArray:
    half_a_value_s = 0.5 / rate_hz
    first, stop = np.searchsorted(times, np.array([stretch.start_s, stretch.stop_s]) - half_a_value_s)
    return fraction[first:stop]


def _working_point(inside: list[FloatArray], rate_hz: float, resolution: float) -> tuple[float, float]:
    """Return the mean over steady stretches and its standard deviation; not a number where there are no values.

    The standard deviation is from the scatter inside the stretches, in blocks of a second. How they differ from each
    other is their load, with which the mean is carried to that of the whole test.

    The steps of the channel do not average out where the rack stands stiller than they are wide: with normal noise of
    deviation ``s`` a step ``q`` leaves ``exp(-2 pi^2 s^2 / q^2)`` of its error (Widrow and Kollar, "Quantization
    Noise", 2008).
    """
    length = max(round(_BLOCK_S * rate_hz), 1)
    long_enough = [values for values in inside if values.size >= 2 * length]
    if not long_enough:
        return np.nan, np.nan
    deviations = []
    for values in long_enough:
        means = in_blocks(values, length).mean(axis=1)
        deviations.append(float(means.std(ddof=1) / np.sqrt(means.size)))
    weight = np.array([float(values.size) for values in long_enough])
    share = weight / weight.sum()
    mean = float(share @ [values.mean() for values in long_enough])
    std = float(np.linalg.norm(share * deviations))
    noise = max(float(np.mean([values.var() for values in long_enough])) - resolution**2 / 12.0, 0.0)
    step_error = resolution / np.sqrt(12.0) * np.exp(-2.0 * np.pi**2 * noise / resolution**2)
    return mean, float(np.hypot(std, step_error))
