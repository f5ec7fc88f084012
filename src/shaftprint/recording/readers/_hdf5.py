"""HDF5 and NetCDF-4 files of other programs: vectors of numbers are channels."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.escape import printable
from shaftprint.files import kept_open
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._attributes import numbers_among, plain
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._native import has_mark
from shaftprint.recording.readers._netcdf_values import CountRule, never_written
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector, gather_vectors
from shaftprint.recording.readers.hdf5_files._open import (
    CANNOT_BE_OPENED,
    expect_storage,
    is_hdf5,
    open_hdf5,
    samples_along,
)

NAME = "HDF5 or NetCDF-4"

_MOST_COLUMNS = 64
_PANDAS = "pandas_type"
_OCTAVE, _VALUE = "OCTAVE_NEW_FORMAT", "value"
# whole, real and logical numbers
_NUMBERS = "fiub"
_AS_THEY_ARE = CountRule(scale=1.0, offset=0.0)


def is_mine(path: Path) -> bool:
    """Return whether the file begins as HDF5, without the mark of the native container."""
    return is_hdf5(path) and not has_mark(path)


def read(path: Path, **hints: object) -> Recording:
    """Open an HDF5 or NetCDF-4 file; samples are read as channels are asked for them.

    Hints: ``sample_rate_hz`` where the file has no clock; ``time_unit`` of times without a unit.

    Raises RecordingError if the file is damaged or no channel can be used.
    """
    rate, unit = rate_hint(path, hints, {"time_unit": str}), expect_time_unit(path, hints.get("time_unit"))
    file = open_hdf5(path, NAME)
    with kept_open(Opened(path, file.close)) as opened, told_as_damage(path, NAME):
        _expect_no_pandas(path, file)
        contents = _Contents(scalars={"": numbers_among(file.attrs)})
        _walk(path, file, "", opened, contents, depth=0)
        gathered = gather_vectors(
            path, contents.vectors, contents.scalars, rate_hz=rate, time_unit=unit, left_out=contents.left_out
        )
        return gathered.recording_from_second_zero(NAME, opened.close)


def _expect_no_pandas(path: Path, file: Any) -> None:
    """Refuse tables of pandas, whose columns stand in blocks with the names apart."""
    name = next((key for key, item in file.items() if isinstance(item, h5py.Group) and _PANDAS in item.attrs), None)
    if name is not None:
        raise RecordingError(
            f'{path}: expected vectors, found a table of pandas, "{printable(name)}"; write it as CSV, '
            f"pandas.read_hdf(FILE, {printable(name)!r}).to_csv(...)."
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class _Contents:
    """What a file holds."""

    scalars: dict[str, dict[str, float]]
    vectors: list[Vector] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)


def _walk(path: Path, group: Any, name: str, opened: Opened, contents: _Contents, *, depth: int) -> None:
    """Collect the vectors and numbers of a group and of those in it; links may make circles, so to a depth only."""
    for key, item in group.items():
        inside = f"{name}/{key}" if name else key
        if isinstance(item, h5py.Group) and _OCTAVE in item.attrs and _VALUE in item:
            # Octave keeps a variable as a group of its type and its value
            item = item[_VALUE]
        if item is None:
            contents.left_out[inside] = CANNOT_BE_OPENED
        if isinstance(item, h5py.Group) and depth < 8:
            contents.scalars[inside] = numbers_among(item.attrs)
            _walk(path, item, inside, opened, contents, depth=depth + 1)
        elif isinstance(item, h5py.Dataset) and item.shape is not None and item.size:
            _keep(path, item, key, name, opened, contents)


def _keep(path: Path, item: Any, key: str, group: str, opened: Opened, contents: _Contents) -> None:
    """Sort a data set into its kind: a number, a vector of any shape, columns or rows, a table, or none of them."""
    inside = f"{group}/{key}" if group else key
    axes = [axis for axis, length in enumerate(item.shape) if length > 1]
    if item.dtype.names is not None and len(axes) == 1:
        _keep_table(path, item, inside, axes[0], opened, contents)
    elif item.dtype.kind not in _NUMBERS:
        # one text alone says something of the file and is no signal
        if axes:
            contents.left_out[inside] = f"expected real numbers, found {_kind(item.dtype)}."
    elif not axes:
        contents.scalars.setdefault(group, {})[key] = float(np.asarray(item[()]).ravel()[0])
    elif len(axes) == 1:
        contents.vectors.append(_vector(path, item, key, group, opened, axes[0]))
    else:
        few = [axis for axis in axes if item.shape[axis] <= _MOST_COLUMNS]
        if item.ndim != 2 or len(few) != 1:
            size = " x ".join(map(str, item.shape))
            contents.left_out[inside] = (
                f"expected a vector or at most {_MOST_COLUMNS} of them side by side, found an array of {size}; save "
                "each signal as a vector of its own."
            )
            return
        word = "row" if few[0] == 0 else "column"
        contents.vectors.extend(
            _vector(path, item, f"{key} {word} {place + 1}", group, opened, 1 - few[0], place)
            for place in range(item.shape[few[0]])
        )


def _keep_table(path: Path, item: Any, inside: str, along: int, opened: Opened, contents: _Contents) -> None:
    """Take the fields of a compound type as vectors in a group of their own."""
    for name in item.dtype.names:
        kind = item.dtype[name]
        if kind.kind not in _NUMBERS or kind.shape:
            contents.left_out[f"{inside}/{name}"] = f"expected real numbers, found {_kind(kind)}."
            continue
        expect_storage(path, inside, item)
        contents.vectors.append(
            Vector(
                name=name,
                group=inside,
                count=int(item.shape[along]),
                source=samples_along(opened, name, item.fields(name), item.ndim, along, _AS_THEY_ARE.values),
            )
        )


def _kind(dtype: np.dtype[Any]) -> str:
    if dtype.names is not None or dtype.kind == "c":
        return "a table or complex numbers"
    return "several numbers a row" if dtype.shape else "text" if dtype.kind in "OSU" else str(dtype)


def _vector(path: Path, item: Any, key: str, group: str, opened: Opened, along: int, place: int = 0) -> Vector:
    """Return what lies along one axis of a data set, at one place of its other axis."""
    expect_storage(path, key, item)
    attributes = {name: plain(value) for name, value in item.attrs.items() if not name.isupper()}
    # the library of NetCDF names what it writes where nothing was written in the data set itself
    unwritten = never_written(item.dtype)
    rule = CountRule.of(item.attrs, item.dtype, unwritten=unwritten if item.fillvalue == unwritten else None)
    dimension = item.dims[along]
    scales = dimension.keys() if dimension else []
    axis = str(dimension[0].name).rsplit("/", 1)[-1] if len(dimension) else ""
    return Vector(
        name=key,
        group=group,
        count=int(item.shape[along]),
        source=samples_along(opened, key, item, item.ndim, along, rule.values, place=place),
        axis=axis if scales and axis != key else "",
        attributes=attributes,
        scale=rule.scale,
        offset=rule.offset,
    )
