"""What a reader of one file format looks like: a file or folder with a name and two functions."""

from pathlib import Path
from typing import Protocol

from shaftprint.recording._recording import Recording


class Reader(Protocol):
    """A file format; a module with these three names is one."""

    @property
    def NAME(self) -> str:
        """What the format is called in messages."""
        ...

    def is_mine(self, path: Path) -> bool:
        """Return whether a file is of this format, from its first bytes or its ending."""
        ...

    def read(self, path: Path, **hints: object) -> Recording:
        """Open a file of this format, read only.

        ``path``: a file that exists and is not empty. ``hints``: what the file does not say; each reader names those
        that it knows. Raises RecordingError if the file cannot be read or does not say enough.
        """
        ...
