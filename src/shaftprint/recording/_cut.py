"""A stretch of a recording as a separate recording."""

import math
from dataclasses import replace

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording

# A time that is printed and read again may be off a sample by rounding.
_ROUNDING = 1e-6


def cut(recording: Recording, *, from_s: float | None = None, to_s: float | None = None) -> Recording:
    """Return the samples from one second of a recording on to just before another, read as they are asked for.

    Times stay: second 100 of the recording is second 100 of the stretch, so campaign files and clock maps hold for
    both. A stretch to a second and one from it on follow on each other. Closing the stretch closes the recording.

    Parameters
    ----------
    recording
        The recording, open.
    from_s
        Its first second [s]; the beginning of each channel if not given.
    to_s
        The second before which it ends [s]; the end of each channel if not given.

    Raises
    ------
    RecordingError
        If the end is not after the beginning, one of both lies outside of the recording, or a channel has no sample in
        between.
    """
    _expect_within(recording, from_s, to_s)
    channels = {name: _cut_channel(recording, channel, from_s, to_s) for name, channel in recording.channels.items()}
    return replace(recording, channels=channels)


def _expect_within(recording: Recording, from_s: float | None, to_s: float | None) -> None:
    begins = min((channel.start_s for channel in recording.channels.values()), default=0.0)
    ends = max((channel.start_s + channel.duration_s for channel in recording.channels.values()), default=0.0)
    first, last = begins if from_s is None else from_s, ends if to_s is None else to_s
    if not (math.isfinite(first) and math.isfinite(last)) or first >= last:
        raise RecordingError(
            f"{recording.path}: expected a stretch that ends after it begins, found {first:g} to {last:g} s of a "
            f"recording from {begins:g} to {ends:g} s."
        )
    shortest = min((1.0 / channel.rate_hz for channel in recording.channels.values()), default=0.0)
    if first < begins - _ROUNDING * shortest or last > ends + _ROUNDING * shortest:
        raise RecordingError(
            f"{recording.path}: expected a stretch within the recording, which goes from {begins:g} to {ends:g} s, "
            f"found {first:g} to {last:g} s; choose other seconds."
        )


def _cut_channel(recording: Recording, channel: Channel, from_s: float | None, to_s: float | None) -> Channel:
    first = 0 if from_s is None else max(channel.samples_before(from_s), 0)
    last = channel.count if to_s is None else min(channel.samples_before(to_s), channel.count)
    if first >= last:
        raise RecordingError(
            f"{recording.path}, channel {channel.name}: expected samples in the stretch, found it recorded from "
            f"{channel.start_s:g} to {channel.start_s + channel.duration_s:g} s only; choose other seconds or leave "
            "the channel out."
        )
    return channel.part(first, last)
