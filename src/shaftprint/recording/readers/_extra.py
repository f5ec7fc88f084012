"""Libraries that only some formats need."""

import importlib
import importlib.util
import logging
from pathlib import Path
from typing import Any

from shaftprint.errors import RecordingError


def library(path: Path, package: str, what: str) -> Any:
    """Import the library that knows a format.

    Parameters
    ----------
    path
        The file that needs it.
    package
        Name of its module.
    what
        The format, in words.

    Raises
    ------
    RecordingError
        If it is not installed, or does not run on this computer.
    """
    try:
        module = importlib.import_module(package)
    except ImportError:
        raise _absent(path, package, what) from None
    except (OSError, NotImplementedError) as error:
        raise RecordingError(f"{path}: {package}, which reads {what} files, does not run here ({error}).") from None
    # what a library has to say about odd bytes goes into our own sentences
    for name in list(logging.root.manager.loggerDict):
        if name.partition(".")[0] == package:
            logging.getLogger(name).setLevel(logging.CRITICAL)
    return module


def expect_library(path: Path, package: str, what: str) -> None:
    """Refuse a file whose library is not installed, without loading it.

    Raises
    ------
    RecordingError
        If it is not.
    """
    if importlib.util.find_spec(package) is None:
        raise _absent(path, package, what)


def _absent(path: Path, package: str, what: str) -> RecordingError:
    return RecordingError(
        f'{path}: {what} files are read with {package}, which is not installed; pip install "shaftprint[readers]".'
    )
