"""Files that are written whole or not at all."""

import contextlib
import errno
import os
import secrets
from collections.abc import Iterator
from pathlib import Path

# Names may have 255 bytes, a letter up to four: so many letters of the stem and of the ending.
_LONGEST = 24
_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


@contextlib.contextmanager
def written_whole(path: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary path next to ``path``; rename it to ``path`` when the block ends without error.

    When the block raises, the temporary file is deleted and ``path`` is left as it was. The content is on the disk
    before the name is.

    Parameters
    ----------
    path
        Where the finished file belongs; its folder must exist.
    overwrite
        Whether an existing file may be replaced.

    Raises
    ------
    FileExistsError
        If ``path`` exists, before or after the block, and ``overwrite`` is false.
    OSError
        If the file cannot be written; the error names ``path``.
    """
    # the ending stays: it tells what draws or writes it the format
    part = path.with_name(f".{path.stem[:_LONGEST]}.{secrets.token_hex(4)}.part{path.suffix[:_LONGEST]}")
    with naming(path, instead_of=part):
        _expect_free(path, overwrite=overwrite)
        try:
            yield part
            _expect_free(path, overwrite=overwrite)
            _sync(part)
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)


@contextlib.contextmanager
def naming(path: Path, *, instead_of: Path | None = None) -> Iterator[None]:
    """Let errors of the system name ``path``: those of a full disk, which name nothing, and of a temporary file."""
    try:
        yield
    except OSError as error:
        is_full = error.errno in _FULL and error.filename is None
        if is_full or (error.filename is not None and error.filename in _spellings(instead_of)):
            error.filename = str(path)
        raise


def reason(error: OSError) -> str:
    """Return why the system refused a file, in its words without its numbers: ``No such file or directory``."""
    return error.strerror or str(error)


def _spellings(path: Path | None) -> tuple[object, ...]:
    return () if path is None else (path, str(path), os.fsencode(path))


def _sync(path: Path) -> None:
    # Windows syncs only what is open for writing
    with path.open("r+b") as file:
        os.fsync(file.fileno())


def _expect_free(path: Path, *, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path} exists already; choose another name or delete it first.")
