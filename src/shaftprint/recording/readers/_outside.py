"""Readers from outside: plain functions that other installed packages offer under an entry point."""

from collections.abc import Callable, Sequence
from functools import cache
from importlib.metadata import entry_points
from pathlib import Path
from typing import TypeAlias

from shaftprint.errors import RecordingError
from shaftprint.recording._recording import Recording

ReaderFunction: TypeAlias = Callable[..., Recording | None]
"""Takes a path and hints; returns a recording, or None where the file is not of its format."""

GROUP = "shaftprint.readers"


def read_outside(path: Path, **hints: object) -> Recording | None:
    """Return the recording of the first outside reader that knows a file; None where none does.

    ``path``: the file. ``hints``: what the file does not say; passed on where there are any. Raises RecordingError if a
    reader cannot be loaded, or fails in another way than with this error.
    """
    for name, function in _functions():
        try:
            recording = function(path, **hints)
        except RecordingError:
            raise
        except Exception as error:
            raise RecordingError(f"{path}: the reader {name} of another package failed ({error!r}).") from error
        if recording is not None:
            return recording
    return None


@cache
def _functions() -> Sequence[tuple[str, ReaderFunction]]:
    functions = []
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        try:
            functions.append((point.name, point.load()))
        except Exception as error:
            raise RecordingError(
                f"the reader {point.name} ({point.value}) of another package cannot be loaded ({error!r}); mend or "
                "uninstall that package."
            ) from error
    return tuple(functions)
