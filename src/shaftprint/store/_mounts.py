"""Whether a file lies on another computer's disk, where SQLite's locks and its log do not hold."""

import re
import sys
from pathlib import Path
from typing import Final

NETWORK: Final = frozenset(
    {
        "nfs",
        "nfs4",
        "cifs",
        "smb",
        "smb2",
        "smb3",
        "smbfs",
        "ncpfs",
        "afs",
        "fuse.sshfs",
        "fuse.rclone",
        "fuse.smbnetfs",
    }
)
"""Types of file systems that lie on another computer, as Linux names them."""
_MOUNTS = Path("/proc/self/mountinfo")
_OCTAL = re.compile(r"\\([0-7]{3})")


def network_file_system(path: Path, *, mounts: str | None = None) -> str | None:
    """Return what kind of network file system a path lies on; None for a disk of this computer.

    ``path``: a file, which need not be there. ``mounts``: table of mounts as Linux gives it in
    ``/proc/self/mountinfo``; None for that of this computer, where it has one.
    """
    for text in (str(path), str(path.resolve())):
        if re.match(r"[\\/]{2}(?![?.][\\/])[^\\/]", text) or re.match(r"[\\/]{2}\?[\\/]UNC[\\/]", text, re.IGNORECASE):
            return "a UNC path"
    if mounts is None:
        mounts = _MOUNTS.read_text(encoding="utf-8", errors="surrogateescape") if sys.platform == "linux" else ""
    kind = _type_at(path.resolve(), mounts)
    return kind if kind in NETWORK else None


def _type_at(path: Path, mounts: str) -> str:
    """Return the type of the file system at the longest mount point above a path; a later one covers an earlier."""
    longest, found = -1, ""
    for line in mounts.splitlines():
        # ID, parent, device, root, mount point, options, other fields, a hyphen, type, source, options
        left, hyphen, right = line.partition(" - ")
        fields = left.split(" ")
        if not hyphen or len(fields) <= 4:
            continue
        point = Path(_OCTAL.sub(lambda code: chr(int(code[1], 8)), fields[4]))
        if path.is_relative_to(point) and len(point.parts) >= longest:
            longest, found = len(point.parts), right.split(" ", 1)[0]
    return found
