"""MATLAB files of version 5, which every MATLAB and Octave reads."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any, BinaryIO

import scipy

from shaftprint.errors import RecordingError
from shaftprint.files import written_whole
from shaftprint.recording._channel import Channel
from shaftprint.recording.writers._mat_v73 import expect_matlab_names
from shaftprint.recording.writers._refused import told_as_refused
from shaftprint.recording.writers._shared_clock import on_one_clock

_LARGEST_BYTES = 2**31


def write_mat_v5(path: str | Path, channels: Iterable[Channel], *, overwrite: bool = False) -> None:
    """Write a column vector a channel with ``<channel>_unit``, and scalars ``sample_rate_hz`` and ``start_s``.

    Parameters
    ----------
    path
        The file to write, whole or not at all.
    channels
        Channels on one clock, of fewer than 2^31 bytes each as float64.
    overwrite
        Whether a file of that name may be replaced.

    Raises
    ------
    RecordingError
        If the clocks differ, a name is no MATLAB name, a vector is too long, or the file cannot be
        written.
    """
    path = Path(path)
    written = on_one_clock(path, channels)
    expect_matlab_names(path, (channel.name for channel in written))
    if 8 * written[0].count >= _LARGEST_BYTES:
        raise RecordingError(
            f"{path}: expected vectors below 2 GiB for this version, found {written[0].count} samples; use v7.3."
        )
    with told_as_refused(path), written_whole(path, overwrite=overwrite) as part, part.open("wb") as file:
        _append(file, {"sample_rate_hz": written[0].rate_hz, "start_s": written[0].start_s})
        for channel in written:
            values = channel.values(0, channel.count)
            _append(file, {channel.name: values, f"{channel.name}_unit": channel.unit})


def _append(file: BinaryIO, variables: dict[str, Any]) -> None:
    """Add variables to an open file, so that one vector at a time is in memory."""
    # SciPy takes open files and writes the file header at their beginning only; its stubs know paths alone
    scipy.io.savemat(file, variables, oned_as="column", do_compression=True)  # type: ignore[arg-type]
