"""Opening HDF5 files without hanging on damaged ones."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
from numpy.typing import NDArray

from shaftprint.errors import RecordingError
from shaftprint.files import kept_open
from shaftprint.recording._channel import Source
from shaftprint.recording.readers._damage import comes_to_an_end, expect_plausible, told_as_damage
from shaftprint.recording.readers._opened import Opened
from shaftprint.recording.readers.hdf5_files import _probe
from shaftprint.recording.readers.hdf5_files._references import outside_of, stored_outside

CANNOT_BE_OPENED = "it cannot be opened: the file is damaged there, or holds a link to nothing."
"""Why what the library passes over, though its name is there, is left out."""
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
# A user may keep bytes of his own in front, 512 or a power of two times that.
_USER_BLOCKS, _MATLAB = (512, 1024, 2048, 4096), b"MATLAB "
_LARGEST_USER_BLOCK = _USER_BLOCKS[-1]
# Blocks are unpacked whole; ours and MATLAB's have up to a few MB.
_LARGEST_BLOCK = 1 << 28


def is_hdf5(path: Path) -> bool:
    """Return whether the file begins as HDF5, behind a block of the user's or not; MATLAB's is another format."""
    with path.open("rb") as file:
        begin = file.read(_LARGEST_USER_BLOCK + len(_SIGNATURE))
    at = next((at for at in (0, *_USER_BLOCKS) if begin[at : at + len(_SIGNATURE)] == _SIGNATURE), None)
    return at == 0 or (at is not None and not begin.startswith(_MATLAB))


def open_hdf5(path: Path, what: str, *, is_whole: bool = False) -> Any:
    """Open an HDF5 file, read only; one that may be damaged is first opened in a separate process.

    ``path``: the file. ``what``: the format, in words. ``is_whole``: whether its bytes are known to be those that were
    written. Raises RecordingError if HDF5's library refuses the file, hangs or crashes on it, or the file leads to
    others.
    """
    if not is_whole and not comes_to_an_end(_probe, path):
        raise RecordingError(
            f"{path}: expected a whole {what} file, found a damaged one in which HDF5's library does not come to an "
            "end; copy it again from the logger."
        )
    with told_as_damage(path, what):
        file = h5py.File(path, "r")
    with kept_open(file):
        _expect_nothing_outside(path, outside_of(file))
    return file


def _expect_nothing_outside(path: Path, reference: str) -> None:
    """Refuse a file that leads to others: these may be any of the user's, and the SHA-256 does not cover them."""
    if reference:
        raise RecordingError(
            f"{path}: expected one file that holds all its samples, found that {reference}. Other files are not "
            "opened, since the SHA-256 of the recording does not cover them; copy the data into one file (h5repack "
            "-l CONTI, for links h5copy -f ext)."
        )


def expect_storage(path: Path, name: str, dataset: Any) -> None:
    """Refuse a data set that promises more samples than are stored, or has blocks too large to unpack.

    Refused is one that has its samples in other files, too, as it may have been reached by a reference and no link.

    Raises RecordingError if it does.
    """
    outside = stored_outside(dataset.id)
    _expect_nothing_outside(path, f"{name} is {outside}" if outside else "")
    sample_bytes = dataset.dtype.itemsize
    # up to 64 kB may lie in the header, and count as stored in no block
    stored = int(dataset.id.get_storage_size()) + 64
    expect_plausible(path, name, samples=dataset.size, sample_bytes=sample_bytes, stored_bytes=stored)
    most = math.prod(-(-size // length) for size, length in zip(dataset.shape, dataset.chunks or (), strict=False))
    if dataset.chunks is not None and dataset.id.get_num_chunks() > most:
        raise RecordingError(
            f"{path}, channel {name}: expected at most {most} blocks of samples, found {dataset.id.get_num_chunks()}; "
            "the file is damaged, copy it again from the logger."
        )
    block = sample_bytes
    for length in dataset.chunks or ():
        block *= length
    if block > _LARGEST_BLOCK:
        raise RecordingError(
            f"{path}, channel {name}: expected blocks of at most {_LARGEST_BLOCK >> 20} MiB, found blocks of "
            f"{block >> 20} MiB; if the file is not damaged, write it with smaller ones (h5repack -l CHUNK=262144)."
        )


def samples_along(
    opened: Opened,
    name: str,
    dataset: Any,
    axes: int,
    along: int,
    values: Callable[[NDArray[Any]], NDArray[Any]],
    *,
    place: int = 0,
) -> Source:
    """Return the source of what lies along one axis of a data set, at one place of its others.

    ``opened``: its file. ``name``: the channel, for messages. ``axes``: how many there are. ``values``: makes values of
    what is stored.
    """

    def read_samples(start: int, stop: int) -> NDArray[Any]:
        opened.expect_open(name)
        try:
            stored = dataset[tuple(slice(start, stop) if axis == along else place for axis in range(axes))]
        except (OSError, RuntimeError) as error:
            raise RecordingError(
                f"{opened.path}, channel {name}: samples [{start}, {stop}) are damaged ({error})."
            ) from None
        return values(stored)

    return read_samples
