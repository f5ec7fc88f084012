"""HDF5 and NetCDF-4 files of other programs: vectors of numbers are channels."""

from dataclasses import dataclass, field
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
from shaftprint.recording.readers._netcdf_values import CountRule, never_written
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector, gather_vectors
from shaftprint.recording.readers.hdf5_files import expect_storage, is_hdf5, open_hdf5

NAME = "HDF5 or NetCDF-4"

_MOST_COLUMNS = 64
# whole, real and logical numbers
_NUMBERS = "fiub"
_AS_THEY_ARE = CountRule(scale=1.0, offset=0.0)


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
            found = _Found(scalars={"": _numbers(file.attrs)})
            _walk(path, file, "", opened, found, depth=0)
            gathered = gather_vectors(
                path, found.vectors, found.scalars, rate_hz=rate, time_unit=unit, left_out=found.left_out
            )
            return gathered.recording_from_second_zero(NAME, opened.close)
    except BaseException:
        opened.close()
        raise


@dataclass(frozen=True, kw_only=True, slots=True)
class _Found:
    """What a file holds."""

    scalars: dict[str, dict[str, float]]
    vectors: list[Vector] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)


def _walk(path: Path, group: Any, name: str, opened: Opened, found: _Found, *, depth: int) -> None:
    """Collect the vectors and numbers of a group and of those in it; links may make circles, so to a depth only."""
    for key, item in group.items():
        inside = f"{name}/{key}" if name else key
        if isinstance(item, h5py.Group) and depth < 8:
            found.scalars[inside] = _numbers(item.attrs)
            _walk(path, item, inside, opened, found, depth=depth + 1)
        elif isinstance(item, h5py.Dataset) and item.shape is not None and item.size:
            _keep(path, item, key, name, opened, found)


def _keep(path: Path, item: Any, key: str, group: str, opened: Opened, found: _Found) -> None:
    """Sort a data set into its kind: a number, a vector of any shape, columns or rows, a table, or none of them."""
    inside = f"{group}/{key}" if group else key
    axes = [axis for axis, length in enumerate(item.shape) if length > 1]
    if item.dtype.names is not None and len(axes) == 1:
        _keep_table(path, item, inside, axes[0], opened, found)
    elif item.dtype.kind not in _NUMBERS:
        # one text alone says something of the file and is no signal
        if axes:
            found.left_out[inside] = f"expected real numbers, found {_kind(item.dtype)}."
    elif not axes:
        found.scalars.setdefault(group, {})[key] = float(np.asarray(item[()]).ravel()[0])
    elif len(axes) == 1:
        found.vectors.append(_vector(path, item, key, group, opened, axes[0]))
    else:
        few = [axis for axis in axes if item.shape[axis] <= _MOST_COLUMNS]
        if item.ndim != 2 or len(few) != 1:
            size = " x ".join(map(str, item.shape))
            found.left_out[inside] = (
                f"expected a vector or at most {_MOST_COLUMNS} of them side by side, found an array of {size}; save "
                "each signal as a vector of its own."
            )
            return
        word = "row" if few[0] == 0 else "column"
        found.vectors.extend(
            _vector(path, item, f"{key} {word} {place + 1}", group, opened, 1 - few[0], place)
            for place in range(item.shape[few[0]])
        )


def _keep_table(path: Path, item: Any, inside: str, along: int, opened: Opened, found: _Found) -> None:
    """Take the fields of a compound type as vectors in a group of their own."""
    for name in item.dtype.names:
        kind = item.dtype[name]
        if kind.kind not in _NUMBERS or kind.shape:
            found.left_out[f"{inside}/{name}"] = f"expected real numbers, found {_kind(kind)}."
            continue
        expect_storage(path, inside, item)
        found.vectors.append(
            Vector(
                name=name,
                group=inside,
                count=int(item.shape[along]),
                source=_source(path, name, item.fields(name), opened, along, item.ndim, _AS_THEY_ARE),
            )
        )


def _kind(dtype: np.dtype[Any]) -> str:
    if dtype.names is not None or dtype.kind == "c":
        return "a table or complex numbers"
    return "several numbers a row" if dtype.shape else "text" if dtype.kind in "OSU" else str(dtype)


def _vector(path: Path, item: Any, key: str, group: str, opened: Opened, along: int, place: int = 0) -> Vector:
    """Return what lies along one axis of a data set, at one place of its other axis."""
    expect_storage(path, key, item)
    attributes = {name: _plain(value) for name, value in item.attrs.items() if not name.isupper()}
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
        source=_source(path, key, item, opened, along, item.ndim, rule, place=place),
        axis=axis if scales and axis != key else "",
        attributes=attributes,
        scale=rule.scale,
        offset=rule.offset,
    )


def _source(
    path: Path,
    name: str,
    item: Any,
    opened: Opened,
    along: int,
    axes: int,
    rule: CountRule,
    *,
    place: int = 0,
) -> Source:
    def read_samples(start: int, stop: int) -> NDArray[Any]:
        opened.expect_open(name)
        where = tuple(slice(start, stop) if axis == along else place for axis in range(axes))
        try:
            counts: NDArray[Any] = item[where]
        except (OSError, RuntimeError) as error:
            raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are damaged ({error}).") from None
        return rule.values(counts)

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
