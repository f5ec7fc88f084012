"""A library's open file that says so once it has been closed."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from shaftprint.errors import RecordingError


class Opened:
    """Whether a file may still be read."""

    def __init__(self, path: Path, close: Callable[[], object]) -> None:
        """Take over an open file.

        ``path``: the file, for messages. ``close``: what releases it.
        """
        self.path = path
        """File of the recording, for messages."""
        self._close = close
        self._is_open = True
        self._turn = threading.Lock()

    @contextmanager
    def reading(self, name: str) -> Iterator[None]:
        """Let one thread at a time read: signals are prepared in several, and a file has one place to read from.

        Raises RecordingError if the file has been closed.
        """
        with self._turn:
            self.expect_open(name)
            yield

    def expect_open(self, name: str) -> None:
        """Refuse to read a channel of a file that has been closed.

        Raises RecordingError if it has been.
        """
        if not self._is_open:
            raise RecordingError(f"{self.path}, channel {name}: the recording has been closed already.")

    def close(self) -> None:
        """Release the file, once."""
        if self._is_open:
            self._is_open = False
            self._close()
