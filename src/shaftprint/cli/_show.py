"""``shaftprint show``: a saved fingerprint on the terminal."""

from pathlib import Path

import click

from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.fingerprint import read_fingerprint


@click.command("show")
@click.argument("fingerprint", type=click.Path(path_type=Path))
def command(fingerprint: Path) -> None:
    """Print a saved fingerprint.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it.
    """
    place = fingerprint / "fingerprint.json" if fingerprint.is_dir() else fingerprint
    print_fingerprint(read_fingerprint(place))
