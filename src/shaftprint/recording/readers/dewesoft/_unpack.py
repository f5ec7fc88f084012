"""A separate program that lets Dewesoft's native library unpack a file: what it does to memory stays there."""

import ctypes
import importlib
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.recording.readers.dewesoft._index import INDEX, UnpackedChannel

_BLOCK = 262_144


def unpack(source: Path, folder: Path) -> None:
    """Write one file of float64 values a channel, its times where they are not those of a clock, and an index.

    ``source``: the Dewesoft file. ``folder``: an empty folder.
    """
    library = importlib.import_module("dwdatareader")
    with library.DWFile(str(source)) as file:
        channels = [_unpacked(library, file, number, key, folder) for number, key in enumerate(file)]
        # samples count from when measuring began; storing, as on a trigger, may have begun later
        moment = file.info.start_measure_time
        began = moment.isoformat() if moment.year > 1900 else None
    index = {"began": began, "channels": [channel.as_dict() for channel in channels]}
    (folder / INDEX).write_text(json.dumps(index), encoding="utf-8")


def _unpacked(library: Any, file: Any, number: int, key: str, folder: Path) -> UnpackedChannel:
    """Return a channel, or that the library refuses it: those of a CAN bus it refuses in files that it reads else."""
    try:
        return _unpack(library, file, number, key, folder)
    except library.DWError as error:
        reason = (
            f"expected samples, found that Dewesoft's library refuses the channel ({error}); export it in Dewesoft X."
        )
        return UnpackedChannel(name=str(key), unit="", reason=reason)


def _unpack(library: Any, file: Any, number: int, key: str, folder: Path) -> UnpackedChannel:
    channel = file[key]
    about = {"name": str(channel.unique_key), "unit": channel.unit, "description": channel.description}
    reason = _unusable(library, channel)
    if reason is not None:
        return UnpackedChannel(**about, reason=reason)
    is_regular = int(channel.channel_type) == 0
    rate = float(channel.sample_rate) if is_regular else 0.0
    count = int(channel.number_of_samples)
    first = 0.0
    with (folder / f"{number}.values").open("wb") as values, (folder / f"{number}.times").open("wb") as times:
        for start in range(0, count, _BLOCK):
            time, data = _read(library, file, channel, start, min(_BLOCK, count - start))
            first = float(time[0]) if start == 0 else first
            data.tofile(values)
            if is_regular:
                # what is stored on a trigger has gaps, and then each sample has its time
                expected = first + np.arange(start, start + time.size) / rate
                if np.max(np.abs(time - expected)) > 0.5 / rate:
                    return UnpackedChannel(**about, reason="expected samples without a gap, found the file triggered.")
            else:
                time.tofile(times)
    return UnpackedChannel(**about, number=number, count=count, rate_hz=rate, start_s=first)


def _unusable(library: Any, channel: Any) -> str | None:
    if isinstance(channel, library.DWBinaryChannel | library.DWComplexChannel):
        return "expected real numbers, found complex or binary ones."
    if int(channel.channel_type) > 1:
        return "expected samples, found a single value."
    if channel.array_size != 1:
        return f"expected one number a sample, found {channel.array_size}."
    return None if channel.number_of_samples else "expected samples, found none."


def _read(library: Any, file: Any, channel: Any, start: int, count: int) -> tuple[Any, Any]:
    # the package's own generator sorts by time and drops doubled times
    data, time = np.zeros(count), np.zeros(count)
    status = library.DLL.DWIGetScaledSamples(
        file.reader_handle,
        channel.index,
        ctypes.c_longlong(start),
        ctypes.c_longlong(count),
        data.ctypes,
        time.ctypes,
    )
    if status:
        raise library.DWError(status)
    return time, data


if __name__ == "__main__":
    unpack(Path(sys.argv[1]), Path(sys.argv[2]))
