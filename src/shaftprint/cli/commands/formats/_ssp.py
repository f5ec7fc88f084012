"""``shaftprint export ssp``: the parameters of a model for System Structure and Parameterization."""

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
    output_option,
    set_option,
    structure_option,
)
from shaftprint.export._ssp import write_ssv


@click.command("ssp")
@fingerprint_argument
@structure_option
@linear_option
@set_option
@output_option
@force_option
def command(
    fingerprint: Path,
    structure: TypedName | None,
    linear: bool,
    given: Mapping[str, float],
    output: Path | None,
    force: bool,
) -> None:
    """Write the parameters as an SSP parameter set (.ssv).

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The names are those of
    the FMU's parameters, so that the set can be given to it in a system structure.
    """
    model = model_to_export(fingerprint, structure, given, linear=linear)
    answer(write_ssv(model, file_to_write(output, model, ".ssv", inputs=(fingerprint,), force=force), overwrite=force))
