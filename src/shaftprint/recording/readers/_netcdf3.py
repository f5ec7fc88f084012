"""NetCDF files of the classic kind (versions 1 and 2): vectors of numbers are channels."""

from pathlib import Path
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from shaftprint.files import kept_open
from shaftprint.recording._channel import Source
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._attributes import numbers_among, plain
from shaftprint.recording.readers._damage import expect_plausible, told_as_damage
from shaftprint.recording.readers._hints import rate_hint
from shaftprint.recording.readers._netcdf_values import CountRule, never_written
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers._time_scale import expect_time_unit
from shaftprint.recording.readers._vectors import Vector, gather_vectors

NAME = "NetCDF classic"

_SIGNATURES = (b"CDF\x01", b"CDF\x02")


def is_mine(path: Path) -> bool:
    """Return whether the file begins as a classic NetCDF file."""
    with path.open("rb") as file:
        return file.read(4) in _SIGNATURES


def read(path: Path, **hints: object) -> Recording:
    """Open a classic NetCDF file; samples are taken from the file as channels are asked for them.

    Hints: ``sample_rate_hz`` where the file has no clock; ``time_unit`` of times without a unit.

    Raises RecordingError if the file is damaged or no channel can be used.
    """
    rate, unit = rate_hint(path, hints, {"time_unit": str}), expect_time_unit(path, hints.get("time_unit"))
    with told_as_damage(path, NAME):
        file = scipy.io.netcdf_file(path, "r", mmap=False)
        opened = Opened(path, file.close)
    with kept_open(opened), told_as_damage(path, NAME):
        vectors = [
            _vector(path, name, variable, opened)
            for name, variable in file.variables.items()
            if len(variable.shape) == 1 and int(variable.shape[0]) > 1 and variable.typecode() in "hifdb"
        ]
        scalars = {"": numbers_among(vars(file)["_attributes"])}
        gathered = gather_vectors(path, vectors, scalars, rate_hz=rate, time_unit=unit)
        return gathered.recording_from_second_zero(NAME, opened.close)


def _vector(path: Path, name: str, variable: Any, opened: Opened) -> Vector:
    attributes = {key: plain(value) for key, value in variable._attributes.items()}
    count, size = int(variable.shape[0]), path.stat().st_size
    expect_plausible(path, name, samples=count, sample_bytes=1, stored_bytes=size, is_packed=False)
    axis = str(variable.dimensions[0])
    dtype = np.dtype(variable.data.dtype)
    rule = CountRule.of(variable._attributes, dtype, unwritten=never_written(dtype))
    return Vector(
        name=name,
        count=count,
        source=_source(name, variable, opened, rule),
        axis=axis if axis != name else "",
        attributes=attributes,
        scale=rule.scale,
        offset=rule.offset,
    )


def _source(name: str, variable: Any, opened: Opened, rule: CountRule) -> Source:
    def read_samples(start: int, stop: int) -> NDArray[Any]:
        opened.expect_open(name)
        return rule.values(np.array(variable.data[start:stop]))

    return read_samples
