"""Dewesoft files (d7d, d7z, dxd, dxz), unpacked by Dewesoft's own library in a separate process."""

import json
import subprocess
import sys
import tempfile
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel, Source
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._extra import expect_library
from shaftprint.recording.readers._gather import Gathered
from shaftprint.recording.readers._hints import expect_hints
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers.dewesoft._index import INDEX, UnpackedChannel
from shaftprint.units import plain_unit

NAME = "Dewesoft"

_ENDINGS = (".d7d", ".d7z", ".dxd", ".dxz")


def is_mine(path: Path) -> bool:
    """Return whether the file name ends as one of Dewesoft; the format of its bytes is not published."""
    return path.suffix.lower() in _ENDINGS


def read(path: Path, **hints: object) -> Recording:
    """Unpack a Dewesoft file into temporary files, one a channel; they are deleted when it is closed.

    Raises RecordingError if the library is absent or refuses the file, or no channel can be used.
    """
    expect_hints(path, hints, {})
    expect_library(path, "dwdatareader", NAME)
    folder = tempfile.TemporaryDirectory(prefix="shaftprint-", ignore_cleanup_errors=True)
    with kept_open(Opened(path, folder.cleanup)) as opened:
        index = _unpack(path, Path(folder.name))
        with told_as_damage(path, NAME):
            gathered = Gathered(path=path)
            for entry in index["channels"]:
                unpacked = UnpackedChannel(**entry)
                gathered.add(unpacked.name, partial(_channel, path, unpacked, Path(folder.name), opened))
            began = index["began"]
            return gathered.recording(NAME, opened.close, None if began is None else datetime.fromisoformat(began))


def _unpack(path: Path, folder: Path) -> Any:
    program = [sys.executable, "-m", "shaftprint.recording.readers.dewesoft._unpack", str(path.resolve()), str(folder)]
    done = subprocess.run(program, capture_output=True, text=True, errors="replace", check=False)  # noqa: S603
    if done.returncode != 0:
        messages = [line.strip() for line in done.stderr.splitlines() if line.strip()]
        reason = messages[-1] if messages else f"its library ended with code {done.returncode}"
        raise RecordingError(
            f"{path}: expected a whole {NAME} file, found one that Dewesoft's library refuses ({reason[:200]}); open "
            "it in Dewesoft X, or export it there as MATLAB or CSV."
        )
    return json.loads((folder / INDEX).read_text(encoding="utf-8"))


def _channel(path: Path, unpacked: UnpackedChannel, folder: Path, opened: Opened) -> Channel:
    if unpacked.reason:
        raise RecordingError(f"{path}: {unpacked.reason}")
    values = _floats(folder / f"{unpacked.number}.values", opened, unpacked.name)
    clock = SampleClock(rate_hz=unpacked.rate_hz, start_s=unpacked.start_s)
    if unpacked.rate_hz == 0.0:
        times = _floats(folder / f"{unpacked.number}.times", opened, unpacked.name)
        clock = clock_of_times(path, f"times of {unpacked.name}", unpacked.count, times)
    channel = Channel(
        name=unpacked.name,
        unit=plain_unit(unpacked.unit),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=unpacked.count,
        source=values,
        long_name=unpacked.description,
    )
    return on_clock(channel, clock)


def _floats(file: Path, opened: Opened, name: str) -> Source:
    def read(start: int, stop: int) -> FloatArray:
        opened.expect_open(name)
        return np.fromfile(file, dtype=np.float64, count=stop - start, offset=8 * start)

    return read
