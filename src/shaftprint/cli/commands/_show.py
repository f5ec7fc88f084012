"""``shaftprint show``: a saved fingerprint on the terminal."""

from pathlib import Path

import click

from shaftprint.cli._drive_identify import print_drive
from shaftprint.cli._drive_options import drive_fingerprint_at, is_drive_place
from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.cli.output._fingerprint_file import fingerprint_at


@click.command("show")
@click.argument("fingerprint", type=click.Path(path_type=Path))
def command(fingerprint: Path) -> None:
    """Print a saved fingerprint.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it.
    """
    if is_drive_place(fingerprint):
        print_drive(drive_fingerprint_at(fingerprint))
        return
    print_fingerprint(fingerprint_at(fingerprint))
