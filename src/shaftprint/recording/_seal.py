"""The seal behind a native container: the SHA-256 of all bytes before it, so that a whole file is known as whole.

HDF5 pays no attention to bytes behind the end that its header names.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

_MARK = b"\nshaftprint recording, SHA-256 of what is before this line: "
_DIGITS = 64
_LENGTH = len(_MARK) + _DIGITS + 1
_BLOCK = 1 << 20


@dataclass(frozen=True, kw_only=True, slots=True)
class Hashed:
    """What one pass over a file tells."""

    sha256: str
    """SHA-256 of the whole file, hexadecimal."""
    is_sealed: bool
    """Whether the file ends in the seal of the bytes before it."""


def add_seal(path: Path) -> None:
    """Write the seal behind a finished file."""
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    with path.open("ab") as file:
        file.write(_MARK + digest.encode("ascii") + b"\n")


def has_seal(path: Path) -> bool:
    """Return whether a file ends in a seal, right or wrong."""
    return _last_bytes(path).startswith(_MARK)


def hashed(path: Path) -> Hashed:
    """Read a file once, without holding it in memory, and compare it with its seal."""
    sealed = max(path.stat().st_size - _LENGTH, 0)
    content = hashlib.sha256()
    with path.open("rb") as file:
        while sealed > 0 and (block := file.read(min(_BLOCK, sealed))):
            content.update(block)
            sealed -= len(block)
        end = file.read()
    digest = content.copy()
    digest.update(end)
    expected = _MARK + content.hexdigest().encode("ascii") + b"\n"
    return Hashed(sha256=digest.hexdigest(), is_sealed=end == expected)


def _last_bytes(path: Path) -> bytes:
    with path.open("rb") as file:
        file.seek(max(path.stat().st_size - _LENGTH, 0))
        return file.read(_LENGTH)
