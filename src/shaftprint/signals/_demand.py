"""How late the demand inside the control unit is behind the set point, where it is logged beside it.

Both show the sines of a test. What a sine of the demand is late by, over its frequency, is the delay; noise and steps
are those of the demand alone.
"""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.signals._channels import find_channel
from shaftprint.signals._signals import SetPointDelay
from shaftprint.signals.excitation._quantum import steps_of_lines
from shaftprint.signals.kinds._message_reading import MessageReading, read_messages
from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.campaign._excitations import Sine
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._readings import Readings
    from shaftprint.vessel._sensors import DemandSensor

_FEWEST_LINES = 3
# Fewer messages do not tell a sine from noise; nor do sines of fewer steps.
_FEWEST_MESSAGES, _FEWEST_STEPS, _FEWEST_DEVIATIONS = 30, 2.0, 5.0
# Frequencies on either side of a sine, one over the length of its window apart, that show its noise.
_BINS = 5
# Where a logger repeats each value, so many of its samples a value.
_HELD_RATE = 2.0
# Lines that contradict each other by more than this many deviations are no delay.
_MOST_SCATTER = 10.0


def delay_of_demand(
    recording: "Recording", sensor: "DemandSensor", campaign: "Campaign", readings: "Readings"
) -> tuple[SetPointDelay | None, tuple[str, ...]]:
    """Return how late the demand is, nothing where the sines do not tell, and what the reader should know.

    ``recording``: holds the channel with the demand. ``sensor``: what the vessel file says of it. ``campaign``: what
    was asked. ``readings``: what was read, the set point still in volts. Raises SignalError if the channel is missing,
    empty or in another unit.
    """
    channel = find_channel(
        recording,
        sensor.channel,
        unit=sensor.unit,
        use="demand",
        way_out="correct the name there, or take [sensors.demand] out where it was not logged",
        takes_messages=True,
    )
    came = read_messages(channel)
    is_held = not channel.is_uneven and channel.rate_hz * sensor.cycle_s >= _HELD_RATE
    latency_s = readings.clock.latency_s(sensor.latency_s) + (0.5 * sensor.cycle_s if is_held else 0.0)
    lines = [
        line
        for sine in sorted(campaign.of_input().sines, key=lambda sine: sine.frequency_hz)
        if sine.frequency_hz * sensor.cycle_s < 0.5
        and not readings.coverage.missing(sine.settled_s, sine.window_stop_s)
        and (line := _line(sine, came, readings)) is not None
    ]
    if len(lines) < _FEWEST_LINES:
        return None, (
            f"the demand in channel {channel.name} does not tell the latency of the set point: expected at least "
            f"{_FEWEST_LINES} sines that it shows, found {len(lines)}",
        )
    delay_s, std_s, scatter = _delay(np.array(lines))
    if scatter > _MOST_SCATTER:
        return None, (
            f"channel {channel.name} does not follow the set point with one delay; check that it is the demand of this "
            "engine, and whether the control unit limits its rate",
        )
    found = SetPointDelay(
        channel=channel.name, delay_s=delay_s - latency_s, std_s=std_s * max(scatter, 1.0), lines=len(lines)
    )
    return found, (
        f"the demand in channel {channel.name} comes {MILLI * found.delay_s:.1f} +/- {MILLI * found.std_s:.1g} ms "
        "behind the set point, which is taken for its latency",
    )


def _line(sine: "Sine", came: MessageReading, readings: "Readings") -> tuple[float, float, float, float] | None:
    """Return frequency [rad/s], phase of the demand over the set point, its deviation, and sign of one sine."""
    clock, omega_rad_s = readings.clock, 2.0 * np.pi * sine.frequency_hz
    first, stop = np.searchsorted(came.time_s, [sine.settled_s, sine.window_stop_s])
    time_s, shown = came.time_s[first:stop], came.values[first:stop]
    if time_s.size < _FEWEST_MESSAGES or np.ptp(shown) == 0.0:
        return None
    step = came.messages.step
    if step:
        shown = shown - step * steps_of_lines(time_s, shown / step, (sine.frequency_hz,))
    begin, end = (round((instant - clock.start_s) * clock.rate_hz) for instant in (sine.settled_s, sine.window_stop_s))
    grid_s = clock.start_s + np.arange(begin, end) / clock.rate_hz
    asked, _ = _sine(grid_s - sine.settled_s, readings.set_point[begin:end], omega_rad_s)
    answered, left = _sine(time_s - sine.settled_s, shown, omega_rad_s)
    std = _noise(time_s - sine.settled_s, left, sine)
    # with what the steps may still hold
    std = float(np.hypot(std, 0.1 * step * np.sqrt(2.0 / time_s.size)))
    if not abs(answered) > max(_FEWEST_STEPS * step, _FEWEST_DEVIATIONS * std) or asked == 0.0:
        return None
    ratio = answered / asked
    return omega_rad_s, float(np.angle(ratio)), std / abs(answered), float(np.sign(ratio.real))


def _noise(time_s: FloatArray, left: FloatArray, sine: "Sine") -> float:
    """Return the standard deviation of one component of an amplitude, by what is left at frequencies beside the sine.

    A demand wanders: under slow sines it is noisier than under fast ones.
    """
    beside = np.array([k for k in range(sine.periods - _BINS, sine.periods + _BINS + 1) if k > 0 and k != sine.periods])
    waves = np.exp(-2j * np.pi / sine.window_s * np.outer(beside, time_s))
    return float(np.sqrt(0.5 * np.mean(np.abs(waves @ left * (2.0 / time_s.size)) ** 2)))


def _sine(time_s: FloatArray, values: FloatArray, omega_rad_s: float) -> tuple[complex, FloatArray]:
    """Return the complex amplitude of a sine in values, and what is left without it, mean and drift."""
    phase = omega_rad_s * time_s
    design = np.column_stack([np.cos(phase), np.sin(phase), np.ones(time_s.size), time_s])
    numbers, *_ = np.linalg.lstsq(design, values, rcond=None)
    return complex(numbers[0], -numbers[1]), values - design @ numbers


def _delay(lines: FloatArray) -> tuple[float, float, float]:
    """Return the delay of all lines, its deviation [s], and the scatter of the lines over theirs.

    A line is late by whole turns more where the slower ones say so.

    ``lines``: frequency [rad/s], ascending, phase, its deviation, sign; shape (lines, 4).
    """
    # a demand in rpm may fall where the voltage rises
    turned = 0.0 if lines[0, 3] > 0.0 else np.pi
    delays: list[float] = []
    weights: list[float] = []
    for omega_rad_s, phase, std, _ in lines.tolist():
        expected = float(np.average(delays, weights=weights)) if delays else 0.0
        late = -(phase - turned) - omega_rad_s * expected
        late -= 2.0 * np.pi * round(late / (2.0 * np.pi))
        delays.append(expected + late / omega_rad_s)
        weights.append((omega_rad_s / std) ** 2)
    mean = float(np.average(delays, weights=weights))
    scatter = float(np.sqrt(np.dot(weights, (np.array(delays) - mean) ** 2) / (len(delays) - 1)))
    return mean, float(1.0 / np.sqrt(np.sum(weights))), scatter
