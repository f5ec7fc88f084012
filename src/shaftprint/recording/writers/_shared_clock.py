"""What formats with clocks, or with a single one, demand of the channels."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel

# Times of messages that are looked through at once.
_LOOKED_THROUGH = 4096


def expect_channels(path: Path, channels: Sequence[Channel]) -> None:
    """Check that there is a channel.

    Raises RecordingError if there is none.
    """
    if not channels:
        raise RecordingError(f"{path}: expected at least one channel to write, found none.")


def on_one_clock(path: Path, channels: Iterable[Channel]) -> tuple[Channel, ...]:
    """Return the channels if all have the same rate, start and number of samples.

    Raises RecordingError if there is no channel or their clocks differ.
    """
    shared = tuple(channels)
    expect_channels(path, shared)
    for channel in shared:
        expect_no_messages(path, channel, on="one clock")
    clocks = {(channel.rate_hz, channel.start_s, channel.count) for channel in shared}
    if len(clocks) > 1:
        listed = ", ".join(
            f"{item.name} ({item.rate_hz:g} Hz from {item.start_s:g} s, {item.count})" for item in shared
        )
        raise RecordingError(
            f"{path}: expected channels on one clock, found {listed}; bring them onto one (shaftprint convert --rate), "
            "or write .nc, .mf4 or .tdms, where each keeps its own."
        )
    return shared


def by_clock(channels: Iterable[Channel]) -> list[list[Channel]]:
    """Return the channels in groups that share a clock, each with times of its own alone."""
    groups: dict[tuple[object, ...], list[Channel]] = {}
    for number, channel in enumerate(channels):
        clock = (channel.rate_hz, channel.start_s, channel.count)
        # times of its own are written for each channel: whether two share theirs would have to be read
        groups.setdefault(clock if channel.stamps is None else (*clock, number), []).append(channel)
    return list(groups.values())


def in_parts(channels: Sequence[Channel], length_s: float) -> Iterator[list[Channel]]:
    """Yield the channels in parts of so many seconds; those that have begun late or ended are empty there.

    ``channels``: channels of any recording. ``length_s``: length of each part [s].
    """
    stops = [0] * len(channels)
    while any(stop < one.count for one, stop in zip(channels, stops, strict=True)):
        starts = stops
        firsts = (
            one.time_s(first, first + 1) for one, first in zip(channels, starts, strict=True) if first < one.count
        )
        end_s = min(float(first[0]) for first in firsts) + length_s
        stops = [_stop_of(one, first, end_s) for one, first in zip(channels, starts, strict=True)]
        yield [one.part(first, last) for one, first, last in zip(channels, starts, stops, strict=True)]


def _stop_of(channel: Channel, first: int, end_s: float) -> int:
    """Return the number of the first sample, from one on, that is not before a time."""
    if not channel.is_uneven:
        return min(max(channel.samples_before(end_s), first), channel.count)
    # times of messages are read up to there: all of them again in each part would be the square of their number
    for start, stop in channel.part(first, channel.count).blocks(_LOOKED_THROUGH):
        before = channel.part(first + start, first + stop).samples_before(end_s)
        if before < stop - start:
            return first + start + before
    return channel.count


def expect_no_messages(path: Path, channel: Channel, *, on: str) -> None:
    """Check that a channel lies on a clock, as in a format that keeps no time of each sample.

    ``path``, ``channel``: the file to write, and what into. ``on``: on what the format has its channels, in words.
    Raises RecordingError if it holds messages at times of their own.
    """
    if channel.is_uneven:
        raise RecordingError(
            f"{path}: expected channels on {on}, found messages at times of their own in {channel.name}; "
            "write .nc, .mf4, .lvm, .uff or .blf, which keep them."
        )
