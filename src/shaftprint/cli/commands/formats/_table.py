"""The formats of ``shaftprint export`` that need no options of their own: one row each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import click

from shaftprint.cli._options import OWN_FILE_HELP
from shaftprint.cli._terminal import answer, say
from shaftprint.cli.commands._export import FORMATS
from shaftprint.cli.commands.formats._exported import (
    file_to_write,
    fingerprint_argument,
    force_option,
    linear_option,
    model_to_export,
    set_option,
    structure_option,
)
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.late import late

with late():
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.export._csv import write_csv
    from shaftprint.export._json import write_json
    from shaftprint.export._model import ExportedModel, exported_model
    from shaftprint.export._osp import write_osp
    from shaftprint.export._ssp import write_ssv
    from shaftprint.export.modelica._write import write_modelica
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.fingerprint._model import structure_to_use
    from shaftprint.models._structure import Structure


Paths = tuple[Path, ...]
_PLACE = "FINGERPRINT is the JSON file, or the folder in which identify or demo has put it."
_NAMED = "named after the vessel by default."


@dataclass(frozen=True, kw_only=True, slots=True)
class Format:
    """A format: what it is, and the verb that writes it."""

    help: str
    """What the command says of itself below its one line, which is in the list of formats, and where the model is."""
    suffix: str
    """Ending of the file where none is named."""
    model: Callable[[ExportedModel, Path, bool], Paths] | None = None
    """Writes a model, with its limits where they were found, and gives the files; whether to replace is told."""
    fingerprint: Callable[[Fingerprint, Structure, Path, bool], Paths] | None = None
    """Writes the numbers of a fingerprint with the structure that was identified."""
    output: str = f"File to write; {_NAMED}"
    """What ``--output`` is."""
    may_be_there: bool = False
    """Whether the file that is named belongs to another format, and stays as it is."""


def _modelica(model: ExportedModel, path: Path, force: bool) -> Paths:
    written = write_modelica(model, path, overwrite=force)
    say(f"package {written.package}: block Line, experiment Step")
    for name in written.late_outputs:
        say(f"{name} comes later than its time stamp in the recording, which lies ahead of what can be known")
    return (written.path,)


def _csv(identified: Fingerprint, chosen: Structure, path: Path, force: bool) -> Paths:
    written = write_csv(identified, path, of=chosen, overwrite=force)
    return (written.parameters, written.combinations, written.response)


TABLE: Mapping[str, Format] = {
    "osp": Format(
        help="The description is written beside the FMU that `shaftprint export fmu` writes, as "
        "name_OspModelDescription.xml.",
        suffix=".fmu",
        model=lambda model, path, force: (write_osp(model, path, overwrite=force),),
        output=f"FMU that it belongs to, which need not exist yet; {_NAMED}",
        may_be_there=True,
    ),
    "ssp": Format(
        help="The names are those of the FMU's parameters, so that the set can be given to it in a system structure.",
        suffix=".ssv",
        model=lambda model, path, force: (write_ssv(model, path, overwrite=force),),
    ),
    "modelica": Format(
        help="The package needs no library; its block Line has inputs and outputs in rpm and N m about the "
        "working point, and Step is an experiment with it.",
        suffix=".mo",
        model=_modelica,
    ),
    "csv": Format(
        help="Columns are set apart by commas, numbers have points, and an empty cell is not known.",
        suffix=".csv",
        fingerprint=_csv,
        output="Beginning of the names, as in tug.csv; " + _NAMED,
    ),
    "json": Format(
        help="The file is for programs that know nothing of shaftprint; what is not known is null.",
        suffix=".model.json",
        fingerprint=lambda identified, chosen, path, force: (write_json(identified, path, of=chosen, overwrite=force),),
    ),
}


def format_command(name: str) -> click.Command:
    """Return the command of a row of the table."""
    row = TABLE[name]
    output_option = click.option("-o", "--output", type=click.Path(path_type=Path), help=row.output)
    if row.model is not None:
        command = structure_option(linear_option(set_option(output_option(force_option(_of_model(row))))))
    else:
        identified_option = click.option(
            "--structure", metavar="NAME", help=f"Structure that was identified, if it is not shipped: {OWN_FILE_HELP}."
        )
        command = identified_option(output_option(force_option(_of_fingerprint(row))))
    return click.command(name, help=f"{FORMATS[name]}\n\n{_PLACE} {row.help}")(fingerprint_argument(command))


def _of_model(row: Format) -> Callable[..., None]:
    def command(
        fingerprint: Path,
        structure: TypedName | None,
        linear: bool,
        given: Mapping[str, float],
        output: Path | None,
        force: bool,
    ) -> None:
        model = model_to_export(fingerprint, structure, given, linear=linear)
        path = file_to_write(output, model, row.suffix, inputs=(fingerprint,), force=force or row.may_be_there)
        assert row.model is not None  # noqa: S101 - a row of models
        for written in row.model(model, path, force):
            answer(written)

    return command


def _of_fingerprint(row: Format) -> Callable[..., None]:
    def command(fingerprint: Path, structure: TypedName | None, output: Path | None, force: bool) -> None:
        identified = fingerprint_at(fingerprint)
        chosen = structure_to_use(structure, identified)
        model = exported_model(identified, of=chosen)
        path = file_to_write(output, model, row.suffix, inputs=(fingerprint,), force=force)
        assert row.fingerprint is not None  # noqa: S101 - a row of fingerprints
        for written in row.fingerprint(identified, chosen, path, force):
            answer(written)

    return command
