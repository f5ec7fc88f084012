"""Speed of a shaft from its angle: an encoder's counts or degrees, which begin again after so many.

From sample to sample the angle turns by less than half of what it takes to begin again, so that the difference says how
often it did. Differences over time are a mean speed of one sample, stamped in its middle.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.recording import Channel
from shaftprint.signals._channels import blocks
from shaftprint.vessel import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.signals._clock import Clock

# Nearer to half a range the sense of turning is a guess.
_LARGEST_STEP = 0.4
# That so many samples of a thousand turn further is no spike.
_QUANTILE = 0.999


def speed_channel(channel: Channel, sensor: SpeedSensor, clock: "Clock") -> tuple[Channel, tuple[str, ...]]:
    """Return the speed of the shaft as a channel in rev/s, one sample shorter, with what the reader should know.

    Parameters
    ----------
    channel, sensor
        The angle and what the vessel file says about it.
    clock
        How it is read.

    Raises
    ------
    SignalError
        If the angle begins again too often to be followed, or does not move.
    """
    counts = np.concatenate([part.astype(np.float64) for part in blocks(channel, clock.block_samples(channel))])
    turned = turned_rev(channel, sensor, counts * channel.scale + channel.offset)
    mean = float(np.nanmean(turned)) if np.isfinite(turned).any() else 0.0
    if mean == 0.0:
        raise SignalError(f"channel {channel.name}: expected an angle that turns, found one that stands still.")
    speed = np.copysign(channel.rate_hz, mean) * turned
    backwards = f"channel {channel.name} counts down while the ship moves ahead: its sign was turned"
    made = replace(
        channel,
        unit="rev/s",
        start_s=channel.start_s + 0.5 / channel.rate_hz,
        count=speed.size,
        scale=1.0,
        offset=0.0,
        source=lambda start, stop: speed[start:stop],
    )
    return made, (backwards,) if mean < 0.0 else ()


def turned_rev(channel: Channel, sensor: SpeedSensor, angle: FloatArray) -> FloatArray:
    """Return by how much the shaft turns from each sample to the next [rev], shape (samples - 1,).

    Raises
    ------
    SignalError
        If that is more than four tenths of the range of the angle.
    """
    whole = sensor.rolls_over
    step = np.diff(angle)
    step -= whole * np.rint(step / whole)
    largest = float(np.nanquantile(np.abs(step), _QUANTILE)) if np.isfinite(step).any() else 0.0
    if largest > _LARGEST_STEP * whole:
        raise SignalError(
            f"channel {channel.name}: expected an angle that turns by less than {_LARGEST_STEP:g} of its range of "
            f"{whole:g} {channel.unit} from sample to sample, found {largest / whole:.2f}; log faster than "
            f"{channel.rate_hz:g} Hz, or correct rolls_over_at in the vessel file."
        )
    return np.asarray(step * sensor.rev_per_unit)
