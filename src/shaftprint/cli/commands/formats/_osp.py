"""``shaftprint export osp``: the variable groups of a model for Open Simulation Platform."""

from collections.abc import Mapping
from pathlib import Path

import click

from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._terminal import answer
from shaftprint.cli.commands.formats._exported import (
    file_to_write,
    fingerprint_argument,
    force_option,
    linear_option,
    model_to_export,
    set_option,
    structure_option,
)
from shaftprint.export._osp import write_osp


@click.command("osp")
@fingerprint_argument
@structure_option
@linear_option
@set_option
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="FMU that it belongs to, which need not exist yet; named after the vessel by default.",
)
@force_option
def command(
    fingerprint: Path,
    structure: TypedName | None,
    linear: bool,
    given: Mapping[str, float],
    output: Path | None,
    force: bool,
) -> None:
    """Describe the variable groups of the FMU to Open Simulation Platform.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The description is
    written beside the FMU that `shaftprint export fmu` writes, as name_OspModelDescription.xml.
    """
    model = model_to_export(fingerprint, structure, given, linear=linear)
    # the FMU may be there already: it stays as it is
    answer(write_osp(model, file_to_write(output, model, ".fmu", inputs=(fingerprint,), force=True), overwrite=force))
