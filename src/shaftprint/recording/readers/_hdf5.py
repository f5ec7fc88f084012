"""HDF5 and NetCDF-4 files of other programs: vectors of numbers are channels."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Source
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._native import has_mark
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector, gather_vectors
from shaftprint.recording.readers.hdf5_files import expect_storage, is_hdf5, open_hdf5

NAME = "HDF5 or NetCDF-4"

_MOST_COLUMNS = 64


def is_mine(path: Path) -> bool:
    """Return whether the file begins as HDF5, without the mark of the native container."""
    return is_hdf5(path) and not has_mark(path)


def read(path: Path, **hints: object) -> Recording:
    """Open an HDF5 or NetCDF-4 file; samples are read as channels are asked for them.

    Hints: ``sample_rate_hz`` where the file has no clock; ``time_unit`` of times without a unit.

    Raises
    ------
    RecordingError
        If the file is damaged or no channel can be used.
    """
    rate, unit = rate_hint(path, hints, {"time_unit": str}), expect_time_unit(path, hints.get("time_unit"))
    file = open_hdf5(path, NAME)
    opened = Opened(path, file.close)
    try:
        with told_as_damage(path, NAME):
            vectors: list[Vector] = []
            scalars = {"": _numbers(file.attrs)}
            _walk(path, file, "", opened, vectors, scalars, depth=0)
            gathered = gather_vectors(path, vectors, scalars, rate_hz=rate, time_unit=unit)
            return gathered.recording_from_second_zero(NAME, opened.close)
    except BaseException:
        opened.close()
        raise


def _walk(
    path: Path,
    group: Any,
    name: str,
    opened: Opened,
    vectors: list[Vector],
    scalars: dict[str, dict[str, float]],
    *,
    depth: int,
) -> None:
    """Collect the vectors and numbers of a group and of those in it; links may make circles, so to a depth only."""
    for key, item in group.items():
        inside = f"{name}/{key}" if name else key
        if isinstance(item, h5py.Group) and depth < 8:
            scalars[inside] = _numbers(item.attrs)
            _walk(path, item, inside, opened, vectors, scalars, depth=depth + 1)
        elif isinstance(item, h5py.Dataset) and item.dtype.kind in "fiu" and item.shape is not None:
            if item.size == 1:
                scalars.setdefault(name, {})[key] = float(np.asarray(item[()]).ravel()[0])
            elif item.ndim == 1 and item.size > 1:
                vectors.append(_vector(path, item, key, name, opened))
            elif item.ndim == 2 and 1 < item.shape[1] <= _MOST_COLUMNS < item.shape[0]:
                vectors += [
                    _vector(path, item, f"{key} column {column + 1}", name, opened, column)
                    for column in range(item.shape[1])
                ]


def _vector(path: Path, item: Any, key: str, group: str, opened: Opened, column: int | None = None) -> Vector:
    count = int(item.shape[0])
    expect_storage(path, key, item)
    attributes = {name: _plain(value) for name, value in item.attrs.items() if not name.isupper()}
    scale = float(np.asarray(item.attrs.get("scale_factor", 1.0)).ravel()[0])
    offset = float(np.asarray(item.attrs.get("add_offset", 0.0)).ravel()[0])
    scales = item.dims[0].keys() if item.dims[0] else []
    axis = str(item.dims[0][0].name).rsplit("/", 1)[-1] if len(item.dims[0]) else ""
    return Vector(
        name=key,
        group=group,
        count=count,
        source=_source(path, key, item, opened, column),
        axis=axis if scales and axis != key else "",
        attributes=attributes,
        scale=scale,
        offset=offset,
    )


def _source(path: Path, name: str, item: Any, opened: Opened, column: int | None) -> Source:
    fills = [item.attrs[key] for key in ("_FillValue", "missing_value") if key in item.attrs]

    def read_samples(start: int, stop: int) -> NDArray[Any]:
        opened.expect_open(name)
        try:
            counts: NDArray[Any] = item[start:stop] if column is None else item[start:stop, column]
        except (OSError, RuntimeError) as error:
            raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are damaged ({error}).") from None
        if counts.dtype == np.int16 and not fills:
            return counts.astype(np.int16)
        values = counts.astype(np.float64)
        for fill in fills:
            values[counts == np.asarray(fill).ravel()[0]] = np.nan
        return values

    return read_samples


def _numbers(attributes: Any) -> dict[str, float]:
    plain = {name.lower(): _plain(value) for name, value in attributes.items() if not name.startswith("_")}
    return {name: float(value) for name, value in plain.items() if isinstance(value, int | float)}


def _plain(value: Any) -> object:
    """Return an attribute as text or number, as far as it is one."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    array = np.asarray(value)
    if array.size == 1 and array.dtype.kind in "fiu":
        return float(array.ravel()[0])
    if array.size == 1 and array.dtype.kind in "SO":
        first = array.ravel()[0]
        return first.decode("utf-8", "replace") if isinstance(first, bytes) else str(first)
    return str(value)
