"""What formats with a single clock demand of the channels."""

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
    uneven = next((channel for channel in shared if channel.is_uneven), None)
    if uneven is not None:
        raise RecordingError(
            f"{path}: expected channels on one clock, found messages at times of their own in {uneven.name}; "
            "write .nc or .mf4, which keep them."
        )
    clocks = {(channel.rate_hz, channel.start_s, channel.count) for channel in shared}
    if len(clocks) > 1:
        listed = ", ".join(
            f"{item.name} ({item.rate_hz:g} Hz from {item.start_s:g} s, {item.count})" for item in shared
        )
        raise RecordingError(
            f"{path}: expected channels on one clock, found {listed}; write_recording keeps each channel's own."
        )
    return shared
