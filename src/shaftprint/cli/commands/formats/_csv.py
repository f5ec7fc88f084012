"""``shaftprint export csv``: a fingerprint as tables."""

from pathlib import Path

import click

from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._options import OWN_FILE_HELP
from shaftprint.cli._terminal import answer
from shaftprint.cli.commands.formats._exported import file_to_write, fingerprint_argument, force_option
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.export._csv import write_csv
from shaftprint.export._model import exported_model
from shaftprint.fingerprint._model import structure_to_use


@click.command("csv")
@fingerprint_argument
@click.option(
    "--structure", metavar="NAME", help=f"Structure that was identified, if it is not shipped: {OWN_FILE_HELP}."
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Beginning of the names, as in tug.csv; named after the vessel by default.",
)
@force_option
def command(fingerprint: Path, structure: TypedName | None, output: Path | None, force: bool) -> None:
    """Write tables of parameters, combinations and the frequency response with its band.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. Columns are set apart
    by commas, numbers have points, and an empty cell is not known.
    """
    identified = fingerprint_at(fingerprint)
    chosen = structure_to_use(structure, identified)
    path = file_to_write(output, exported_model(identified, of=chosen), ".csv", inputs=(fingerprint,), force=force)
    written = write_csv(identified, path, of=chosen, overwrite=force)
    for table in (written.parameters, written.combinations, written.response):
        answer(table)
