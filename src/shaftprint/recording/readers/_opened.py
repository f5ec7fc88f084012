"""A library's open file that says so once it has been closed."""

from collections.abc import Callable
from pathlib import Path

from shaftprint.errors import RecordingError


class Opened:
    """Whether a file may still be read."""

    def __init__(self, path: Path, close: Callable[[], object]) -> None:
        """Take over an open file.

        Parameters
        ----------
        path
            The file, for messages.
        close
            What releases it.
        """
        self._path = path
        self._close = close
        self._is_open = True

    def expect_open(self, name: str) -> None:
        """Refuse to read a channel of a file that has been closed.

        Raises
        ------
        RecordingError
            If it has been.
        """
        if not self._is_open:
            raise RecordingError(f"{self._path}, channel {name}: the recording has been closed already.")

    def close(self) -> None:
        """Release the file, once."""
        if self._is_open:
            self._is_open = False
            self._close()
