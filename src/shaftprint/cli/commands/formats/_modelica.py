"""``shaftprint export modelica``: a model as Modelica text."""

from collections.abc import Mapping
from pathlib import Path

import click

from shaftprint.catalogue._own_structure import TypedName
from shaftprint.cli._terminal import answer, say
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
from shaftprint.export.modelica._write import write_modelica


@click.command("modelica")
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
    """Write a Modelica package with limits and exact delays.

    FINGERPRINT is the JSON file, or the folder in which identify or demo has put it. The package needs no
    library; its block Line has inputs and outputs in rpm and N m about the working point, and Step is an
    experiment with it.
    """
    model = model_to_export(fingerprint, structure, given, linear=linear)
    written = write_modelica(
        model, file_to_write(output, model, ".mo", inputs=(fingerprint,), force=force), overwrite=force
    )
    say(f"package {written.package}: block Line, experiment Step")
    for name in written.late_outputs:
        say(f"{name} comes later than its time stamp in the recording, which lies ahead of what can be known")
    answer(written.path)
