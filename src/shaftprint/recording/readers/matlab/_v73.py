"""MATLAB files of version 7.3 (``save -v7.3``), which are HDF5: vectors are channels, also those in structures."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from shaftprint.files import kept_open
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector
from shaftprint.recording.readers.hdf5_files._open import CANNOT_BE_OPENED, expect_storage, open_hdf5, samples_along
from shaftprint.recording.readers.matlab._objects import keep_objects
from shaftprint.recording.readers.matlab._variables import (
    MOST_STRUCTURES,
    MatVariables,
    cell_reason,
    element_of,
    gather_variables,
    sparse_reason,
    titles_of,
)

NAME = "MATLAB v7.3"

_SIGNATURE = b"MATLAB 7.3 MAT-file"
# HDF5 behind MATLAB's header of 512 bytes; the first releases called themselves 7.0, mat-io 5.0.
_MATLAB, _HDF5, _HDF5_AT = b"MATLAB ", b"\x89HDF\r\n\x1a\n", 512
_PLAIN = (
    b"double", b"single", b"int8", b"uint8", b"int16", b"uint16", b"int32", b"uint32", b"int64", b"uint64",
    b"logical", b"",
)  # fmt: skip
_OBJECTS = (
    b"timetable", b"table", b"timeseries", b"datetime", b"duration", b"string", b"function_handle", b"FileWrapper__",
)  # fmt: skip
_DEEPEST = 4
_LONGEST_TEXT = 10_000


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a MATLAB file of this version."""
    with path.open("rb") as file:
        begin = file.read(_HDF5_AT + len(_HDF5))
    return begin.startswith(_SIGNATURE) or (begin.startswith(_MATLAB) and begin.endswith(_HDF5))


def read(path: Path, **hints: object) -> Recording:
    """Open a MATLAB file; samples are read as channels are asked for them.

    Hints: ``sample_rate_hz`` where the file has no clock; ``time_unit`` of times without a unit; ``columns``, what the
    columns of a table are.

    Raises RecordingError if the file is damaged, or has no channels or no clock.
    """
    rate = rate_hint(path, hints, {"columns": str, "time_unit": str})
    unit = expect_time_unit(path, hints.get("time_unit"))
    file = open_hdf5(path, "MATLAB")
    with kept_open(Opened(path, file.close)) as opened, told_as_damage(path, "MATLAB"):
        variables = MatVariables(titles=titles_of(hints))
        objects: dict[str, str] = {}
        _survey(path, file, "", file, opened, variables, objects)
        keep_objects(path, objects, variables)
        gathered = gather_variables(path, variables, rate_hz=rate, time_unit=unit)
        return gathered.recording_from_second_zero(NAME, opened.close)


def _survey(
    path: Path, group: Any, name: str, file: Any, opened: Opened, variables: MatVariables, objects: dict[str, str]
) -> None:
    """Sort what a group, or part of one, holds into its kind.

    ``name``: name of the group. ``file``: the open file.
    """
    for key, item in group.items():
        inside = f"{name}/{key}" if name else key
        if item is None:
            variables.left_out[inside] = CANNOT_BE_OPENED
            continue
        kind = bytes(np.bytes_(item.attrs.get("MATLAB_class", b"")))
        if key.startswith("#") or "MATLAB_empty" in item.attrs:
            continue
        if isinstance(item, h5py.Dataset) and item.dtype == h5py.ref_dtype and not kind and "(" not in name:
            # the field of several structures under one name
            for number, of_one in enumerate(item[()].ravel()[:MOST_STRUCTURES]):
                field = {key: file[of_one]} if of_one else {}
                _survey(path, field, element_of(name, number), file, opened, variables, objects)
            continue
        if "MATLAB_object_decode" in item.attrs or (isinstance(item, h5py.Dataset) and kind in _OBJECTS):
            objects[inside] = kind.decode("utf-8", "replace")
        elif isinstance(item, h5py.Group):
            if "MATLAB_sparse" in item.attrs:
                variables.left_out[inside] = sparse_reason(inside.replace("/", "."))
            elif kind in (b"struct", b"") and inside.count("/") < _DEEPEST:
                _survey(path, item, inside, file, opened, variables, objects)
        else:
            _keep(path, item, key, name, kind, opened, variables)


def _keep(path: Path, item: Any, key: str, group: str, kind: bytes, opened: Opened, variables: MatVariables) -> None:
    """Sort one data set into its kind."""
    length = max(item.shape or (1,), default=1)
    inside = f"{group}/{key}" if group else key
    if kind == b"char" and item.size <= _LONGEST_TEXT and item.dtype.kind == "u":
        variables.texts[group, key] = "".join(map(chr, item[()].ravel()))
    elif item.dtype.names is not None and length > 1:
        variables.left_out[inside] = "expected real numbers, found complex ones."
    elif item.dtype.kind == "O" and item.size:
        variables.left_out[inside] = cell_reason()
    elif kind not in _PLAIN or item.dtype.kind not in "fiu" or not item.size:
        return
    elif item.size == 1:
        variables.scalars.setdefault(group, {})[key] = float(item[()].ravel()[0])
    elif item.size == length:
        expect_storage(path, inside, item)
        variables.vectors.append(
            Vector(
                name=key,
                group=group,
                count=int(item.size),
                source=samples_along(opened, key, item, item.ndim, int(np.argmax(item.shape)), _as_numbers),
            )
        )
    else:
        expect_storage(path, inside, item)
        variables.add_table(
            inside, item.shape[::-1], lambda number: samples_along(opened, key, item, 2, 1, _as_floats, place=number)
        )


def _as_floats(stored: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(stored, dtype=np.float64)


def _as_numbers(stored: NDArray[Any]) -> NDArray[Any]:
    return stored if stored.dtype == np.int16 else _as_floats(stored)
