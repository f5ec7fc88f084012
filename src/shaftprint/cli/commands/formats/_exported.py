"""The model that ``export`` writes: of a fingerprint, its own structure or one that has limits too."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from shaftprint.cli._known_values import by_name, named_value
from shaftprint.cli._options import LIMITED_HELP, OWN_FILE_HELP
from shaftprint.cli._terminal import say
from shaftprint.cli.output._file_to_write import expect_free, expect_no_input
from shaftprint.cli.output._fingerprint_file import any_fingerprint_at, fingerprint_file
from shaftprint.errors import StructureError
from shaftprint.escape import plain_name
from shaftprint.late import late
from shaftprint.spelling import meant

with late():
    import numpy as np

    from shaftprint.arrays import frozen_float
    from shaftprint.bench._fingerprint import identified_drive
    from shaftprint.bench._kept import kept_drive
    from shaftprint.catalogue._own_structure import TypedName, chosen_structures
    from shaftprint.drive._drive import load_drive
    from shaftprint.export._model import ExportedModel, source_words, validation_remark
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.fingerprint._json_file import of_a_drive, of_a_ship
    from shaftprint.forecast._simulated_model import simulated_model


fingerprint_argument = click.argument("fingerprint", type=click.Path(path_type=Path))
DRIVE = "shaftprint.drive"
"""Where the context keeps the drive file."""


def _keep_drive(context: click.Context, parameter: click.Parameter, value: Path | None) -> None:
    context.meta[DRIVE] = value


def structure_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--structure``, and ``--drive``, which ``model_to_export`` takes from the context."""
    drive = click.option(
        "--drive",
        type=click.Path(path_type=Path),
        expose_value=False,
        callback=_keep_drive,
        help="Drive file of a fingerprint of a drive, where its structure is composed in the file.",
    )
    structure = click.option(
        "--structure",
        metavar="NAME",
        help=f"Model structure, the fingerprint's with its limits by default: {OWN_FILE_HELP}; {LIMITED_HELP}.",
    )
    return structure(drive(command))


linear_option = click.option(
    "--linear", is_flag=True, help="Model for small signals, although the fingerprint has the line with its limits."
)
set_option = click.option(
    "--set",
    "given",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    callback=by_name,
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

    Raises FingerprintError if there is none, it names no shipped structure, or it has a parameter that the structure
    lacks; StructureError if there is no such structure or parameter, or a value is missing.
    """
    drive_file = click.get_current_context().meta.get(DRIVE)
    kept, place = any_fingerprint_at(fingerprint), str(fingerprint_file(fingerprint))
    if drive_file is not None or kept.noun == "drive":
        return _drive_to_export(of_a_drive(kept, named=place), structure, given, drive_file)
    identified = of_a_ship(kept, named=place)
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
        source=source_words(identified),
    )


def _drive_to_export(
    kept: DriveFingerprint, structure: TypedName | None, given: Mapping[str, float], drive_file: Path | None
) -> ExportedModel:
    """Return the model of a drive's fingerprint."""
    one = kept_drive(
        kept,
        None if drive_file is None else load_drive(drive_file),
        own=None if structure is None else chosen_structures([structure])[0],
    )
    model = identified_drive(kept, one)
    unknown = [name for name in given if name not in model.structure.names]
    if unknown:
        raise StructureError(
            f"--set {unknown[0]}: expected a parameter of {model.structure.name}, one of "
            f"{', '.join(model.structure.names)}.{meant(unknown[0], model.structure.names)}"
        )
    known = [q.name for q in kept.parameters if np.isfinite(q.std) and q.std > 0.0 and q.name not in given]
    return ExportedModel(
        title=kept.drive,
        structure=model.structure,
        values=frozen_float([given.get(n, v) for n, v in zip(model.structure.names, model.values, strict=True)]),
        uncertain=tuple(known),
        covariance=frozen_float(kept.covariance_of(known)),
        not_known=model.not_known,
        source=source_words(kept),
        units=dict(one.units),
    )


def file_to_write(
    output: Path | None, model: ExportedModel, suffix: str, *, inputs: Sequence[Path | None], force: bool
) -> Path:
    """Return the file to write: the given one, or one in this folder that is named after vessel and structure.

    Raises click.ClickException if it is a folder or an input, its folder does not exist, or it exists and is not to be
    replaced.
    """
    path = output or Path(plain_name(f"{model.title}-{model.structure.name}{suffix}"))
    if not path.suffix:
        # programs know such a file by its ending
        path = path.with_name(f"{path.name}{suffix}")
    expect_no_input(path, *(None if source is None else fingerprint_file(source) for source in inputs))
    expect_free(path, force=force)
    return path
