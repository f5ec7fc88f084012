"""A drive with the structures that a user names, and with what is held and known beside its file."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from shaftprint.bench._equipped import EquippedDrive, equipped
from shaftprint.catalogue._own_structure import TypedName, chosen_structures, own_file
from shaftprint.drive._drive import Drive
from shaftprint.errors import RequestError, SettingsError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.survey._fit_options import FitOptions


def named_drives(
    drive: Drive, names: Sequence[TypedName] = (), options: FitOptions | None = None
) -> tuple[EquippedDrive, ...]:
    """Return a drive with its structure, once for each structure that the user names.

    Parameters
    ----------
    drive
        The drive as its file describes it.
    names
        Structures that the user names: shipped drives, or those of files of the user's own; none for that of the file.
    options
        What the user holds and knows beside the file.

    Raises
    ------
    RequestError
        If an option is asked for that ships alone have.
    """
    chosen = [_named(drive, name) for name in names] or [equipped(drive)]
    if options is None:
        return tuple(chosen)
    if options.unweighted or options.mode == "thesis":
        raise RequestError("--unweighted and --mode are for ships; leave them out beside --drive.")
    structures = options.holding([one.structure for one in chosen])
    return tuple(
        replace(one, structure=structure, priors=_priors(one, options))
        for one, structure in zip(chosen, structures, strict=True)
    )


def _named(drive: Drive, name: TypedName) -> EquippedDrive:
    if own_file(name) is None:
        return equipped(with_named(drive, str(name)))
    (structure,) = chosen_structures([name])
    return equipped(with_named(drive), own=structure)


def with_named(drive: Drive, name: str | None = None) -> Drive:
    """Return the drive with the shipped structure that the user names, or none, instead of its own."""
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


def holding(one: EquippedDrive, held: Mapping[str, float]) -> EquippedDrive:
    """Return a drive with some parameters held at values."""
    priors = {name: prior for name, prior in one.priors.items() if name not in held}
    return replace(one, structure=one.structure.held_at(**held), priors=priors)
