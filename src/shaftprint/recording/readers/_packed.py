"""Files as they are, or packed with gzip."""

import gzip
import zlib
from pathlib import Path
from typing import BinaryIO, cast

from shaftprint.errors import RecordingError

_GZIP = b"\x1f\x8b"
FIRST_BYTES = 4096
"""So many bytes tell of which format a text is."""
CANNOT_BE_UNPACKED = (EOFError, zlib.error, gzip.BadGzipFile)
"""What reading a damaged file raises."""


def open_unpacked(path: Path) -> BinaryIO:
    """Open a file to be read, as what is in it where it is packed."""
    file = path.open("rb")
    if file.peek(len(_GZIP))[: len(_GZIP)] != _GZIP:
        return file
    file.close()
    return cast("BinaryIO", gzip.open(path, "rb"))


def damaged_gzip(path: Path, error: Exception) -> RecordingError:
    """Return the error of a file that cannot be unpacked."""
    return RecordingError(f"{path}: expected a whole gzip file, found a damaged or truncated one ({error}).")


def first_bytes(path: Path, count: int = FIRST_BYTES) -> bytes | None:
    """Return the first bytes, unpacked; None where they are too damaged for it."""
    try:
        with open_unpacked(path) as file:
            return file.read(count)
    except CANNOT_BE_UNPACKED:
        return None
