"""The option ``--drive`` and what the commands do with it: a drive file in place of vessel and campaign."""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from shaftprint.bench._equipped import EquippedDrive, equipped
from shaftprint.bench._kept import kept_drive
from shaftprint.catalogue._own_structure import TypedName, chosen_structures, own_file
from shaftprint.cli._options import structure_sources
from shaftprint.cli.output._fingerprint_file import fingerprint_file
from shaftprint.drive._drive import Drive, load_drive
from shaftprint.errors import FingerprintError, SettingsError
from shaftprint.files import read_json
from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint, is_of_a_drive, read_drive_fingerprint
from shaftprint.fingerprint._fingerprint import SourceFile
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.survey._fit_options import FitOptions


def drive_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the option ``--drive``; where it is given, vessel and campaign are not needed."""
    return click.option(
        "--drive",
        "drive_file",
        type=click.Path(path_type=Path),
        is_eager=True,
        help="Drive file of a line that is no ship's, in place of --vessel and --campaign.",
    )(command)


def is_given(option: str) -> bool:
    """Return whether the user gave an option, or left it at its usual value."""
    source = click.get_current_context().get_parameter_source(option)
    return source not in (ParameterSource.DEFAULT, None)


def expect_not_given(*options: str) -> None:
    """Refuse options of ships beside ``--drive``.

    Raises
    ------
    click.UsageError
        If one of them was given.
    """
    given = [name for name in options if is_given(name)]
    if given:
        titles = {
            "legs": "leg",
            "records": "record",
            "names": "structure",
            "load_percent": "load-repeatability",
            "foreign": "model",
            "variables": "model-variable",
            "slope_rpm_per_v": "rpm-per-volt",
        }
        title = titles.get(given[0], given[0]).replace("_", "-")
        raise click.UsageError(f"--{title} is for ships; leave it out beside --drive.")


def equipped_drive(
    drive_file: Path, names: Sequence[TypedName], options: FitOptions | None = None
) -> tuple[EquippedDrive, ...]:
    """Return a drive with its structure, once for each structure that the user names.

    Parameters
    ----------
    drive_file
        The drive file.
    names
        Structures that the user names: shipped drives, or those of files of the user's own; none for that of the file.
    options
        What the user holds and knows beside the file.
    """
    drive = load_drive(drive_file)
    chosen = [_named(drive, name) for name in names] or [equipped(drive)]
    if options is None:
        return tuple(chosen)
    if options.unweighted or options.mode == "thesis":
        raise click.UsageError("--unweighted and --mode are for ships; leave them out beside --drive.")
    structures = options.holding([one.structure for one in chosen])
    return tuple(
        replace(one, structure=structure, priors=_priors(one, options))
        for one, structure in zip(chosen, structures, strict=True)
    )


def _named(drive: Drive, name: TypedName) -> EquippedDrive:
    if own_file(name) is None:
        return equipped(_without_structure(drive, str(name)))
    (structure,) = chosen_structures([name])
    return equipped(_without_structure(drive, None), own=structure)


def _without_structure(drive: Drive, name: str | None) -> Drive:
    """Return the drive with the structure that the user names instead of its own."""
    return drive.model_copy(update={"structure": name, "blocks": (), "parameters": ()})


def _priors(one: EquippedDrive, options: FitOptions) -> dict[str, Prior]:
    free = {parameter.name for parameter in one.structure.free}
    known = {**one.priors, **options.priors}
    unknown = [name for name in options.priors if name not in free]
    if unknown:
        raise SettingsError(
            f"--prior {unknown[0]}: expected a free parameter of {one.structure.name}, one of "
            f"{', '.join(sorted(free))}."
        )
    return {name: prior for name, prior in known.items() if name in free and name not in options.freed}


def drive_sources(recordings: Sequence[Path], drive_file: Path, names: Sequence[TypedName]) -> tuple[SourceFile, ...]:
    """Return recordings, drive file and own structures with their hashes."""
    files = [("recording", path) for path in recordings]
    return (
        *(SourceFile.model_validate({"role": role, "name": p.name, "sha256": file_sha256(p)}) for role, p in files),
        SourceFile(role="drive", name=drive_file.name, sha256=file_sha256(drive_file)),
        *structure_sources(names),
    )


def file_sha256(path: Path) -> str:
    """Return the SHA-256 of a file, hexadecimal."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def only_recording(recordings: Sequence[Path]) -> Path:
    """Return the one recording of a ship.

    Raises
    ------
    click.UsageError
        If there are several.
    """
    if len(recordings) > 1:
        raise click.UsageError(
            f"expected one recording of a ship, found {len(recordings)}; files of one logger are put together by "
            "`shaftprint join`, those of several by `shaftprint merge`."
        )
    return recordings[0]


def is_drive_place(place: Path) -> bool:
    """Return whether a fingerprint, named by its file or folder, says that it is of a drive; False where it is none."""
    try:
        _, content = read_json(fingerprint_file(place), noun="fingerprint", where="", error=FingerprintError)
    except FingerprintError:
        # what is wrong with it says whoever reads it
        return False
    return is_of_a_drive(content)


def drive_fingerprint_at(place: Path) -> DriveFingerprint:
    """Return the fingerprint of a drive that is named by its file or folder.

    Raises
    ------
    FingerprintError
        If there is none.
    """
    return read_drive_fingerprint(fingerprint_file(place))


def kept_one(kept: DriveFingerprint, drive_file: Path | None, name: TypedName | None) -> EquippedDrive:
    """Return the drive of a fingerprint: from its file where that is given, with the user's structure where named."""
    own = None if name is None else chosen_structures([name])[0]
    return kept_drive(kept, None if drive_file is None else load_drive(drive_file), own=own)


def holding(one: EquippedDrive, held: Mapping[str, float]) -> EquippedDrive:
    """Return a drive with some parameters held at values."""
    priors = {name: prior for name, prior in one.priors.items() if name not in held}
    return replace(one, structure=one.structure.held_at(**held), priors=priors)
