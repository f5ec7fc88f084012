"""Binaries of FMUs that were compiled before, kept for the next export of the same model.

They are run by whoever loads the FMU, so they are kept only where nobody but the user can have put them.
"""

import hashlib
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Final

from shaftprint.files import written_whole
from shaftprint.kernels._folder import private_folder

MOST_KEPT: Final = 200


def place_of_binary(command: Sequence[str], folder: Path) -> Path | None:
    """Return the file of what a command makes of the sources in a folder; None where nothing can be kept.

    ``command``: compiler and options, and what tells one version of the compiler from another. ``folder``: the sources.
    """
    cache = private_folder("fmu")
    if cache is None:
        return None
    parts = [*command]
    for path in sorted(folder.glob("*.[ch]")):
        parts += [path.name, path.read_text(encoding="utf-8")]
    return cache / hashlib.sha256("\0".join(parts).encode()).hexdigest()


def keep_binary(binary: Path, place: Path) -> None:
    """Keep a binary, and the newest others; that it cannot be kept is no fault."""
    with suppress(OSError):
        with written_whole(place, overwrite=True) as part:
            part.write_bytes(binary.read_bytes())
        oldest_last = sorted(place.parent.iterdir(), key=lambda path: path.stat().st_mtime, reverse=True)
        for path in oldest_last[MOST_KEPT:]:
            path.unlink(missing_ok=True)
