"""Putting a whole set of files into a folder, with one rename as the moment at which they count."""

import contextlib
import errno
import os
import shutil
import sys
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path, PurePosixPath

from shaftprint.errors import PublicationError
from shaftprint.files import naming
from shaftprint.publication._journal import CONTROL_NAMES, JOURNAL, STAGING, Journal, expect_inside, read_journal
from shaftprint.publication._lock import locked


@contextlib.contextmanager
def staged(folder: Path) -> Iterator[Path]:
    """Lock a folder and give an empty hidden one in it, whose files ``publish`` puts in place.

    What an earlier command left unfinished is completed first. The folder is made if it does not exist, and deleted
    again where nothing was put into it.

    Raises PublicationError if another command writes there, or what an earlier one left cannot be completed.
    """
    is_new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    try:
        with naming(folder), locked(folder):
            _complete_if_committed(folder)
            staging = _emptied(folder / STAGING)
            try:
                yield staging
            finally:
                if not (folder / JOURNAL).exists():
                    shutil.rmtree(staging, ignore_errors=True)
    finally:
        if is_new:
            with contextlib.suppress(OSError):
                folder.rmdir()


def publish(staging: Path, *, discards: Collection[PurePosixPath] = ()) -> None:
    """Put all files of the hidden folder that ``staged`` gave in place of earlier ones: all, or none of them.

    ``staging``: the hidden folder. ``discards``: files of earlier results, relative to the folder, that are deleted
    unless new ones have their names. Raises PublicationError if the place of a file is taken by a folder or a link that
    leads elsewhere: nothing has changed then. If files cannot be moved that another program has open: the new results
    count then, and the next command moves them.
    """
    folder = staging.parent
    names = _names(staging)
    journal = Journal(moves=names, discards=tuple(sorted(set(discards) - set(names))))
    _expect_free_places(folder, journal)
    sync_files(staging / name for name in names)
    sync_folders([staging, *(path for path in staging.rglob("*") if path.is_dir())])
    try:
        _commit(staging, journal)
        _complete(folder)
    except KeyboardInterrupt:
        # committed results are new: they are not to lie half-way until another command comes
        _complete_if_committed(folder)
        raise
    except OSError as error:
        if not (folder / JOURNAL).exists():
            raise
        raise _not_completed(folder, error) from None


def complete(folder: Path) -> None:
    """Move new results into a folder whose command ended after they were complete and before they were moved.

    Everything that reads results calls this first; where nothing is unfinished it looks for one file only.

    Raises PublicationError if they cannot be moved.
    """
    if not (folder / JOURNAL).exists():
        return
    try:
        with locked(folder):
            _complete_if_committed(folder)
    except OSError as error:
        raise _not_completed(folder, error) from None


def _emptied(staging: Path) -> Path:
    if staging.is_symlink():
        staging.unlink()
    elif staging.exists():
        shutil.rmtree(staging)
    staging.mkdir()
    return staging


def _names(staging: Path) -> tuple[PurePosixPath, ...]:
    files = (path.relative_to(staging) for path in staging.rglob("*") if not path.is_dir())
    return tuple(sorted(PurePosixPath(name.as_posix()) for name in files if name.parts[0] not in CONTROL_NAMES))


def _expect_free_places(folder: Path, journal: Journal) -> None:
    expect_inside(folder, (*journal.moves, *journal.discards))
    for name in journal.moves:
        if (folder / name).is_dir():
            raise PublicationError(
                f"{folder / name}: expected a file or nothing in the place of this result, found a folder; move it."
            )
        for parent in (folder / above for above in name.parents):
            if parent.exists() and not parent.is_dir():
                raise PublicationError(
                    f"{parent}: expected a folder or nothing in this place of results, found a file; move it."
                )


def _commit(staging: Path, journal: Journal) -> None:
    """Rename the journal into place: before, the earlier results count, afterwards the new."""
    written = staging / JOURNAL
    written.write_text(journal.text(), encoding="utf-8")
    sync_files([written])
    written.replace(staging.parent / JOURNAL)
    sync_folders([staging.parent])


def _complete_if_committed(folder: Path) -> None:
    if (folder / JOURNAL).exists():
        _complete(folder)


def _complete(folder: Path) -> None:
    """Do what the journal says and delete it; what was done before an interruption is not done again."""
    journal = read_journal(folder)
    staging = folder / STAGING
    _expect_all(folder, journal)
    for name in journal.moves:
        if (staging / name).exists():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (staging / name).replace(folder / name)
    for name in journal.discards:
        (folder / name).unlink(missing_ok=True)
    _delete_emptied(folder, journal)
    parents = {folder / name.parent for name in (*journal.moves, *journal.discards)}
    sync_folders(sorted(parent for parent in parents if parent.is_dir()))
    (folder / JOURNAL).unlink()
    sync_folders([folder])
    shutil.rmtree(staging, ignore_errors=True)


def _delete_emptied(folder: Path, journal: Journal) -> None:
    for parent in {folder / name.parent for name in journal.discards} - {folder}:
        # others may have put files there
        with contextlib.suppress(OSError):
            parent.rmdir()


def _expect_all(folder: Path, journal: Journal) -> None:
    """Check that every new file is still there, and that no link leads out of the folder."""
    inner = PurePosixPath(STAGING)
    expect_inside(folder, (*journal.moves, *journal.discards, *(inner / name for name in journal.moves)))
    for name in journal.moves:
        if not (folder / STAGING / name).exists() and not (folder / name).exists():
            raise PublicationError(
                f"{folder / STAGING / name}: expected this new result, which was complete, found none; make the "
                f"results once more after deleting {folder / JOURNAL}."
            )


def _not_completed(folder: Path, error: OSError) -> PublicationError:
    failed = error.filename2 or error.filename or folder
    return PublicationError(
        f"{failed}: the new results are complete in {folder / STAGING}, but this one cannot be put in its place "
        f"({error.strerror or error}); close what has it open or make the folder writable, then run "
        f"shaftprint show {folder}, which puts all in place."
    )


# Some network disks sync their folders themselves and refuse to be asked.
_NOT_NEEDED = (errno.EINVAL, errno.ENOTSUP)


def sync_files(paths: Iterable[Path]) -> None:
    """Wait until the content of files is on the disk."""
    for path in paths:
        # Windows syncs only what is open for writing
        with path.open("r+b") as file:
            os.fsync(file.fileno())


def sync_folders(paths: Iterable[Path]) -> None:
    """Wait until the names in folders are on the disk; Windows writes them with the files."""
    if sys.platform == "win32":
        return
    for path in paths:
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        except OSError as error:
            if error.errno not in _NOT_NEEDED:
                raise
        finally:
            os.close(descriptor)
