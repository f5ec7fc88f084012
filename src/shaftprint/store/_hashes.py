"""The SHA-256 of files, remembered: one that has not changed since is not read again."""

import hashlib
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Final

from shaftprint.arguments import refusing_none
from shaftprint.errors import RecordingError, StoreError
from shaftprint.files import reason
from shaftprint.store._hashed_file import HashedFile
from shaftprint.store._store import Store

# A file that was changed just before it was read may change once more and keep its time [s].
_SETTLED_S: Final = 2.0


@refusing_none(StoreError)
def file_hashes(store: Store, paths: Sequence[Path], *, now: datetime) -> tuple[str, ...]:
    """Return the SHA-256 of files; one of the same path, length, time and inode as before is not read again.

    ``store``: the store that remembers them. ``paths``: the files. ``now``: the present time, with its zone. Raises
    RecordingError if a file cannot be read.
    """
    with store.database.reading() as connection:
        known = {one.path: one for one in store.database.hashes(connection).of([str(path) for path in paths])}
    found = [_hashed(path, known.get(str(path))) for path in paths]
    new = {one.path: one for one in found if known.get(one.path) != one and _is_settled(one, now)}
    if new:
        with store.database.writing() as connection:
            store.database.hashes(connection).keep(list(new.values()))
    return tuple(one.sha256 for one in found)


def _is_settled(file: HashedFile, now: datetime) -> bool:
    return now.timestamp() - 1e-9 * int(file.mtime_ns) > _SETTLED_S


def _hashed(path: Path, known: HashedFile | None) -> HashedFile:
    try:
        state = path.stat()
        size, mtime_ns, inode = state.st_size, str(state.st_mtime_ns), str(state.st_ino)
        if known is not None and (known.size, known.mtime_ns, known.inode) == (size, mtime_ns, inode):
            return known
        with path.open("rb") as opened:
            sha256 = hashlib.file_digest(opened, "sha256").hexdigest()
    except OSError as refusal:
        raise RecordingError(f"{path}: expected a recording, but it cannot be read: {reason(refusal)}.") from None
    return HashedFile(path=str(path), size=size, mtime_ns=mtime_ns, inode=inode, sha256=sha256)
