"""A folder of results that is written whole or not at all."""

import contextlib
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path

import click

force_option = click.option(
    "--force",
    is_flag=True,
    help="Write into a folder even if it holds other files; those stay, unless a result has the name of one.",
)
"""The option of every command that writes a folder."""

MARKER = ".shaftprint"
"""File in a folder of results that names the command which wrote them and lists its files."""
_NAMED = "# shaftprint "


@contextlib.contextmanager
def output_folder(path: Path, *, of: str, force: bool) -> Iterator[Path]:
    """Give a temporary folder beside ``path``; move its files into ``path`` when the block ends without error.

    Files of an earlier run of the same command are replaced, or deleted where this run has none of the name; files of
    others and of other commands, which may be what this one reads, are left alone. When the block raises, ``path``
    stays as it was.

    Parameters
    ----------
    path
        Where the results belong.
    of
        Name of the command.
    force
        Whether results may be put between files that are not of this command.

    Raises
    ------
    click.ClickException
        If ``path`` is a file, or a folder with files that are not of this command and ``force`` is false.
    """
    _expect_ours(path, of, force=force)
    path = path.resolve()
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    part.mkdir()
    try:
        yield part
        _move_in(part, path, of)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _expect_ours(path: Path, of: str, *, force: bool) -> None:
    if not path.resolve().name:
        raise click.ClickException(f"{path}: expected a folder below the root of the disk; add a name.")
    if path.exists() and not path.is_dir():
        raise click.ClickException(f"{path}: expected a folder for the results, found a file; choose another name.")
    if force or not path.is_dir():
        return
    other, _ = _earlier(path)
    if other == of:
        return
    names = sorted(entry.name for entry in path.iterdir() if entry.name != MARKER)
    if names:
        found = f"{names[0]}{f' and {len(names) - 1} more' if len(names) > 1 else ''}"
        raise click.ClickException(
            f"{path}: expected an empty folder or one with results of shaftprint {of}, found "
            f"{f'those of shaftprint {other}' if other else found}; choose another folder, or use --force to put the "
            "results between them."
        )


def _move_in(part: Path, path: Path, of: str) -> None:
    command, earlier = _earlier(path)
    written = sorted(file.relative_to(part) for file in part.rglob("*") if file.is_file())
    path.mkdir(exist_ok=True)
    for name in written:
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (part / name).replace(path / name)
    for old in earlier:
        if command == of and old not in written:
            (path / old).unlink(missing_ok=True)
    marker = "".join(f"{name.as_posix()}\n" for name in written)
    (path / MARKER).write_text(f"{_NAMED}{of}\n{marker}", encoding="utf-8")


def _earlier(path: Path) -> tuple[str | None, list[Path]]:
    """Return which command wrote the results in a folder, and its files; none that would lie outside of the folder."""
    marker = path / MARKER
    text = marker.read_text(encoding="utf-8", errors="replace") if marker.is_file() else ""
    first, *lines = text.splitlines() or [""]
    if not first.startswith(_NAMED):
        return None, []
    names = [Path(line) for line in lines]
    return first.removeprefix(_NAMED), [name for name in names if not name.is_absolute() and ".." not in name.parts]
