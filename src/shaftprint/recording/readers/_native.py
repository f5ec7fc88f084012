"""The native container: HDF5 laid out as NetCDF-4, counts in int16, each channel on its own clock."""

from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Channel, ClockJump, Times
from shaftprint.recording._container import (
    BEGAN,
    CHUNK_SAMPLES,
    EDGES,
    FORMAT,
    GROUP,
    JUMPS,
    JUMPS_S,
    OWN,
    TIMES,
    UNEVEN,
    VERSION_WITH_TIMES,
)
from shaftprint.recording._recording import Recording
from shaftprint.recording._seal import has_seal, hashed
from shaftprint.recording.readers._damage import told_as_damage
from shaftprint.recording.readers._hints import expect_hints
from shaftprint.recording.readers.hdf5_files._open import expect_storage, is_hdf5, open_hdf5

NAME = "shaftprint recording (NetCDF-4)"

# The mark stands in the first attribute of the file, which lies within the first 3 kB.
_MARK = FORMAT.encode("ascii")
_FIRST_BYTES = 16_384


def is_mine(path: Path) -> bool:
    """Return whether the file is HDF5 with the mark of the native container, whole or damaged."""
    return is_hdf5(path) and has_mark(path)


def has_mark(path: Path) -> bool:
    """Return whether a file has the native container's seal or name; HDF5's library might hang where it is damaged."""
    with path.open("rb") as file:
        return _MARK in file.read(_FIRST_BYTES) or has_seal(path)


def read(path: Path, **hints: object) -> Recording:
    """Open a native container; blocks are read and unpacked as channels are asked for them.

    Raises RecordingError if the file is damaged, of a later version, or lacks an attribute.
    """
    expect_hints(path, hints, {})
    content = hashed(path)
    with kept_open(open_hdf5(path, NAME, is_whole=content.is_sealed)) as file, told_as_damage(path, NAME):
        return _recording(path, file, content.sha256)


def _recording(path: Path, file: Any, sha256: str) -> Recording:
    if file.attrs.get("format") != FORMAT:
        raise RecordingError(f'{path}: expected the attribute format "{FORMAT}", found another; is the file damaged?')
    version = int(file.attrs.get("format_version", 0))
    if not 1 <= version <= VERSION_WITH_TIMES:
        raise RecordingError(
            f"{path}: expected version 1 to {VERSION_WITH_TIMES} of the {FORMAT} format, found {version}; use a later "
            "shaftprint."
        )
    if GROUP not in file:
        raise RecordingError(f'{path}: expected a group "{GROUP}", found none.')
    channels = {
        name: _channel(path, name, dataset, file[GROUP])
        for name, dataset in file[GROUP].items()
        if "sample_rate_hz" in dataset.attrs
    }
    return Recording(
        path=path,
        sha256=sha256,
        format=NAME,
        channels=channels,
        began=_began(path, file.attrs.get(BEGAN)),
        attributes=_facts(file.attrs),
        release=file.close,
    )


def _began(path: Path, stated: Any) -> datetime | None:
    try:
        return None if stated is None else datetime.fromisoformat(str(stated))
    except ValueError:
        raise RecordingError(f"{path}: expected a date in the attribute {BEGAN}, found {str(stated)[:40]!r}.") from None


def _facts(attributes: Any) -> dict[str, str | float]:
    """Return the texts and numbers other than the container's attributes; other tools may add lists."""
    facts = {name: attributes[name] for name in attributes if name not in OWN}
    texts = {name: value for name, value in facts.items() if isinstance(value, str)}
    numbers = {name: float(value) for name, value in facts.items() if isinstance(value, np.number | int | float)}
    return texts | numbers


def _channel(path: Path, name: str, dataset: Any, group: Any) -> Channel:
    attributes = dataset.attrs
    needed = ["units", "sample_rate_hz", "start_s"]
    if dataset.dtype.kind == "i":
        needed += ["scale_factor", "add_offset"]
    missing = [key for key in needed if key not in attributes]
    if missing:
        raise RecordingError(
            f"{path}, channel {name}: expected the attributes {', '.join(needed)}, "
            f"found none named {', '.join(missing)}."
        )

    if dataset.dtype.kind not in "fiu" or dataset.ndim != 1:
        raise RecordingError(
            f"{path}, channel {name}: expected a row of numbers, found {dataset.ndim} dimensions of {dataset.dtype}; "
            "write it as numbers, or leave it out."
        )
    expect_storage(path, name, dataset)
    return Channel(
        name=name,
        unit=str(attributes["units"]),
        rate_hz=float(attributes["sample_rate_hz"]),
        start_s=float(attributes["start_s"]),
        count=int(dataset.size),
        scale=float(attributes.get("scale_factor", 1.0)),
        offset=float(attributes.get("add_offset", 0.0)),
        long_name=str(attributes.get("long_name", "")),
        source=_source(path, name, dataset),
        stamps=_times(path, name, dataset, group),
        is_uneven=bool(attributes.get(UNEVEN, 0)),
        clock_jumps=_jumps(attributes),
        is_of_edges=bool(attributes.get(EDGES, 0)),
    )


def _jumps(attributes: Any) -> tuple[ClockJump, ...]:
    samples, jumps_s = np.ravel(attributes.get(JUMPS, ())), np.ravel(attributes.get(JUMPS_S, ()))
    return tuple(
        ClockJump(sample=int(sample), jump_s=float(jump_s))
        for sample, jump_s in zip(samples.tolist(), jumps_s.tolist(), strict=True)
    )


def _source(path: Path, name: str, dataset: Any) -> Callable[[int, int], NDArray[Any]]:
    def source(start: int, stop: int) -> NDArray[Any]:
        if not dataset:
            raise RecordingError(f"{path}, channel {name}: the recording has been closed already.")
        try:
            counts: NDArray[Any] = dataset[start:stop]
        except (OSError, RuntimeError) as error:
            raise RecordingError(f"{path}, channel {name}: samples [{start}, {stop}) are damaged ({error}).") from None
        return counts

    return source


def _times(path: Path, name: str, dataset: Any, group: Any) -> Times | None:
    """Return what gives the times of a channel that has its own; they never go back.

    Raises RecordingError if they are missing, or not one for each sample.
    """
    stated = dataset.attrs.get(TIMES)
    if stated is None:
        return None
    times = group.get(str(stated))
    if times is None or getattr(times, "shape", None) != dataset.shape or times.dtype.kind != "f":
        found = "none" if times is None else f"shape {getattr(times, 'shape', None)}"
        raise RecordingError(
            f"{path}, channel {name}: expected {dataset.size} times in {stated}, found {found}; is the file damaged?"
        )
    expect_storage(path, str(stated), times)
    source = _source(path, str(stated), times)
    for start in range(0, dataset.size, CHUNK_SAMPLES):
        if not np.all(np.diff(source(start, min(start + CHUNK_SAMPLES + 1, dataset.size))) >= 0.0):
            raise RecordingError(
                f"{path}, channel {name}: expected times that never go back, found others; is the file damaged?"
            )
    return source
