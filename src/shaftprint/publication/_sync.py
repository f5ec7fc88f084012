"""Files and folders that outlive a loss of power."""

import errno
import os
import sys
from collections.abc import Iterable
from pathlib import Path

# Some network disks sync their folders themselves and refuse to be asked.
_NOT_NEEDED = (errno.EINVAL, errno.ENOTSUP)


def sync_files(paths: Iterable[Path]) -> None:
    """Wait until the content of files is on the disk."""
    for path in paths:
        # Windows syncs only what is open for writing
        with path.open("r+b") as file:
            os.fsync(file.fileno())


def sync_folders(paths: Iterable[Path]) -> None:
    """Wait until the names in folders are on the disk; Windows writes them with the files."""
    if sys.platform == "win32":
        return
    for path in paths:
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        except OSError as error:
            if error.errno not in _NOT_NEEDED:
                raise
        finally:
            os.close(descriptor)
