"""A file as the system describes it, with its SHA-256."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class HashedFile:
    """A file as the system describes it, with its SHA-256."""

    path: str
    """Its path."""
    size: int
    """Its length in bytes."""
    mtime_ns: str
    """When it was changed [ns]."""
    inode: str
    """Its number in its file system."""
    sha256: str
    """Its SHA-256, hexadecimal."""
