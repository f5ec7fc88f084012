"""Columns of a file without random access, unpacked once into a temporary file so that memory stays low.

The file has no name: when the process that unpacks ends in whatever way, the system takes it back.
"""

import tempfile
import threading
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.files import reason
from shaftprint.recording._channel import Source

MOST_TIMES: Final = 400
"""So many times the length of its file a recording may have when it is unpacked; text of noise has less than 40."""
_ALWAYS: Final = 16 * 2**20
_BYTES: Final = np.dtype(np.float64).itemsize


@dataclass(slots=True)
class _Column:
    """Where the pieces of a column lie."""

    name: str
    begins: list[int] = field(default_factory=list)
    """First row of each piece."""
    offsets: list[int] = field(default_factory=list)
    """Where each piece begins in the file."""
    count: int = 0
    """Rows in all."""


class Spool:
    """One temporary file of float64 values, the columns in pieces; ``close`` gives it back."""

    def __init__(self, path: Path, names: Sequence[str]) -> None:
        """Begin empty columns.

        ``path``: the file that is unpacked, for messages. ``names``: name of each column.
        """
        self._path = path
        self._most = max(_ALWAYS, MOST_TIMES * path.stat().st_size)
        self._file = tempfile.TemporaryFile(prefix="shaftprint-")  # noqa: SIM115 - closed by ``close``
        self._lock = threading.Lock()
        self._length = 0
        self._columns = [_Column(name) for name in names]

    def add_column(self, name: str) -> int:
        """Begin one more column and return its number."""
        self._columns.append(_Column(name))
        return len(self._columns) - 1

    def append(self, block: FloatArray) -> None:
        """Add rows, shape (rows, columns).

        Raises RecordingError if they are more than a file of that length has, or the disk does not take them.
        """
        for number, column in enumerate(block.T):
            self.append_column(number, column)

    def append_column(self, number: int, values: NDArray[Any]) -> None:
        """Add values to one column only, shape (values,); errors as of ``append``."""
        column, content = self._columns[number], np.ascontiguousarray(values, dtype=np.float64)
        if not content.size:
            return
        if self._length + content.nbytes > self._most:
            raise RecordingError(
                f"{self._path}: expected at most {MOST_TIMES} times its length when it is unpacked, found more; if it "
                "is a recording nevertheless, unpack it first."
            )
        try:
            self._file.write(content.data)
        except OSError as refusal:
            raise RecordingError(
                f"{self._path}: it cannot be unpacked into the folder of temporary files: {reason(refusal)}."
            ) from None
        column.begins.append(column.count)
        column.offsets.append(self._length)
        column.count += content.size
        self._length += content.nbytes

    def finish(self) -> None:
        """End writing."""
        try:
            self._file.flush()
        except OSError as refusal:
            raise RecordingError(
                f"{self._path}: it cannot be unpacked into the folder of temporary files: {reason(refusal)}."
            ) from None

    def source(self, number: int) -> Source:
        """Return what reads the rows [start, stop) of one column."""
        column = self._columns[number]

        def read(start: int, stop: int) -> FloatArray:
            values = np.empty(max(0, min(stop, column.count) - start))
            with self._lock:
                if self._file.closed:
                    raise RecordingError(f"{self._path}, channel {column.name}: the recording has been closed already.")
                self._fill(values, column, start)
            return values

        return read

    def _fill(self, values: FloatArray, column: _Column, start: int) -> None:
        done, piece = 0, bisect_right(column.begins, start) - 1
        while done < values.size:
            begin = column.begins[piece]
            end = column.begins[piece + 1] if piece + 1 < len(column.begins) else column.count
            count = min(end - start - done, values.size - done)
            self._file.seek(column.offsets[piece] + _BYTES * (start + done - begin))
            self._file.readinto(values[done : done + count].data)
            done, piece = done + count, piece + 1

    def close(self) -> None:
        """Give the temporary file back."""
        with self._lock:
            self._file.close()
