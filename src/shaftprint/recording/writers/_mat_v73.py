"""MATLAB files of version 7.3: HDF5 behind a MATLAB header of 512 bytes."""

import contextlib
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording._container import CHUNK_SAMPLES
from shaftprint.recording._hdf5_output import Hdf5Output
from shaftprint.recording.writers._refused import told_as_refused
from shaftprint.recording.writers._shared_clock import on_one_clock

_USERBLOCK_BYTES = 512
_TEXT_BYTES = 116

# After the text: no subsystem, version 7.3, byte order little-endian ("IM").
_HEADER_END = bytes(8) + b"\x00\x02IM"


def write_mat_v73(path: str | Path, channels: Iterable[Channel], *, overwrite: bool = False) -> None:
    """Write a column vector a channel with ``<channel>_unit``, and scalars ``sample_rate_hz`` and ``start_s``.

    Parameters
    ----------
    path
        The file to write, whole or not at all.
    channels
        Channels on one clock.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    RecordingError
        If the clocks differ, a name is no MATLAB name, or the file cannot be written.
    """
    path = Path(path)
    written = on_one_clock(path, channels)
    expect_matlab_names(path, (channel.name for channel in written))
    with told_as_refused(path), written_whole(path, overwrite=overwrite) as part:
        with contextlib.closing(Hdf5Output(part, userblock_size=_USERBLOCK_BYTES)) as output:
            with output.calls():
                _write_scalar(output.file, "sample_rate_hz", written[0].rate_hz)
                _write_scalar(output.file, "start_s", written[0].start_s)
            for channel in written:
                _write_vector(output, channel)
                with output.calls():
                    _write_text(output.file, f"{channel.name}_unit", channel.unit)
        with part.open("r+b") as raw:
            text = b"MATLAB 7.3 MAT-file, written by shaftprint"
            raw.write(text.ljust(_TEXT_BYTES) + _HEADER_END)


def _write_scalar(file: Any, name: str, value: float) -> None:
    _mark(file.create_dataset(name, data=np.full((1, 1), value)), "double")


def _write_vector(output: Hdf5Output, channel: Channel) -> None:
    """Write a column vector: MATLAB counts dimensions the other way round than HDF5."""
    with output.calls():
        dataset = output.file.create_dataset(
            channel.name,
            shape=(1, channel.count),
            dtype=np.float64,
            chunks=(1, min(CHUNK_SAMPLES, max(channel.count, 1))),
            compression="gzip",
            compression_opts=1,
            shuffle=True,
        )
        _mark(dataset, "double")
    for start, stop in channel.blocks(CHUNK_SAMPLES):
        values = channel.values(start, stop)
        with output.calls():
            dataset[0, start:stop] = values


def _write_text(file: Any, name: str, text: str) -> None:
    codes: NDArray[np.uint16] = np.array([ord(letter) for letter in text], dtype=np.uint16)
    if codes.size == 0:
        # an empty array is stored as its size
        dataset = file.create_dataset(name, data=np.zeros(2, dtype=np.uint64))
        dataset.attrs["MATLAB_empty"] = np.int32(1)
    else:
        dataset = file.create_dataset(name, data=codes[:, np.newaxis])
        dataset.attrs["MATLAB_int_decode"] = np.int32(2)
    _mark(dataset, "char")


def _mark(dataset: Any, kind: str) -> None:
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)


_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,57}")
"""A MATLAB name has at most 63 characters, of which ``_unit`` takes five."""

_TAKEN = ("sample_rate_hz", "start_s", "time", "t", "fs")


def expect_matlab_names(path: Path, names: Iterable[str]) -> None:
    """Refuse names that MATLAB or the reader would not take as those of channels.

    Raises RecordingError if a name cannot be a MATLAB variable or means the clock.
    """
    for name in names:
        if not _NAME.fullmatch(name) or name in _TAKEN:
            raise RecordingError(
                f'{path}: expected a channel name that MATLAB takes (letter, then letters, digits, "_"; '
                f'not {", ".join(_TAKEN)}), found "{name}".'
            )
