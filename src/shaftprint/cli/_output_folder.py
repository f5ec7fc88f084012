"""A folder of results that is written whole or not at all."""

import contextlib
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

import click

force_option = click.option(
    "--force", is_flag=True, help="Write into a folder even if it holds files of others; those stay."
)
"""The option of every command that writes a folder."""

MARKER = ".shaftprint"
"""File in a folder of results that lists the files which shaftprint wrote there."""


@contextlib.contextmanager
def output_folder(path: Path, *, force: bool) -> Iterator[Path]:
    """Give a temporary folder beside ``path``; move its files into ``path`` when the block ends without error.

    Files of an earlier run are replaced, or deleted where this run has none of the name; files of others
    are left alone. When the block raises, ``path`` stays as it was.

    Parameters
    ----------
    path
        Where the results belong.
    force
        Whether results may be put between files that are not from shaftprint.

    Raises
    ------
    click.ClickException
        If ``path`` is a file, or a folder with files that are not from shaftprint and ``force`` is false.
    """
    _expect_ours(path, force=force)
    path = path.resolve()
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    part.mkdir()
    try:
        yield part
        _move_in(part, path)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _expect_ours(path: Path, *, force: bool) -> None:
    if not path.resolve().name:
        raise click.ClickException(f"{path}: expected a folder below the root of the disk; add a name.")
    if path.exists() and not path.is_dir():
        raise click.ClickException(f"{path}: expected a folder for the results, found a file; choose another name.")
    if force or not path.is_dir() or (path / MARKER).is_file():
        return
    found = sorted(entry.name for entry in path.iterdir())
    if found:
        raise click.ClickException(
            f"{path}: expected an empty folder or one with results of shaftprint, found {found[0]}"
            f"{f' and {len(found) - 1} more' if len(found) > 1 else ''}; choose another folder, or use --force "
            "to put the results between them."
        )


def _move_in(part: Path, path: Path) -> None:
    written = sorted(file.relative_to(part) for file in part.rglob("*") if file.is_file())
    path.mkdir(exist_ok=True)
    for name in written:
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (part / name).replace(path / name)
    for old in _listed(path):
        if old not in written:
            (path / old).unlink(missing_ok=True)
    marker = "".join(f"{name.as_posix()}\n" for name in written)
    (path / MARKER).write_text(marker, encoding="utf-8")


def _listed(path: Path) -> list[Path]:
    """Return the files that an earlier run wrote; none that would lie outside of the folder."""
    marker = path / MARKER
    if not marker.is_file():
        return []
    names = [Path(line) for line in marker.read_text(encoding="utf-8").splitlines()]
    return [name for name in names if not name.is_absolute() and ".." not in name.parts]
