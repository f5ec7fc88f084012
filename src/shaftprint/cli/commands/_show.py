"""``shaftprint show``: a saved fingerprint on the terminal."""

from pathlib import Path

import click

from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.cli.output import fingerprint_at


@click.command("show")
@click.argument("fingerprint", type=click.Path(path_type=Path))
def command(fingerprint: Path) -> None:
    """Print a saved fingerprint.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it.
    """
    print_fingerprint(fingerprint_at(fingerprint))
