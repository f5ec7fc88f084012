"""``shaftprint show``: a saved fingerprint on the terminal."""

from pathlib import Path

import click

from shaftprint.cli._drive_identify import print_drive
from shaftprint.cli._fingerprint_tables import print_fingerprint
from shaftprint.cli.output._fingerprint_file import any_fingerprint_at, fingerprint_file
from shaftprint.late import late

with late():
    from shaftprint.fingerprint._json_file import of_a_drive, of_a_ship


@click.command("show")
@click.argument("fingerprint", type=click.Path(path_type=Path))
def command(fingerprint: Path) -> None:
    """Print a saved fingerprint.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it.
    """
    kept = any_fingerprint_at(fingerprint)
    named = str(fingerprint_file(fingerprint))
    if kept.noun == "drive":
        print_drive(of_a_drive(kept, named=named))
    else:
        print_fingerprint(of_a_ship(kept, named=named))
