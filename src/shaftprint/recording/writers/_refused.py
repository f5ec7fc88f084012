"""What the system says where it refuses a file, in the words of all writers."""

import contextlib
from collections.abc import Iterator
from pathlib import Path

from shaftprint.errors import RecordingError
from shaftprint.files import reason


@contextlib.contextmanager
def told_as_refused(path: Path) -> Iterator[None]:
    """Turn what the system raises while a file is written into one sentence.

    Raises RecordingError if the block raises an error of the system.
    """
    try:
        yield
    except OSError as error:
        raise RecordingError(f"{path}: the file cannot be written: {reason(error)}") from None
