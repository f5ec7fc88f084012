"""Files that are written whole or not at all, names for them, and text out of those that may be damaged."""

import contextlib
import re
import secrets
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def written_whole(path: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Give a temporary path beside ``path``; rename it to ``path`` when the block ends without error.

    When the block raises, the temporary file is deleted and ``path`` is left as it was.

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
    """
    _expect_free(path, overwrite=overwrite)
    part = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    try:
        yield part
        _expect_free(path, overwrite=overwrite)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def plain_name(text: str) -> str:
    """Return a text as the stem of a file name: what some system forbids there becomes a hyphen."""
    return re.sub(r'[\\/:*?"<>|\s]+', "-", text)


def printable(text: str) -> str:
    """Return text with a question mark for every character that ends lines, moves the cursor or is not to be seen."""
    return "".join(letter if letter.isprintable() else "?" for letter in text)


def _expect_free(path: Path, *, overwrite: bool) -> None:
    if path.exists() and not overwrite:
        raise FileExistsError(f"{path} exists already; choose another name or delete it first.")
