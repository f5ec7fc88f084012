"""MATLAB files up to version 7 (``save -v6``, ``save -v7``): vectors are channels."""

from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording._recording import Recording, Source, sha256_of
from shaftprint.recording._spool import Spool
from shaftprint.recording.readers._mat_variables import MatVariables, mat_channels, rate_hint

NAME = "MATLAB v5 to v7"

_SIGNATURE = b"MATLAB 5.0 MAT-file"
_NUMBERS = (
    "double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64",
)  # fmt: skip


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a MATLAB file of these versions."""
    with path.open("rb") as file:
        return file.read(len(_SIGNATURE)) == _SIGNATURE


def read(path: Path, **hints: object) -> Recording:
    """Read a MATLAB file into temporary files, one vector after the other.

    Hint: ``sample_rate_hz`` where the file has no clock.

    Raises
    ------
    RecordingError
        If the file is damaged, or has no channels or no clock.
    """
    rate = rate_hint(path, hints)
    spool: Spool | None = None
    try:
        variables = _survey(path)
        names = list(variables.vectors)
        spool = Spool(path, names)
        for number, name in enumerate(names):
            spool.append_column(number, _load(path, name).ravel())
        spool.finish()
        sources = {name: spool.source(number) for number, name in enumerate(names)}

        def source_of(name: str) -> Source:
            return sources[name]

        channels = mat_channels(path, variables, source_of, rate_hz=rate)
        return Recording(path=path, sha256=sha256_of(path), format=NAME, channels=channels, release=spool.close)
    except BaseException as error:
        if spool is not None:
            spool.close()
        # SciPy raises errors of many kinds on damaged bytes
        if isinstance(error, RecordingError) or not isinstance(error, Exception):
            raise
        raise RecordingError(
            f"{path}: expected a whole MATLAB file, found a damaged or truncated one ({error})."
        ) from None


def _survey(path: Path) -> MatVariables:
    vectors: dict[str, int] = {}
    scalars: dict[str, float] = {}
    texts: dict[str, str] = {}
    for name, shape, kind in scipy.io.whosmat(path):
        size = int(np.prod(shape))
        if kind == "char" and size:
            texts[name] = str(_load(path, name).ravel()[0])
        elif kind in _NUMBERS and size == 1:
            scalars[name] = float(_load(path, name).real.ravel()[0])
        elif kind in _NUMBERS and size == max(shape) and size > 1:
            vectors[name] = size
    return MatVariables(vectors=vectors, scalars=scalars, texts=texts)


def _load(path: Path, name: str) -> NDArray[Any]:
    values: NDArray[Any] = scipy.io.loadmat(path, variable_names=[name])[name]
    if values.dtype.kind == "c":
        raise RecordingError(f"{path}, variable {name}: expected real numbers, found complex ones.")
    return values
