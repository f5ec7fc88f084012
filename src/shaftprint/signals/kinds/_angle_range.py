"""What an encoder turns until its angle begins again, as the vessel file says and as the recording shows."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import SignalError
from shaftprint.signals._channels import spots
from shaftprint.vessel._sensors import SpeedSensor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel

# Nearer to half a range the sense of turning is a guess.
_LARGEST_STEP = 0.4
# Beyond these shares of the samples lie wrong ones.
_OUTSIDE = 0.001
# A range may be so much larger than stated by rounding; of one that is found this share may be an error, and a count.
_ROUNDING, _AGREEMENT = 1e-3, 0.02
# So many jumps, of which this share agree with each other, show a range.
_FEWEST_JUMPS, _MOST, _ALIKE = 3, 0.8, 0.05
# Ranges are powers of two, or up to so many whole turns, if they are that near to one.
_MOST_TURNS, _LARGEST_POWER, _NEAR = 64, 32, 5e-3
_DIGITS = 2
_FEWEST_ANGLES = 2


def wrapped(step: FloatArray, whole: float | None) -> FloatArray:
    """Return steps of an angle without the jumps where it begins again, if it does so, shape of ``step``."""
    if whole is None:
        return step
    without_jumps: FloatArray = step - whole * np.rint(step / whole)
    return without_jumps


def angle_range(channel: "Channel", sensor: SpeedSensor) -> float | None:
    """Return what the angle turns until it begins again, in the unit of the channel; nothing where it goes on.

    Where the vessel file does not say, an angle that stays within one turn begins again after it.

    Raises SignalError if the recording shows another range, which is named, or a single angle.
    """
    return _range_of(_parts(channel), channel, sensor)


def _range_of(parts: Sequence[FloatArray], channel: "Channel", sensor: SpeedSensor) -> float | None:
    lowest, highest = np.quantile(np.concatenate(parts), [_OUTSIDE, 1.0 - _OUTSIDE]).tolist()
    turn, stated = 1.0 / sensor.rev_per_unit, sensor.rolls_over_at
    within = turn if highest - lowest <= (1.0 + _ROUNDING) * turn else None
    whole = within if stated is None else stated
    found = _found_range(parts, highest - lowest)
    if found is not None:
        quantum = 1.0 if sensor.unit == "counts" else 0.0
        if whole is None or abs(found - whole) > _AGREEMENT * whole + quantum:
            raise _another_range(channel, sensor, whole, _named(found, turn))
    elif stated is not None and highest - lowest > (1.0 + _ROUNDING) * stated:
        raise SignalError(
            f"channel {channel.name}: expected an angle that begins again at {stated:.10g} {channel.unit}, as the "
            "vessel file says, found one that goes on; leave out rolls_over_at there."
        )
    return whole


def range_of_small_steps(channel: "Channel", sensor: SpeedSensor, turns_hz: float) -> float | None:
    """Return `angle_range` of an angle that turns by clearly less than half of it from sample to sample.

    ``channel``, ``sensor``: the angle and what the vessel file says about it. ``turns_hz``: turns of the shaft a second
    that the vessel file expects [Hz]. Raises SignalError if it turns further there or in the recording, with the rate
    that would do in the message, or as `angle_range`.
    """
    parts = _parts(channel)
    whole = _range_of(parts, channel, sensor)
    if whole is None:
        return None
    steps = np.concatenate([np.abs(wrapped(np.diff(part), whole)) for part in parts])
    seen = float(np.quantile(steps, 1.0 - _OUTSIDE)) / whole if steps.size else 0.0
    share = max(seen, turns_hz / (channel.rate_hz * whole * sensor.rev_per_unit))
    if share <= _LARGEST_STEP:
        return whole
    raise SignalError(
        f"channel {channel.name}: expected an angle that turns by less than {_LARGEST_STEP:g} of its {whole:.10g} "
        f"{channel.unit} from sample to sample, found {share:.2f} of it at {channel.rate_hz:g} Hz; log at "
        f"{_rounded_up(share / _LARGEST_STEP * channel.rate_hz):g} Hz or more."
    )


def _parts(channel: "Channel") -> list[FloatArray]:
    """Return the angle in a few stretches from all over the channel, in its unit."""
    if channel.count < _FEWEST_ANGLES:
        raise SignalError(f"channel {channel.name}: expected an angle that turns, found a single one.")
    return [channel.scaled(part) for part in spots(channel)]


def _found_range(parts: Sequence[FloatArray], span: float) -> float | None:
    """Return the range that jumps of an angle show; nothing where there are none that agree."""
    ranges = []
    for part in parts:
        step = np.abs(np.diff(part))
        jumps = np.flatnonzero(step[1:] > 0.5 * span) + 1
        # what it would have turned without the jump is near to what it turned before
        ranges.append(step[jumps] + step[jumps - 1])
    every = np.concatenate(ranges)
    if every.size < _FEWEST_JUMPS:
        return None
    middle = float(np.median(every))
    return middle if np.mean(np.abs(every - middle) < _ALIKE * middle) >= _MOST else None


def _named(found: float, turn: float) -> float:
    """Return the range that is meant by one that was measured: whole turns or a power of two where one is near."""
    likely = [turn * turns for turns in range(1, _MOST_TURNS + 1)]
    likely += [2.0**power for power in range(1, _LARGEST_POWER + 1)]
    nearest = min(likely, key=lambda one: abs(one / found - 1.0))
    return nearest if abs(nearest / found - 1.0) < _NEAR else float(f"{found:.4g}")


def _another_range(channel: "Channel", sensor: SpeedSensor, whole: float | None, found: float) -> SignalError:
    expected = "goes on" if whole is None else f"begins again at {whole:.10g} {channel.unit}"
    one_turn = "counts_per_revolution" if sensor.unit == "counts" else "unit"
    return SignalError(
        f"channel {channel.name}: expected an angle that {expected}, as the vessel file says, found one that begins "
        f"again at {found:.10g} {channel.unit}; write rolls_over_at = {found:.10g} there, or correct {one_turn} where "
        "that is one turn."
    )


def _rounded_up(rate_hz: float) -> float:
    step = 10.0 ** (math.floor(math.log10(rate_hz)) + 1 - _DIGITS)
    return math.ceil(rate_hz / step - 1e-3) * step
