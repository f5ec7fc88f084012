"""A folder of results that is written whole or not at all."""

import contextlib
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath

import click

from shaftprint.cli._terminal import echo
from shaftprint.publication._journal import CONTROL_NAMES, is_inner
from shaftprint.publication._publish import publish, staged

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
    """Give a hidden folder in ``path``; when the block ends without error, its files appear in ``path`` as a whole.

    Files of an earlier run of the same command are replaced, or deleted where this run has none of the name; files of
    others and of other commands, which may be what this one reads, are left alone. When the block raises, ``path``
    stays as it was.

    ``path``: where the results belong. ``of``: name of the command. ``force``: whether results may be put between files
    that are not of this command. Raises click.ClickException if ``path`` is a file, or a folder with files that are not
    of this command and ``force`` is false; PublicationError if another command writes there, or the results cannot be
    put in place.
    """
    if not path.resolve().name:
        raise click.ClickException(f"{path}: expected a folder below the root of the disk; add a name.")
    if path.exists() and not path.is_dir():
        raise click.ClickException(f"{path}: expected a folder for the results, found a file; choose another name.")
    with staged(path) as staging:
        _expect_ours(path, of, force=force)
        yield staging
        _mark(staging, of)
        command, earlier = _earlier(path)
        made = _made(path) if command == of else ""
        publish(staging, discards=earlier if command == of else ())
    if made:
        echo(f"{path}: replaced the results of {made}.", err=True)


def _made(path: Path) -> str:
    """Return when the results in a folder were made, by the clock of this computer."""
    return datetime.fromtimestamp((path / MARKER).stat().st_mtime, UTC).astimezone().strftime("%Y-%m-%d %H:%M")


def _expect_ours(path: Path, of: str, *, force: bool) -> None:
    other, _ = _earlier(path)
    if force or other == of:
        return
    names = sorted(entry.name for entry in path.iterdir() if entry.name not in (MARKER, *CONTROL_NAMES))
    if names:
        content = f"{names[0]}{f' and {len(names) - 1} more' if len(names) > 1 else ''}"
        raise click.ClickException(
            f"{path}: expected an empty folder or one with results of shaftprint {of}, found "
            f"{f'those of shaftprint {other}' if other else content}; choose another folder, or use --force to put the "
            "results between them."
        )


def _mark(staging: Path, of: str) -> None:
    """Write the list of the results and the name of their command, which appears with them."""
    written = sorted(file.relative_to(staging).as_posix() for file in staging.rglob("*") if file.is_file())
    names = "".join(f"{name}\n" for name in written)
    (staging / MARKER).write_text(f"{_NAMED}{of}\n{names}", encoding="utf-8")


def _earlier(path: Path) -> tuple[str | None, list[PurePosixPath]]:
    """Return which command wrote the results in a folder, and its files; none that would lie outside of the folder."""
    marker = path / MARKER
    text = marker.read_text(encoding="utf-8", errors="replace") if marker.is_file() else ""
    first, *lines = text.splitlines() or [""]
    if not first.startswith(_NAMED):
        return None, []
    return first.removeprefix(_NAMED), [PurePosixPath(line) for line in lines if is_inner(line)]
