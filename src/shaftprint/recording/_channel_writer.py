"""One channel of the native container while it is being written."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES

# Measured on 22.9 million samples x 5 channels: level 1 writes in 3.2 s of CPU to 113 MB, level 4 in
# 5.1 s to 110 MB; all levels read in 0.8 s.
_GZIP_LEVEL = 1

# What the NetCDF-4 library writes into a dimension that has no variable.
_NO_VARIABLE = "This is a netCDF dimension but not a netCDF variable."


class ChannelWriter:
    """One data set that grows by whole blocks, so that every block is compressed once."""

    def __init__(self, group: Any, channel: Channel, dtype: np.dtype[Any]) -> None:
        self.dtype = dtype
        self._group = group
        self._name = channel.name
        self._written = 0
        self._waiting = np.empty(CHUNK_SAMPLES, dtype=dtype)
        self._waiting_count = 0
        self._dataset = group.create_dataset(
            channel.name,
            shape=(0,),
            maxshape=(None,),
            dtype=dtype,
            chunks=(CHUNK_SAMPLES,),
            compression="gzip",
            compression_opts=_GZIP_LEVEL,
            shuffle=True,
            fletcher32=True,
        )
        attributes: dict[str, str | float] = {
            "units": channel.unit,
            "long_name": channel.long_name,
            "sample_rate_hz": float(channel.rate_hz),
            "start_s": float(channel.start_s),
        }
        if dtype == np.int16:
            attributes |= {
                "scale_factor": float(channel.scale),
                "add_offset": float(channel.offset),
            }
        elif (channel.scale, channel.offset) != (1.0, 0.0):
            raise RecordingError(
                f"channel {channel.name}: expected scale 1 and offset 0 for values in float64, "
                f"found {channel.scale:g} and {channel.offset:g}."
            )
        self._dataset.attrs.update(attributes)

    def append(self, counts: NDArray[Any]) -> None:
        done = 0
        while done < counts.size:
            if self._waiting_count == 0 and counts.size - done >= CHUNK_SAMPLES:
                self._write(counts[done : done + CHUNK_SAMPLES])
                done += CHUNK_SAMPLES
                continue
            copied = min(CHUNK_SAMPLES - self._waiting_count, counts.size - done)
            stop = self._waiting_count + copied
            self._waiting[self._waiting_count : stop] = counts[done : done + copied]
            self._waiting_count = stop
            done += copied
            if self._waiting_count == CHUNK_SAMPLES:
                self._write(self._waiting)
                self._waiting_count = 0

    def finish(self, number: int) -> None:
        """Write what still waits and attach the channel's own dimension."""
        if self._waiting_count:
            self._write(self._waiting[: self._waiting_count])
            self._waiting_count = 0
        dimension = self._group.create_dataset(
            f"{self._name}_sample",
            shape=(self._written,),
            maxshape=(None,),
            chunks=(CHUNK_SAMPLES,),
            dtype=">f4",
        )
        dimension.make_scale(f"{_NO_VARIABLE}{self._written:>10}")
        dimension.attrs["_Netcdf4Dimid"] = np.int32(number)
        self._dataset.dims[0].attach_scale(dimension)

    def _write(self, counts: NDArray[Any]) -> None:
        stop = self._written + counts.size
        self._dataset.resize((stop,))
        self._dataset[self._written : stop] = counts
        self._written = stop
