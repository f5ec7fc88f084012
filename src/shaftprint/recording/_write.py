"""Copying channels into the native container."""

from collections.abc import Iterable, Mapping
from datetime import datetime
from pathlib import Path

from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording._writer import RecordingWriter


def write_recording(
    path: str | Path,
    channels: Iterable[Channel],
    *,
    attributes: Mapping[str, str | float] | None = None,
    began: datetime | None = None,
    overwrite: bool = False,
) -> None:
    """Write channels, each on its own clock, into the native container.

    Parameters
    ----------
    path
        The file to write, whole or not at all.
    channels
        Channels of any recording; counts are copied as they are.
    attributes
        Facts on the whole recording.
    began
        Date of second 0, where it is known.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    RecordingError
        If the file exists and may not be replaced, or cannot be written.
    """
    written = list(channels)
    with RecordingWriter(path, attributes=attributes, began=began, overwrite=overwrite) as writer:
        for channel in written:
            writer.declare(
                channel.name,
                unit=channel.unit,
                rate_hz=channel.rate_hz,
                start_s=channel.start_s,
                scale=channel.scale,
                offset=channel.offset,
                long_name=channel.long_name,
                dtype="int16" if channel.holds_counts else "float64",
                times="by rate" if channel.stamps is None else "uneven" if channel.is_uneven else "beside the rate",
                clock_jumps=channel.clock_jumps,
                is_of_edges=channel.is_of_edges,
            )
        # block by block, not channel by channel: some formats keep all channels of a moment in one record
        for start in range(0, max((channel.count for channel in written), default=0), CHUNK_SAMPLES):
            for channel in written:
                stop = min(start + CHUNK_SAMPLES, channel.count)
                if start < stop:
                    time_s = None if channel.stamps is None else channel.stamps_s(start, stop)
                    writer.append(channel.name, channel.read(start, stop), time_s)
