"""The model that ``export`` writes: of a fingerprint, its own structure or one that has limits too."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import click

from shaftprint.cli._known_values import named_value
from shaftprint.cli._own_structure import OWN_FILE_HELP, TypedName
from shaftprint.cli._simulated_model import LIMITED_HELP, simulated_model
from shaftprint.cli._terminal import say
from shaftprint.cli.output import expect_free, expect_no_input, fingerprint_at, fingerprint_file
from shaftprint.escape import plain_name
from shaftprint.export import ExportedModel, validation_remark

fingerprint_argument = click.argument("fingerprint", type=click.Path(path_type=Path))
structure_option = click.option(
    "--structure",
    metavar="NAME",
    help=f"Model structure, the fingerprint's with its limits by default: {OWN_FILE_HELP}; {LIMITED_HELP}.",
)
linear_option = click.option(
    "--linear", is_flag=True, help="Model for small signals, although the fingerprint has the line with its limits."
)
set_option = click.option(
    "--set",
    "given",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    help="Value of a parameter instead of the fingerprint's; may be repeated.",
)
output_option = click.option(
    "-o", "--output", type=click.Path(path_type=Path), help="File to write; named after the vessel by default."
)
force_option = click.option("--force", is_flag=True, help="Replace an earlier file.")


def model_to_export(
    fingerprint: Path, structure: TypedName | None, given: Mapping[str, float], *, linear: bool = False
) -> ExportedModel:
    """Return the model of a fingerprint file, or of the folder with it; what speaks against it is said.

    Raises
    ------
    FingerprintError
        If there is none, it names no shipped structure, or it has a parameter that the structure lacks.
    StructureError
        If there is no such structure or parameter, or a value is missing.
    """
    identified = fingerprint_at(fingerprint)
    model = simulated_model(structure, identified, given, linear=linear)
    remark = validation_remark(identified, model.structure.name)
    if remark:
        say(remark)
    return ExportedModel(
        title=identified.conditions.vessel,
        structure=model.structure,
        values=model.values,
        engine_speed_rpm=identified.conditions.engine_speed.value,
        shaft_torque_nm=identified.conditions.shaft_torque.value,
        uncertain=model.uncertain,
        covariance=model.covariance,
        not_known=model.not_known,
        remark=remark,
    )


def file_to_write(
    output: Path | None, model: ExportedModel, suffix: str, *, inputs: Sequence[Path | None], force: bool
) -> Path:
    """Return the file to write: the given one, or one in this folder that is named after vessel and structure.

    Raises
    ------
    click.ClickException
        If it is a folder or an input, its folder does not exist, or it exists and is not to be replaced.
    """
    path = output or Path(plain_name(f"{model.title}-{model.structure.name}{suffix}"))
    expect_no_input(path, *(None if source is None else fingerprint_file(source) for source in inputs))
    expect_free(path, force=force)
    return path
