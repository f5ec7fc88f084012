"""A recording of arrays in memory, for readers from outside and for tests."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel, Source
from shaftprint.recording._recording import Recording, sha256_of


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Samples:
    """The samples of one channel in memory."""

    name: str
    """Name of the channel."""
    values: ArrayLike
    """Values in its unit, shape (samples,)."""
    unit: str
    """Unit of the values."""
    rate_hz: float
    """Sample rate [Hz]."""
    start_s: float = 0.0
    """Time of the first sample [s]."""


def recording_from_arrays(
    path: str | Path, samples: Iterable[Samples], *, format: str, began: datetime | None = None
) -> Recording:
    """Make a recording of arrays that were read from a file.

    Parameters
    ----------
    path
        The file that they were read from; its SHA-256 is taken.
    samples
        The channels.
    format
        Name of the file format.
    began
        Date and time of second 0, where the file gives it.

    Raises
    ------
    RecordingError
        If a name comes twice, or values are no vector of real numbers.
    """
    path = Path(path)
    channels: dict[str, Channel] = {}
    for item in samples:
        values = np.asarray(item.values)
        if values.ndim != 1 or values.dtype.kind not in "fiub" or item.name in channels:
            raise RecordingError(
                f"{path}, channel {item.name}: expected a unique name and a vector of real numbers, "
                f"found {values.dtype} of shape {values.shape}."
            )
        channels[item.name] = channel_of(item)
    return Recording(path=path, sha256=sha256_of(path), format=format, channels=channels, began=began)


def channel_of(samples: Samples) -> Channel:
    """Return a channel whose samples are in memory; it keeps a copy of them."""
    values = np.asarray(samples.values).astype(np.float64)
    return Channel(
        name=samples.name,
        unit=samples.unit,
        rate_hz=samples.rate_hz,
        start_s=samples.start_s,
        count=values.size,
        source=_source(values),
    )


def _source(values: NDArray[np.float64]) -> Source:
    def read(start: int, stop: int) -> FloatArray:
        return values[start:stop].copy()

    return read
