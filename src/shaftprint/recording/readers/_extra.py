"""Libraries that only some formats need."""

import importlib
import importlib.util
from pathlib import Path
from typing import Any

from shaftprint.errors import RecordingError
from shaftprint.recording.readers._library_output import quiet, take_over_logging


def library(path: Path, package: str, what: str) -> Any:
    """Import the library that knows a format.

    ``path``: the file that needs it. ``package``: name of its module. ``what``: the format, in words. Raises
    RecordingError if it is not installed, or does not run on this computer.
    """
    try:
        with quiet():
            module = importlib.import_module(package)
    except ImportError:
        raise _absent(path, package, what) from None
    except (OSError, NotImplementedError) as error:
        raise RecordingError(f"{path}: {package}, which reads {what} files, does not run here ({error}).") from None
    take_over_logging(package.partition(".")[0])
    return module


def expect_library(path: Path, package: str, what: str) -> None:
    """Refuse a file whose library is not installed, without loading it.

    Raises RecordingError if it is not.
    """
    if importlib.util.find_spec(package) is None:
        raise _absent(path, package, what)


def _absent(path: Path, package: str, what: str) -> RecordingError:
    return RecordingError(
        f'{path}: {what} files are read with {package}, which is not installed; pip install "shaftprint[readers]".'
    )
