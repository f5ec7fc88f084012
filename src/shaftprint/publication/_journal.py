"""The journal of a folder whose new results are complete: which files move in, and which earlier ones go."""

import json
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath

from shaftprint.errors import PublicationError

LOCK = ".shaftprint.lock"
STAGING = ".shaftprint.new"
JOURNAL = ".shaftprint.journal"

CONTROL_NAMES = (LOCK, STAGING, JOURNAL)
"""What publication itself puts into a folder; results have other names."""

_FORMAT = "shaftprint journal 1"


@dataclass(frozen=True, kw_only=True, slots=True)
class Journal:
    """What remains to be done in a folder."""

    moves: tuple[PurePosixPath, ...]
    """Files that move from the hidden folder to the same names in the folder."""
    discards: tuple[PurePosixPath, ...]
    """Files of earlier results that are deleted then."""

    def text(self) -> str:
        """Return the journal as the text of its file."""
        names = {"moves": self.moves, "discards": self.discards}
        return json.dumps({"format": _FORMAT} | {key: [str(name) for name in names[key]] for key in names}, indent=1)


def read_journal(folder: Path) -> Journal:
    """Return the journal of a folder, which may have come from anywhere.

    Raises PublicationError if it is none, or names a file that may lie outside of the folder.
    """
    path = folder / JOURNAL
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, RecursionError):
        content = None
    if not isinstance(content, dict) or content.get("format") != _FORMAT:
        raise PublicationError(f"{path}: expected a {_FORMAT}, found something else; move it and try again.")
    lists = {key: content.get(key) for key in ("moves", "discards")}
    for key, names in lists.items():
        if not isinstance(names, list) or not all(isinstance(name, str) and is_inner(name) for name in names):
            raise PublicationError(
                f"{path}, {key}: expected a list of names below its folder, found others; move the journal away."
            )
    return Journal(**{key: tuple(PurePosixPath(name) for name in names or ()) for key, names in lists.items()})


def is_inner(name: str) -> bool:
    """Return whether a name with slashes stands for a file below a folder on this system, and is no control file."""
    path = PurePath(name)
    # Windows takes "x:y" for a stream of x
    elsewhere = bool(path.anchor) or ".." in path.parts or (sys.platform == "win32" and ":" in name)
    return bool(path.parts) and not elsewhere and path.parts[0] not in CONTROL_NAMES and "\0" not in name


def expect_inside(folder: Path, names: Iterable[PurePosixPath]) -> None:
    """Check that no link leads a name out of a folder.

    Raises PublicationError if one does.
    """
    root = folder.resolve()
    parents = {name.parent: name for name in names}
    for parent, name in parents.items():
        target = (folder / parent).resolve()
        if not target.is_relative_to(root):
            raise PublicationError(
                f"{folder / name}: expected a place inside of the folder, found a link to {target}; delete the link."
            )
