"""Whether a logger is fast enough for a wheel."""

import math
from typing import TYPE_CHECKING

from shaftprint.errors import SignalError
from shaftprint.vessel._wheel import SAMPLES_A_TOOTH

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.signals.pulses._pulses import PulseTrain
    from shaftprint.vessel._sensors import SpeedSensor
    from shaftprint.vessel._wheel import Wheel

# Of a strip or a tooth with fewer samples levels and edges are not sure to be found. Teeth are as wide as the
# spaces between them, and what a pick-up makes of them is round.
_SAMPLES_A_STRIP, _SAMPLES_A_WIDTH = 4.0, 6.0
# Teeth of a wheel, not strips.
_TEETH = 12
_DIGITS = 2


def fastest_turns_hz(channel: "Channel", train: "PulseTrain", wheel: "Wheel") -> float:
    """Return the largest number of turns a second over one turn without a fault; 0 where there is none."""
    teeth = wheel.counted
    whole = train.number[teeth:] - train.number[:-teeth] == teeth
    turns = (train.position[teeth:] - train.position[:-teeth])[whole]
    return channel.rate_hz / float(turns.min()) if turns.size else 0.0


def expect_samples(channel: "Channel", wheel: "Wheel", turns_hz: float) -> None:
    """Check that a channel is sampled often enough for a wheel at a speed; a list of edges always is.

    Raises SignalError if there are fewer than four samples from tooth to tooth; the rate that would do is in the
    message.
    """
    teeth_hz = wheel.closest * turns_hz
    if channel.is_of_edges or channel.rate_hz >= SAMPLES_A_TOOTH * teeth_hz:
        return
    raise SignalError(
        f"channel {channel.name}: expected at least {SAMPLES_A_TOOTH:g} samples from tooth to tooth, found "
        f"{channel.rate_hz / teeth_hz:.2g} at {turns_hz:.3g} turns a second of the wheel {wheel} and "
        f"{channel.rate_hz:g} Hz; log at {wheel.least_rate_hz(turns_hz):g} Hz or more, or take a wheel with fewer "
        "teeth or that of a slower shaft."
    )


def too_slow_for_pulses(channel: "Channel", sensor: "SpeedSensor", turns_hz: float, duty: float | None) -> str:
    """Return that a channel whose pulses cannot be used is sampled too seldom for them; empty where it is not.

    ``channel``, ``sensor``: the channel and what the vessel file says about it. ``turns_hz``: turns of its shaft a
    second at the working point. ``duty``: share of the time in a pulse, where levels were found.
    """
    closest_hz = sensor.toothed.closest * turns_hz
    are_teeth = sensor.pulses_per_revolution >= _TEETH
    needed = _SAMPLES_A_WIDTH if are_teeth else _SAMPLES_A_STRIP
    if sensor.pulse_width_deg is not None:
        width_s = sensor.pulse_width_deg / 360.0 / turns_hz
    elif are_teeth or duty is None:
        width_s = 0.5 / closest_hz
    else:
        width_s = duty / closest_hz
    samples = width_s * channel.rate_hz
    if channel.is_of_edges or samples >= needed:
        return ""
    least_hz = needed / width_s
    step_hz = 10.0 ** (math.floor(math.log10(least_hz)) + 1 - _DIGITS)
    return (
        f"the rate is too low for these pulses of about {1000.0 * width_s:.2g} ms, {samples:.2g} samples each at "
        f"{channel.rate_hz:g} Hz; log at {math.ceil(least_hz / step_hz) * step_hz:g} Hz or more"
    )
