"""MATLAB files of version 7.3 (``save -v7.3``), which are HDF5: vectors are channels."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.recording._recording import Recording, Source, sha256_of
from shaftprint.recording.readers._mat_variables import MatVariables, mat_channels, rate_hint

NAME = "MATLAB v7.3"

_SIGNATURE = b"MATLAB 7.3 MAT-file"


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a MATLAB file of this version."""
    with path.open("rb") as file:
        return file.read(len(_SIGNATURE)) == _SIGNATURE


def read(path: Path, **hints: object) -> Recording:
    """Open a MATLAB file; samples are read as channels are asked for them.

    Hint: ``sample_rate_hz`` where the file has no clock.

    Raises
    ------
    RecordingError
        If the file is damaged, or has no channels or no clock.
    """
    rate = rate_hint(path, hints)
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise RecordingError(
            f"{path}: expected a whole MATLAB file, found a damaged or truncated one ({error})."
        ) from None

    def source_of(name: str) -> Source:
        return _source(path, name, file[name])

    try:
        channels = mat_channels(path, _survey(path, file), source_of, rate_hz=rate)
        return Recording(path=path, sha256=sha256_of(path), format=NAME, channels=channels, release=file.close)
    except BaseException:
        file.close()
        raise


def _survey(path: Path, file: Any) -> MatVariables:
    vectors: dict[str, int] = {}
    scalars: dict[str, float] = {}
    texts: dict[str, str] = {}
    for name, dataset in file.items():
        if not isinstance(dataset, h5py.Dataset) or "MATLAB_empty" in dataset.attrs:
            continue
        kind = dataset.attrs.get("MATLAB_class", b"")
        if kind == b"char":
            texts[name] = "".join(map(chr, dataset[()].ravel()))
        elif dataset.dtype.names is not None and max(dataset.shape, default=1) > 1:
            raise RecordingError(f"{path}, variable {name}: expected real numbers, found complex ones.")
        elif dataset.dtype.kind in "fiu" and kind not in (b"cell", b"logical") and dataset.size == 1:
            scalars[name] = float(dataset[()].ravel()[0])
        elif dataset.dtype.kind in "fiu" and dataset.size == max(dataset.shape, default=0) and dataset.size > 1:
            vectors[name] = int(dataset.size)
    return MatVariables(vectors=vectors, scalars=scalars, texts=texts)


def _source(path: Path, name: str, dataset: Any) -> Source:
    along = int(np.argmax(dataset.shape))

    def read_samples(start: int, stop: int) -> NDArray[Any]:
        if not dataset:
            raise RecordingError(f"{path}, channel {name}: the recording has been closed already.")
        where = tuple(slice(start, stop) if axis == along else 0 for axis in range(dataset.ndim))
        try:
            values: NDArray[Any] = dataset[where]
        except OSError as error:
            raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are damaged ({error}).") from None
        return values if values.dtype == np.int16 else values.astype(np.float64)

    return read_samples
