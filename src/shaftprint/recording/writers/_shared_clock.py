"""What formats with clocks, or with a single one, demand of the channels."""

from collections.abc import Iterable
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel


def on_one_clock(path: Path, channels: Iterable[Channel]) -> tuple[Channel, ...]:
    """Return the channels if all have the same rate, start and number of samples.

    Raises
    ------
    RecordingError
        If there is no channel or their clocks differ.
    """
    shared = tuple(channels)
    if not shared:
        raise RecordingError(f"{path}: expected at least one channel to write, found none.")
    for channel in shared:
        expect_no_messages(path, channel, on="one clock")
    clocks = {(channel.rate_hz, channel.start_s, channel.count) for channel in shared}
    if len(clocks) > 1:
        listed = ", ".join(
            f"{item.name} ({item.rate_hz:g} Hz from {item.start_s:g} s, {item.count})" for item in shared
        )
        raise RecordingError(
            f"{path}: expected channels on one clock, found {listed}; write_recording keeps each channel's own."
        )
    return shared


def expect_no_messages(path: Path, channel: Channel, *, on: str) -> None:
    """Check that a channel lies on a clock, as in a format that keeps no time of each sample.

    Parameters
    ----------
    path, channel
        The file to write, and what into.
    on
        On what the format has its channels, in words.

    Raises
    ------
    RecordingError
        If it holds messages at times of their own.
    """
    if channel.is_uneven:
        raise RecordingError(
            f"{path}: expected channels on {on}, found messages at times of their own in {channel.name}; "
            "write .nc or .mf4, which keep them."
        )
