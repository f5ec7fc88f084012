"""Finding the channels that the vessel file names, and reading them block by block."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import SignalError
from shaftprint.recording._messages import judge_messages
from shaftprint.units import unit_factor

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.vessel._sensors import Sensors

Counts: TypeAlias = NDArray[np.int16] | NDArray[np.float64]
Advance: TypeAlias = Callable[[int], None]

# One compressed block of the native container: every block is then unpacked once.
DEFAULT_BLOCK_SAMPLES = 262_144

_SPOTS = 4
_SPOT_SAMPLES = 65_536
# Enough to tell the unit of a channel by what it shows.
_GLANCE_SAMPLES = 4_096
# Values beyond are too large for a unit, and are likely in its thousandth.
_TOO_LARGE = {"V": (100.0, "mV"), "mA": (100.0, "uA")}
# The unit of a share may be that of a channel that lacks one.
_NO_QUANTITY = ("%", "-")


class MissingChannel(SignalError):
    """A channel of the vessel file is not in the recording."""


def find_channel(
    recording: "Recording",
    name: str,
    *,
    unit: str,
    use: str,
    way_out: str = "correct the name there",
    takes_messages: bool = False,
    sensors: "Sensors | None" = None,
    ship: str = "",
) -> "Channel":
    """Return a channel that holds samples in the expected unit, into which one of the same quantity is converted.

    ``recording``: where to look. ``name``: name of the channel, from the vessel file. ``unit``: unit that the vessel
    file gives for it; spaces and multiplication dots do not count. ``use``: what the channel is needed for, in words.
    ``way_out``: what to do where the channel is missing, in words. ``takes_messages``: whether messages at times of
    their own will do. ``sensors``: all of the vessel file, whose channels are taken. ``ship``: whose file it is. Raises
    SignalError if the channel is missing, empty, in another unit, or on no clock where it has to be.
    """
    if name not in recording.channels:
        other = other_ship(recording, ship)
        of_ship = f"{other}: " if other else ""
        raise MissingChannel(
            f'{recording.path}: {of_ship}expected a channel "{name}" for the {use}, as the vessel '
            f"file says, found {', '.join(recording.channels) or 'no channel at all'}; {way_out}."
        )
    channel = recording.channels[name]
    if not channel.unit:
        raise SignalError(
            f'{recording.path}, channel {name}: expected the unit "{unit}" for the {use}, found a file without it'
            f"{_unit_to_say(channel, unit)}."
        )
    if (factor := _factor(channel.unit, unit)) is not None:
        channel = replace(channel, unit=unit, scale=factor * channel.scale, offset=factor * channel.offset)
    if _plain(channel.unit) != _plain(unit):
        raise SignalError(
            f'{recording.path}, channel {name}: expected the unit "{unit}" for the {use}, '
            f'found "{channel.unit}"; {_way_to_unit(recording, channel, unit, sensors)}.'
        )
    if channel.count == 0:
        raise SignalError(f"{recording.path}, channel {name}: expected samples, found none.")
    if not takes_messages:
        expect_one_clock(channel, f"the {use}")
    return channel


def other_ship(recording: "Recording", ship: str) -> str:
    """Return that a recording is of another ship than a vessel file, in words; empty where it is not, or not said."""
    of = recording.attributes.get("vessel", "")
    return f"this recording is of {of}, the vessel file of {ship}" if of and ship and of != ship else ""


def expect_one_clock(channel: "Channel", use: str) -> None:
    """Refuse messages at times of their own where a filter needs samples at one rate.

    ``use``: what it is needed for, in words. Raises SignalError if its samples lie on no clock.
    """
    if channel.is_uneven:
        raise SignalError(
            f"channel {channel.name}: expected samples at one rate for {use}, found "
            f"{judge_messages(channel).sentence}; log it at one rate."
        )


def blocks(channel: "Channel", block_samples: int, advance: Advance | None = None) -> Iterator[Counts]:
    """Yield the raw counts of a channel, in order, as int16 or float64; nan where there is no finite value.

    ``channel``: what to read. ``block_samples``: samples of one block; results do not depend on it. ``advance``: is
    told the number of samples after each block.
    """
    for first in range(0, channel.count, block_samples):
        last = min(first + block_samples, channel.count)
        yield _counts(channel, first, last)
        if advance is not None:
            advance(last - first)


def spots(channel: "Channel") -> list[Counts]:
    """Return a few stretches of raw counts from all over a channel, the same for any block size.

    Samples that are not numbers are left out.

    Raises SignalError if there is no number in any of them.
    """
    stretches = _stretches(channel, _SPOT_SAMPLES)
    numbers = [counts for counts in stretches if counts.size]
    if not numbers:
        length = min(_SPOT_SAMPLES, channel.count)
        raise SignalError(
            f"channel {channel.name}: expected numbers, found none in {len(stretches)} stretches of "
            f"{length / channel.rate_hz:.3g} s all over the recording; check the export of the logger."
        )
    return numbers


def middle_of(channel: "Channel") -> float:
    """Return the median of a few short stretches from all over a channel, in its unit; nan without numbers in them."""
    counts: NDArray[np.float64] = np.concatenate(_stretches(channel, _GLANCE_SAMPLES)).astype(np.float64)
    return float(np.median(counts)) * channel.scale + channel.offset if counts.size else float("nan")


def _stretches(channel: "Channel", samples: int) -> list[Counts]:
    """Return the numbers among so many samples, at most, of each of a few stretches."""
    length = min(_SPOT_SAMPLES, channel.count)
    starts = np.linspace(0, channel.count - length, _SPOTS).astype(int)
    # on block borders where the channel is long enough, so that no block is unpacked twice
    starts -= starts % length
    return [_finite(_counts(channel, int(start), int(start) + min(length, samples))) for start in np.unique(starts)]


def time_of(channel: "Channel", sample: float) -> float:
    """Return the time of a sample, which may be a fraction, in seconds of the recording."""
    return channel.start_s + sample / channel.rate_hz


def _counts(channel: "Channel", first: int, last: int) -> Counts:
    counts: NDArray[Any] = channel.read(first, last)
    if counts.dtype == np.int16:
        return counts
    values: NDArray[np.float64] = np.ascontiguousarray(counts, dtype=np.float64)
    finite = np.isfinite(values)
    return values if finite.all() else np.where(finite, values, np.nan)


def _finite(counts: Counts) -> Counts:
    if counts.dtype == np.int16:
        return counts
    missing = np.isnan(counts)
    return counts[~missing] if missing.any() else counts


def _factor(given: str, wanted: str) -> float | None:
    """Return what values in a unit are multiplied by to be in the one that is wanted, where that is another."""
    if _plain(given) == _plain(wanted) or wanted in _NO_QUANTITY:
        return None
    return unit_factor(given, wanted)


def _way_to_unit(recording: "Recording", channel: "Channel", unit: str, sensors: "Sensors | None") -> str:
    """Return what to do where a channel has another unit: a channel of a sensor is taken, or swapped with this one."""
    taken = {} if sensors is None else {one: of for one, of in sensors.channels if one != channel.name}
    has_it = [one for one, other in recording.channels.items() if _plain(other.unit) == _plain(unit)]
    swapped = [one for one in has_it if one in taken and _plain(taken[one]) == _plain(channel.unit)]
    if len(swapped) == 1:
        return (
            f"{swapped[0]} has it, and is to be in {channel.unit}: the two seem to be swapped; correct the channels in "
            "the vessel file or the columns of the recording"
        )
    free = [one for one in has_it if one not in taken]
    other = f"{free[0]} has it: take that one, or " if len(free) == 1 else ""
    return f"{other}correct the unit in the vessel file, and the scale that goes with it"


def _unit_to_say(channel: "Channel", unit: str) -> str:
    """Return how to say the unit of a channel without one: that which was expected, if its values can be in it."""
    highest, thousandth = _TOO_LARGE.get(unit, (np.inf, ""))
    middle = abs(middle_of(channel))
    if not middle > highest:
        return f'; say it with `shaftprint convert --unit "{channel.name}={unit}"`'
    return (
        f" and values around {middle:.4g}, too large for {unit}; if they are {thousandth}, say it with "
        f'`shaftprint convert --unit "{channel.name}={thousandth}"`'
    )


def _plain(unit: str) -> str:
    return unit.replace(" ", "").replace("·", "").replace("*", "")
