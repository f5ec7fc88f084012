"""``shaftprint new``: a commented settings file to fill in."""

from pathlib import Path
from typing import Literal

import click

from shaftprint.cli._terminal import answer
from shaftprint.settings import write_template


@click.command("new")
@click.argument("kind", type=click.Choice(["vessel", "campaign"]))
@click.argument("file", type=click.Path(path_type=Path))
def command(kind: Literal["vessel", "campaign"], file: Path) -> None:
    """Write a commented vessel or campaign file to fill in.

    FILE must not exist yet. It can be loaded as it stands; every key carries its unit in its name.
    """
    write_template(kind, file)
    answer(f"{file}: a {kind} to fill in.")
