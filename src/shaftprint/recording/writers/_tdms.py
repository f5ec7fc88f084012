"""NI TDMS files: one group, each channel with waveform properties and counts with a linear scale."""

from collections.abc import Iterable
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording.readers._extra import library
from shaftprint.recording.writers._refused import told_as_refused
from shaftprint.recording.writers._shared_clock import expect_no_messages, in_parts

_GROUP = "recording"
_NO_SCALE_BEFORE = 0xFFFFFFFF
_APPENDED_S = 10.0


def write_tdms(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> None:
    """Write channels, each on its own clock, as TDMS.

    ``path``: the file to write, whole or not at all. ``channels``: channels of any recording; counts are written as
    counts with their scale. ``began``: date of second 0 with its offset from UTC, where it is known. ``overwrite``:
    whether a file of that name may be replaced. Raises RecordingError if npTDMS is not installed or the file cannot be
    written.
    """
    path = Path(path)
    nptdms = library(path, "nptdms", "TDMS")
    with (
        told_as_refused(path),
        written_whole(path, overwrite=overwrite) as part,
        nptdms.TdmsWriter(str(part)) as writer,
    ):
        for channel in channels:
            expect_no_messages(path, channel, on="clocks")
            properties = _properties(nptdms.types, channel, began)
            # an empty channel is one segment without samples
            for start in range(0, max(channel.count, 1), CHUNK_SAMPLES):
                counts = channel.read(start, min(start + CHUNK_SAMPLES, channel.count))
                stated = properties if start == 0 else None
                writer.write_segment([nptdms.ChannelObject(_GROUP, channel.name, counts, stated)])


def write_tdms_appended(
    path: str | Path, channels: Iterable[Channel], *, began: datetime | None = None, overwrite: bool = False
) -> None:
    """Write channels as a program does that opens the file every ten seconds, appends what it has, and closes it.

    Each part states its start again: by the date where that is known, else by the offset. Parameters and errors are
    those of ``write_tdms``.
    """
    path, written = Path(path), list(channels)
    nptdms = library(path, "nptdms", "TDMS")
    for channel in written:
        expect_no_messages(path, channel, on="clocks")
    with told_as_refused(path), written_whole(path, overwrite=overwrite) as part:
        part.touch()
        for parts in in_parts(written, _APPENDED_S):
            with nptdms.TdmsWriter(str(part), mode="a") as writer:
                for channel in parts:
                    if not channel.count:
                        continue
                    stated = _properties(nptdms.types, channel, began)
                    if began is not None:
                        start = began + timedelta(seconds=channel.start_s)
                        stated |= _start_time(start) | {"wf_start_offset": 0.0}
                    counts = channel.read(0, channel.count)
                    writer.write_segment([nptdms.ChannelObject(_GROUP, channel.name, counts, stated)])


def _properties(types: Any, channel: Channel, began: datetime | None) -> dict[str, object]:
    properties: dict[str, object] = {
        "wf_increment": 1.0 / channel.rate_hz,
        "wf_start_offset": float(channel.start_s),
        "wf_samples": types.Int32(1),
        "unit_string": channel.unit,
        "description": channel.long_name,
    }
    if began is not None:
        properties |= _start_time(began)
    if channel.holds_counts and (channel.scale, channel.offset) != (1.0, 0.0):
        properties |= {
            "NI_Scaling_Status": "unscaled",
            "NI_Number_Of_Scales": types.Uint32(1),
            "NI_Scale[0]_Scale_Type": "Linear",
            "NI_Scale[0]_Linear_Slope": float(channel.scale),
            "NI_Scale[0]_Linear_Y_Intercept": float(channel.offset),
            "NI_Scale[0]_Linear_Input_Source": types.Uint32(_NO_SCALE_BEFORE),
        }
    return properties


def _start_time(start: datetime) -> dict[str, object]:
    return {"wf_start_time": np.datetime64(start.astimezone(UTC).replace(tzinfo=None), "us")}
