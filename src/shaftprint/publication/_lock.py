"""A lock on a folder that the system takes away from a process that dies."""

import contextlib
import errno
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from shaftprint.errors import PublicationError
from shaftprint.publication._journal import LOCK

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

# Another command that only completes earlier results is done by then.
PATIENCE_S = 2.0
_PAUSE_S = 0.05
_HELD = (errno.EWOULDBLOCK, errno.EACCES, errno.EDEADLK)


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a folder; its file is deleted at the end.

    Raises PublicationError if another process holds it, or the disk knows no locks.
    """
    descriptor = _held(folder)
    try:
        yield
    finally:
        _release(descriptor, folder / LOCK)


def _held(folder: Path) -> int:
    deadline = time.monotonic() + PATIENCE_S
    while (descriptor := _tried(folder)) is None:
        if time.monotonic() > deadline:
            raise PublicationError(
                f"{folder}: expected no other command that writes its results there, found one at work; wait for it "
                "to end, or choose another folder."
            )
        time.sleep(_PAUSE_S)
    return descriptor


def _tried(folder: Path) -> int | None:
    """Return the descriptor of the lock file, or None where somebody else holds the lock or just gave it back."""
    descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        _take(descriptor)
        # The one before deletes the file, but on Windows not an open one: a lock on a deleted file keeps nobody out.
        if _is_at(descriptor, folder / LOCK):
            return descriptor
    except OSError as error:
        if error.errno not in _HELD:
            os.close(descriptor)
            raise PublicationError(
                f"{folder}: expected a disk that can lock files, found none ({error.strerror}); choose a folder on a "
                "disk of this computer."
            ) from None
    except BaseException:
        os.close(descriptor)
        raise
    os.close(descriptor)
    return None


def _take(descriptor: int) -> None:
    if sys.platform == "win32":
        msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    else:
        # unlike lockf this one is not lost when the process opens and closes the file again
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _is_at(descriptor: int, path: Path) -> bool:
    if sys.platform == "win32":
        return True
    try:
        return os.path.samestat(os.fstat(descriptor), path.stat())
    except FileNotFoundError:
        return False


def _release(descriptor: int, path: Path) -> None:
    if sys.platform == "win32":
        # Windows deletes no open file; if another command has opened it by now, that one deletes it.
        os.close(descriptor)
        with contextlib.suppress(OSError):
            path.unlink()
        return
    try:
        with contextlib.suppress(OSError):
            path.unlink()
    finally:
        os.close(descriptor)
