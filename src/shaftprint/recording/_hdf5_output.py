"""HDF5 files that are written through Python, so that a full disk is an error and not the end of the program.

HDF5's library cannot close a file whose last blocks cannot be written, keeps it, and crashes over it when the program
ends. Here it writes into an object that remembers the first failure and keeps in memory what comes after it: the
library closes its file in peace, and the failure is raised behind it.
"""

import contextlib
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any, BinaryIO

import h5py

from shaftprint.files import kept_open


class Hdf5Output:
    """An HDF5 file to write; what is done to ``file`` is done within ``calls``."""

    def __init__(self, path: Path, **options: Any) -> None:
        """Open the file.

        ``path``: the file, which is replaced. ``options``: further options of ``h5py.File``. Raises OSError if it
        cannot be opened.
        """
        self._raw = path.open("w+b", buffering=0)
        self._disk = _Disk(self._raw)
        with kept_open(self._raw), self.calls():
            self.file: Any = h5py.File(self._disk, "w", **options)

    @contextlib.contextmanager
    def calls(self) -> Iterator[None]:
        """Raise what failed while HDF5's library was called, after it has ended.

        Raises OSError if something could not be written.
        """
        with _uninterrupted():
            yield
        self._disk.expect_written()

    def close(self) -> None:
        """Close the file.

        Raises OSError if the last blocks cannot be written.
        """
        try:
            with self.calls():
                self.file.close()
        finally:
            self._raw.close()


class _Disk:
    """A file as HDF5's library wants it: all writes succeed; the first that did not is kept."""

    def __init__(self, raw: BinaryIO) -> None:
        self._raw = raw
        self._place = 0
        self._late: list[tuple[int, bytes]] = []
        self._failure: BaseException | None = None

    def expect_written(self) -> None:
        if self._failure is not None:
            raise self._failure

    def seek(self, offset: int, whence: int = 0) -> int:
        self._place = offset if whence == 0 else self._raw.seek(offset, whence)
        return self._place

    def tell(self) -> int:
        return self._place

    def read(self, size: int) -> bytes:
        block = bytearray(size)
        return bytes(block[: self.readinto(block)])

    def readinto(self, block: Any) -> int:
        """Fill a block from the file, and with what could not be written there."""
        view = memoryview(block).cast("B")
        self._raw.seek(self._place)
        count = self._raw.readinto(view) or 0  # type: ignore[attr-defined]
        for begin, late in self._late:
            first, last = max(begin, self._place), min(begin + len(late), self._place + len(view))
            if first < last:
                view[first - self._place : last - self._place] = late[first - begin : last - begin]
                count = max(count, last - self._place)
        self._place += count
        return int(count)

    def write(self, block: Any) -> int:
        view = memoryview(block).cast("B")
        if self._failure is None:
            try:
                self._write_all(view)
            except BaseException as failure:
                self._failure = failure
        if self._failure is not None:
            self._late.append((self._place, bytes(view)))
        self._place += len(view)
        return len(view)

    def truncate(self, size: int) -> int:
        if self._failure is None:
            try:
                self._raw.truncate(size)
            except OSError as failure:
                self._failure = failure
        return size

    def flush(self) -> None:
        """Do nothing: what is written is not held back."""

    def _write_all(self, view: memoryview) -> None:
        done = 0
        while done < len(view):
            self._raw.seek(self._place + done)
            done += self._raw.write(view[done:])


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Let an interrupt wait: one that came out of a write would leave the library with a file that it cannot close."""
    if threading.current_thread() is not threading.main_thread():
        # interrupts reach the main thread only
        yield
        return
    waiting: list[tuple[int, FrameType | None]] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: waiting.append((number, frame)))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
    if waiting and callable(before):
        before(*waiting[0])
