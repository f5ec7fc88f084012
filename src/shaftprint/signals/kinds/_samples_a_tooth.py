"""Whether a logger is fast enough for a wheel."""

from typing import TYPE_CHECKING

from shaftprint.errors import SignalError
from shaftprint.vessel import SAMPLES_A_TOOTH

if TYPE_CHECKING:
    from shaftprint.recording import Channel
    from shaftprint.signals.pulses import PulseTrain
    from shaftprint.vessel import Wheel


def fastest_turns_hz(channel: "Channel", train: "PulseTrain", wheel: "Wheel") -> float:
    """Return the largest number of turns a second over one turn without a fault; 0 where there is none."""
    teeth = wheel.counted
    whole = train.number[teeth:] - train.number[:-teeth] == teeth
    turns = (train.position[teeth:] - train.position[:-teeth])[whole]
    return channel.rate_hz / float(turns.min()) if turns.size else 0.0


def expect_samples(channel: "Channel", wheel: "Wheel", turns_hz: float) -> None:
    """Check that a channel is sampled often enough for a wheel at a speed.

    Raises
    ------
    SignalError
        If there are fewer than four samples from tooth to tooth; the rate that would do is in the message.
    """
    teeth_hz = wheel.closest * turns_hz
    if channel.rate_hz >= SAMPLES_A_TOOTH * teeth_hz:
        return
    raise SignalError(
        f"channel {channel.name}: expected at least {SAMPLES_A_TOOTH:g} samples from tooth to tooth, found "
        f"{channel.rate_hz / teeth_hz:.2g} at {turns_hz:.3g} turns a second of the wheel {wheel} and "
        f"{channel.rate_hz:g} Hz; log at {wheel.least_rate_hz(turns_hz):g} Hz or more, or take a wheel with fewer "
        "teeth or that of a slower shaft."
    )
