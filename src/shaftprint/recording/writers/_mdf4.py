"""ASAM MDF 4 files: one channel group a clock, counts with a linear conversion."""

from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording.readers._extra import library
from shaftprint.recording.writers._refused import told_as_refused
from shaftprint.recording.writers._shared_clock import by_clock

_VERSION = "4.10"


def write_mdf4(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> None:
    """Write channels, each on its own clock, as MDF 4.10; channels on one clock share a group.

    ``path``: the file to write, whole or not at all. ``channels``: channels of any recording; counts are written as
    counts with their scale. ``began``: date of second 0, where it is known. ``overwrite``: whether a file of that name
    may be replaced. Raises RecordingError if asammdf is not installed or the file cannot be written.
    """
    path = Path(path)
    asammdf = library(path, "asammdf", "MDF")
    with told_as_refused(path), written_whole(path, overwrite=overwrite) as part:
        file = asammdf.MDF(version=_VERSION)
        # not the date of writing: the same recording is to give the same file
        file.start_time = began or datetime(1970, 1, 1, tzinfo=UTC)
        try:
            for number, group in enumerate(by_clock(channels)):
                _append(asammdf, file, number, group)
            # the library gives every name another ending than its own
            written = Path(str(file.save(part.with_suffix(".mf4"), overwrite=True)))
        finally:
            file.close()
        written.replace(part)


def _append(asammdf: Any, file: Any, number: int, group: list[Channel]) -> None:
    count = group[0].count
    first = min(CHUNK_SAMPLES, count)
    times = group[0].stamps_s(0, first)
    file.append([_signal(asammdf, channel, first, times) for channel in group], comment="shaftprint")
    for start in range(first, count, CHUNK_SAMPLES):
        stop = min(start + CHUNK_SAMPLES, count)
        columns = [group[0].stamps_s(start, stop), *(channel.read(start, stop) for channel in group)]
        file.extend(number, [(column, None) for column in columns])


def _signal(asammdf: Any, channel: Channel, first: int, times: Any) -> Any:
    counts = channel.read(0, first)
    is_scaled = counts.dtype == np.int16 and (channel.scale, channel.offset) != (1.0, 0.0)
    return asammdf.Signal(
        samples=counts,
        timestamps=times,
        name=channel.name,
        unit=channel.unit,
        comment=channel.long_name,
        conversion={"a": channel.scale, "b": channel.offset} if is_scaled else None,
    )
