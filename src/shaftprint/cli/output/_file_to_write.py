"""A file that a command is to write: in a folder that exists, not in the place of another, never that of its input."""

from pathlib import Path

import click


def expect_no_input(output: Path, *inputs: Path | None) -> None:
    """Check that a file to write is none of those that are read: no ``--force`` means the loss of an input.

    Raises click.ClickException if it is one of them, by whatever name.
    """
    for source in inputs:
        if source is not None and output.exists() and source.exists() and output.samefile(source):
            raise click.ClickException(
                f"{output}: expected another file than the input {source}, which is not to be replaced; choose another "
                "name."
            )


def expect_ending(output: Path, ending: str) -> None:
    """Check that the name of a file to write has its ending, without which no command knows it again.

    ``ending``: with its dot. Raises click.ClickException if it has another.
    """
    if output.suffix.lower() != ending:
        raise click.ClickException(
            f"{output}: expected a file with the ending {ending}, found "
            f"{f'{output.suffix!r}' if output.suffix else 'none'}; take {output.with_name(output.stem + ending)}."
        )


def expect_free(output: Path, *, force: bool) -> None:
    """Check that a file can be written where it belongs.

    Raises click.ClickException if it is a folder, its folder does not exist, or it exists and is not to be replaced.
    """
    if output.is_dir():
        raise click.ClickException(f"{output}: expected a file to write, found a folder; add a file name.")
    if not output.resolve().parent.is_dir():
        raise click.ClickException(f"{output}: expected an existing folder, found none; make it first.")
    if output.exists() and not force:
        raise click.ClickException(f"{output} exists already; choose another name or replace it with --force.")
