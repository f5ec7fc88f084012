"""Columns of a file without random access, unpacked once into temporary files so that memory stays low."""

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from shaftprint.arrays import FloatArray
from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Source


class Spool:
    """One temporary file of float64 values a column; ``close`` deletes them."""

    def __init__(self, path: Path, names: Sequence[str]) -> None:
        """Begin empty columns.

        Parameters
        ----------
        path
            The file that is unpacked, for messages.
        names
            Name of each column.
        """
        self._path = path
        self._folder = tempfile.TemporaryDirectory(prefix="shaftprint-", ignore_cleanup_errors=True)
        self._columns = [Path(self._folder.name) / str(number) for number in range(len(names))]
        self._names = list(names)
        self._files = [column.open("wb") for column in self._columns]

    def add_column(self, name: str) -> int:
        """Begin one more column and return its number."""
        number = len(self._columns)
        self._columns.append(Path(self._folder.name) / str(number))
        self._names.append(name)
        self._files.append(self._columns[number].open("wb"))
        return number

    def append(self, block: FloatArray) -> None:
        """Add rows, shape (rows, columns)."""
        for file, column in zip(self._files, block.T, strict=True):
            np.ascontiguousarray(column).tofile(file)

    def append_column(self, number: int, values: NDArray[Any]) -> None:
        """Add values to one column only, shape (values,)."""
        np.ascontiguousarray(values, dtype=np.float64).tofile(self._files[number])

    def finish(self) -> None:
        """End writing."""
        for file in self._files:
            file.close()

    def source(self, number: int) -> Source:
        """Return what reads the rows [start, stop) of one column."""
        column, name = self._columns[number], self._names[number]

        def read(start: int, stop: int) -> FloatArray:
            try:
                return np.fromfile(column, dtype=np.float64, count=stop - start, offset=8 * start)
            except FileNotFoundError:
                raise RecordingError(f"{self._path}, channel {name}: the recording has been closed already.") from None

        return read

    def close(self) -> None:
        """Delete the temporary files."""
        self.finish()
        self._folder.cleanup()
