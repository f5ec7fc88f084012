"""The folder of compiled kernels: where it lies, and whether nobody but the user can have written into it."""

import importlib
import os
import stat
import sys
from pathlib import Path

# who may write into a folder besides its owner
_OTHERS = stat.S_IWGRP | stat.S_IWOTH


def cache_folder() -> Path:
    """Return the folder of what is kept: ``SHAFTPRINT_CACHE`` where it is set, else the system's cache folder.

    Raises RuntimeError if the user has no home.
    """
    chosen = os.environ.get("SHAFTPRINT_CACHE")
    if chosen:
        return Path(chosen)
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "shaftprint"


def private_folder(name: str = "kernels") -> Path | None:
    """Return the folder in which code may be kept; None where there is none that only the user can write.

    The folder is made where it is missing, for the user alone. It and all folders around it must belong to the user or
    to the system, and be closed to others for writing; a folder such as ``/tmp``, where nobody can take away what is
    another's, may be around it. On Windows it must lie in the user's profile, which is closed to others.

    ``name``: its name: what is kept in it.
    """
    try:
        wanted = cache_folder() / name
        wanted.parent.parent.mkdir(parents=True, exist_ok=True)
        for folder in (wanted.parent, wanted):
            folder.mkdir(mode=0o700, exist_ok=True)
        # from here on no link is followed any more, so that nobody can make it lead elsewhere
        folder = wanted.resolve()
        is_private = _is_in_profile(folder) if sys.platform == "win32" else _is_private(wanted, folder)
        return folder if is_private and os.access(folder, os.W_OK | os.X_OK) else None
    except (OSError, RuntimeError, ValueError):
        return None


def _is_private(wanted: Path, folder: Path) -> bool:
    """Return whether nobody but the user and the system can change what a folder holds, or put another in its place."""
    status = folder.stat()
    if wanted.lstat().st_uid != os.geteuid() or status.st_uid != os.geteuid() or status.st_mode & _OTHERS:
        return False
    return all(_is_trusted(parent) for parent in folder.parents)


def _is_trusted(folder: Path) -> bool:
    """Return whether only the user and the system can change what lies in a folder around it."""
    status = folder.stat()
    if status.st_uid not in (0, os.geteuid()):
        return False
    if not status.st_mode & _OTHERS or status.st_mode & stat.S_ISVTX:
        return True
    return not status.st_mode & stat.S_IWOTH and _is_group_of_one(status.st_gid)


def _is_group_of_one(group: int) -> bool:
    """Return whether a group is the user's own, as many systems give one to each user, with its name."""
    names = importlib.import_module("pwd"), importlib.import_module("grp")
    try:
        entry = names[1].getgrgid(group)
        user: str = names[0].getpwuid(os.geteuid()).pw_name
    except KeyError:
        return False
    return bool(entry.gr_name == user) and set(entry.gr_mem) <= {user}


def _is_in_profile(folder: Path) -> bool:
    return folder.resolve().is_relative_to(Path.home().resolve())
