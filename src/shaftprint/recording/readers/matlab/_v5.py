"""MATLAB files up to version 7 (``save -v4``, ``-v6``, ``-v7``): vectors are channels, also those in structures."""

import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from shaftprint.files import kept_open
from shaftprint.recording._channel import Source
from shaftprint.recording._recording import Recording
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector
from shaftprint.recording.readers.matlab import _modelica
from shaftprint.recording.readers.matlab._objects import keep_objects
from shaftprint.recording.readers.matlab._v5_headers import MatHeader, headers_of
from shaftprint.recording.readers.matlab._variables import (
    MOST_STRUCTURES,
    MatVariables,
    cell_reason,
    element_of,
    gather_variables,
    object_reason,
    sparse_reason,
    titles_of,
)

NAME = "MATLAB v4 to v7"

_SIGNATURE = b"MATLAB 5.0 MAT-file"
# Version and byte order at the end of the header; programs other than MATLAB may write what they like before it.
_MARKS = (b"\x00\x01IM", b"\x01\x00MI")
# Those of version 7.3, whose header may say 5.0 for all that.
_MARKS_OF_HDF5 = (b"\x00\x02IM", b"\x02\x00MI")
_HEADER_BYTES = 128
_REAL = "fiub"
_DEEPEST = 4
_LONGEST_NAME = 64


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a MATLAB file of these versions; some need the file ending as well."""
    with path.open("rb") as file:
        begin = file.read(_HEADER_BYTES)
    named = path.suffix.lower() == ".mat"
    if begin.endswith(_MARKS_OF_HDF5):
        return False
    return begin.startswith(_SIGNATURE) or (named and (begin.endswith(_MARKS) or _is_v4(begin[:20])))


def read(path: Path, **hints: object) -> Recording:
    """Read a MATLAB file into temporary files, one variable after the other.

    Hints: ``sample_rate_hz`` where the file has no clock; ``time_unit`` of times without a unit; ``columns``, what the
    columns of a table are.

    Raises RecordingError if the file is damaged, or has no channels or no clock.
    """
    rate = rate_hint(path, hints, {"columns": str, "time_unit": str})
    unit = expect_time_unit(path, hints.get("time_unit"))
    with told_as_damage(path, "MATLAB"):
        headers = tuple(_headers(path))
        if {header.name for header in headers} >= _modelica.VARIABLES:
            trajectories = _modelica.read_trajectories(path, rate_hz=rate)
            return trajectories.recording(_modelica.NAME, lambda: None)
        with kept_open(Spool(path, ())) as spool:
            variables = _survey(path, headers, spool, titles_of(hints))
            gathered = gather_variables(path, variables, rate_hz=rate, time_unit=unit)
            spool.finish()
            return gathered.recording_from_second_zero(NAME, spool.close)


def _is_v4(begin: bytes) -> bool:
    """Return whether a header of version 4 makes sense: a type of digits MOPT, sizes, and a short name."""
    if len(begin) < 20:
        return False
    for order in "<>":
        kind, rows, columns, imaginary, length = struct.unpack(f"{order}5i", begin)
        digits = (kind // 1000, kind // 100 % 10, kind // 10 % 10, kind % 10)
        sensible = 0 <= digits[0] <= 4 and digits[1] == 0 and digits[2] <= 5 and digits[3] <= 2
        if (
            kind >= 0
            and sensible
            and rows >= 0
            and columns >= 0
            and imaginary in (0, 1)
            and 1 < length <= _LONGEST_NAME
        ):
            return True
    return False


def _survey(path: Path, headers: Iterable[MatHeader], spool: Spool, titles: tuple[str, ...]) -> MatVariables:
    """Load one variable after the other and keep its numbers on disk."""
    variables = MatVariables(titles=titles)
    objects: dict[str, str] = {}
    for header in headers:
        name = header.name
        if header.is_object:
            objects[name] = header.kind
        elif header.kind == "sparse":
            variables.left_out[name] = sparse_reason(name)
        elif header.kind == "cell":
            variables.left_out[name] = cell_reason()
        elif header.size:
            try:
                value = scipy.io.loadmat(path, variable_names=[name], struct_as_record=False, squeeze_me=True)[name]
            except TypeError:
                if header.kind != "char":
                    raise
                # texts with characters beyond 65535, as emoji
                variables.left_out[name] = "expected a text, found characters that SciPy cannot read."
                continue
            _keep(name, "", value, spool, variables)
    keep_objects(path, objects, variables)
    return variables


def _headers(path: Path) -> Iterable[MatHeader]:
    with path.open("rb") as file:
        begin = file.read(_HEADER_BYTES)
    if begin.endswith(_MARKS):
        return headers_of(path)
    # version 4 knows no objects, at which SciPy's list would stop
    variables = scipy.io.whosmat(path)
    return [MatHeader(name=name, kind=kind, shape=shape, is_object=False) for name, shape, kind in variables]


def _keep(name: str, group: str, value: Any, spool: Spool, variables: MatVariables) -> None:
    """Sort one value into its kind; a structure gives its fields."""
    fields = getattr(value, "_fieldnames", None)
    inside = f"{group}/{name}" if group else name
    if fields is not None:
        for key in fields if inside.count("/") < _DEEPEST else ():
            _keep(key, inside, getattr(value, key), spool, variables)
    elif isinstance(value, str):
        variables.texts[group, name] = value
    elif isinstance(value, np.ndarray) and value.size and all(hasattr(one, "_fieldnames") for one in value.flat):
        for number, one in enumerate(value.ravel(order="F")[:MOST_STRUCTURES]):
            _keep(element_of(name, number), group, one, spool, variables)
    elif scipy.sparse.issparse(value):
        variables.left_out[inside] = sparse_reason(name)
    else:
        _keep_array(name, group, np.asarray(value), spool, variables)


def _keep_array(name: str, group: str, array: NDArray[Any], spool: Spool, variables: MatVariables) -> None:
    inside = f"{group}/{name}" if group else name
    if array.dtype.names is not None:
        kind = str(array["s2"].ravel()[0], "utf-8", "replace") if "s2" in array.dtype.names else "object"
        variables.left_out[inside] = object_reason(inside.replace("/", "."), kind)
    elif array.dtype.kind == "O" and array.size:
        variables.left_out[inside] = cell_reason()
    elif array.dtype.kind == "c":
        variables.left_out[inside] = "expected real numbers, found complex ones."
    elif array.dtype.kind not in _REAL or not array.size:
        return
    elif array.size == 1:
        variables.scalars.setdefault(group, {})[name] = float(array.ravel()[0])
    elif array.ndim == 1:
        number = spool.add_column(inside)
        spool.append_column(number, array)
        variables.vectors.append(Vector(name=name, group=group, count=array.size, source=spool.source(number)))
    else:

        def column(number: int) -> Source:
            place = spool.add_column(f"{inside}({number + 1})")
            spool.append_column(place, array[:, number])
            return spool.source(place)

        variables.add_table(inside, array.shape, column)
