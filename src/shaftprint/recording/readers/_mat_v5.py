"""MATLAB files up to version 7 (``save -v4``, ``-v6``, ``-v7``): vectors are channels, also those in structures."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io

from shaftprint.recording._recording import Recording
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._mat_variables import MatVariables, gather_variables, object_reason
from shaftprint.recording.readers._vectors import Vector

NAME = "MATLAB v4 to v7"

_SIGNATURE = b"MATLAB 5.0 MAT-file"
_NUMBERS = (
    "double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
)  # fmt: skip
_OBJECTS = ("opaque", "object", "unknown", "function")
_DEEPEST = 4
_LONGEST_NAME = 64


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a MATLAB file of these versions; version 4 has the file ending as well."""
    with path.open("rb") as file:
        begin = file.read(20)
    return begin.startswith(_SIGNATURE) or (path.suffix.lower() == ".mat" and _is_v4(begin))


def read(path: Path, **hints: object) -> Recording:
    """Read a MATLAB file into temporary files, one variable after the other.

    Hint: ``sample_rate_hz`` where the file has no clock.

    Raises
    ------
    RecordingError
        If the file is damaged, or has no channels or no clock.
    """
    rate = rate_hint(path, hints)
    with told_as_damage(path, "MATLAB"):
        spool = Spool(path, ())
        try:
            gathered = gather_variables(path, _survey(path, spool), rate_hz=rate)
            spool.finish()
            return gathered.recording_from_second_zero(NAME, spool.close)
        except BaseException:
            spool.close()
            raise


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


def _survey(path: Path, spool: Spool) -> MatVariables:
    """Load one variable after the other and keep its numbers on disk."""
    variables = MatVariables()
    for name, shape, kind in scipy.io.whosmat(path):
        size = int(np.prod(shape))
        if kind in _OBJECTS or name.startswith("__") or name == "None":
            variables.left_out[name] = object_reason(name, "object")
        elif kind in (*_NUMBERS, "char", "struct") and size:
            value = scipy.io.loadmat(path, variable_names=[name], struct_as_record=False, squeeze_me=True)[name]
            _keep(name, "", value, spool, variables)
    return variables


def _keep(name: str, group: str, value: Any, spool: Spool, variables: MatVariables) -> None:
    """Sort one value into its kind; a structure gives its fields."""
    fields = getattr(value, "_fieldnames", None)
    inside = f"{group}/{name}" if group else name
    if fields is not None and inside.count("/") < _DEEPEST:
        for key in fields:
            _keep(key, inside, getattr(value, key), spool, variables)
        return
    if isinstance(value, str):
        variables.texts[group, name] = value
        return
    array = np.asarray(value)
    if array.dtype.kind == "c":
        variables.left_out[inside] = "expected real numbers, found complex ones."
    elif array.dtype.kind in "fiu" and array.size == 1:
        variables.scalars.setdefault(group, {})[name] = float(array.ravel()[0])
    elif array.dtype.kind in "fiu" and array.ndim == 1 and array.size > 1:
        number = spool.add_column(inside)
        spool.append_column(number, array)
        variables.vectors.append(Vector(name=name, group=group, count=array.size, source=spool.source(number)))
