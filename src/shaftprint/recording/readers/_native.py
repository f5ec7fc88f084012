"""The native container: HDF5 laid out as NetCDF-4, counts in int16, each channel on its own clock."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording._container import FORMAT, GROUP, VERSION
from shaftprint.recording._recording import Channel, Recording, sha256_of
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._hints import expect_hints

NAME = "shaftprint recording (NetCDF-4)"

_HDF5_SIGNATURE = b"\x89HDF\r\n\x1a\n"


def is_mine(path: Path) -> bool:
    """Return whether the file is a native container, or HDF5 that is too damaged to tell."""
    with path.open("rb") as file:
        if file.read(len(_HDF5_SIGNATURE)) != _HDF5_SIGNATURE:
            return False
    try:
        with h5py.File(path, "r") as file:
            return bool(file.attrs.get("format") == FORMAT)
    except Exception:
        # h5py raises errors of many kinds on damaged bytes
        return True


def read(path: Path, **hints: object) -> Recording:
    """Open a native container; blocks are read and unpacked as channels are asked for them.

    Raises
    ------
    RecordingError
        If the file is damaged, of a later version, or lacks an attribute.
    """
    expect_hints(path, hints, {})
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise RecordingError(
            f"{path}: expected a whole recording, found a damaged or truncated file ({error})."
        ) from None
    try:
        with told_as_damage(path, NAME):
            return _recording(path, file)
    except BaseException:
        file.close()
        raise


def _recording(path: Path, file: Any) -> Recording:
    version = int(file.attrs.get("format_version", 0))
    if version != VERSION:
        raise RecordingError(
            f"{path}: expected version {VERSION} of the {FORMAT} format, found {version}; use a later shaftprint."
        )
    if GROUP not in file:
        raise RecordingError(f'{path}: expected a group "{GROUP}", found none.')
    channels = {
        name: _channel(path, name, dataset)
        for name, dataset in file[GROUP].items()
        if "sample_rate_hz" in dataset.attrs
    }
    return Recording(path=path, sha256=sha256_of(path), format=NAME, channels=channels, release=file.close)


def _channel(path: Path, name: str, dataset: Any) -> Channel:
    attributes = dataset.attrs
    needed = ["units", "sample_rate_hz", "start_s"]
    if dataset.dtype.kind == "i":
        needed += ["scale_factor", "add_offset"]
    missing = [key for key in needed if key not in attributes]
    if missing:
        raise RecordingError(
            f"{path}, channel {name}: expected the attributes {', '.join(needed)}, "
            f"found none named {', '.join(missing)}."
        )

    count = int(np.prod(dataset.shape))
    stored = int(dataset.id.get_storage_size())
    expect_plausible(path, name, samples=count, sample_bytes=dataset.dtype.itemsize, stored_bytes=stored)

    def source(start: int, stop: int) -> NDArray[Any]:
        if not dataset:
            raise RecordingError(f"{path}, channel {name}: the recording has been closed already.")
        try:
            counts: NDArray[Any] = dataset[start:stop]
        except (OSError, RuntimeError) as error:
            raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are damaged ({error}).") from None
        return counts

    return Channel(
        name=name,
        unit=str(attributes["units"]),
        rate_hz=float(attributes["sample_rate_hz"]),
        start_s=float(attributes["start_s"]),
        count=count,
        scale=float(attributes.get("scale_factor", 1.0)),
        offset=float(attributes.get("add_offset", 0.0)),
        long_name=str(attributes.get("long_name", "")),
        source=source,
    )
