"""Clocks that count from 1970, brought to the beginning of the recording."""

from collections.abc import Mapping
from datetime import UTC, datetime, timedelta

from shaftprint.recording._channel import Channel

# three years: no test lasts that long
_LATER_THAN_ANY_TEST_S = 1e8
_LATEST_S = 4e9


def from_second_zero(channels: Mapping[str, Channel]) -> tuple[dict[str, Channel], datetime | None]:
    """Return channels with times from the first of them on, where they count seconds since 1970, and that date.

    Parameters
    ----------
    channels
        Channels as the file has them; those that begin within three years of their zero are left as they are.
    """
    starts = [channel.start_s for channel in channels.values() if channel.start_s > _LATER_THAN_ANY_TEST_S]
    if not starts:
        return dict(channels), None
    first = min(starts)
    began = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(seconds=first) if first < _LATEST_S else None
    moved = {
        name: channel.on_other_clock(start_s=channel.start_s - first, rate_hz=channel.rate_hz)
        if channel.start_s >= first
        else channel
        for name, channel in channels.items()
    }
    return moved, began
