"""``shaftprint export json``: a fingerprint's model as JSON."""

from pathlib import Path

import click

from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._options import OWN_FILE_HELP
from shaftprint.cli._terminal import answer
from shaftprint.cli.commands.formats._exported import file_to_write, fingerprint_argument, force_option, output_option
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.export._json import write_json
from shaftprint.export._model import exported_model
from shaftprint.fingerprint._model import structure_to_use


@click.command("json")
@fingerprint_argument
@click.option(
    "--structure", metavar="NAME", help=f"Structure that was identified, if it is not shipped: {OWN_FILE_HELP}."
)
@output_option
@force_option
def command(fingerprint: Path, structure: TypedName | None, output: Path | None, force: bool) -> None:
    """Write parameters, state space and frequency response as one JSON file.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The file is for
    programs that know nothing of shaftprint; what is not known is null.
    """
    identified = fingerprint_at(fingerprint)
    chosen = structure_to_use(structure, identified)
    model = exported_model(identified, of=chosen)
    path = file_to_write(output, model, ".model.json", inputs=(fingerprint,), force=force)
    answer(write_json(identified, path, of=chosen, overwrite=force))
