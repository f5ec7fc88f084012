"""The structure of a drive with what its file knows: held parameters, priors, bounds, units of its signals."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from shaftprint.bench._begun import begun
from shaftprint.bench._composed import composed
from shaftprint.bench._sensors import WITHIN, behind_sensors, priors_of_sensors, stated_sensors
from shaftprint.catalogue._drives import DRIVES, SIGNAL_UNITS
from shaftprint.catalogue._linear_drives import along_a_line, unit_along
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.drive._drive import Drive
from shaftprint.drive._signals import KnownParameter, Signal
from shaftprint.errors import SettingsError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure
from shaftprint.spelling import meant
from shaftprint.units import unit_factor


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class EquippedDrive:
    """A drive, the structure that explains it, and what is known of its parameters."""

    drive: Drive
    """The drive as its file describes it."""
    structure: Structure
    """From the inputs of the file to its outputs; what is known exactly is held."""
    priors: Mapping[str, Prior]
    """What is known with a standard deviation, by parameter."""
    factors: Mapping[str, float]
    """What a channel is multiplied by for the unit of the structure, by signal."""
    units: Mapping[str, str]
    """Unit of each signal in the structure."""


def equipped(drive: Drive, *, own: Structure | None = None) -> EquippedDrive:
    """Return a drive with its structure.

    Parameters
    ----------
    drive
        The drive file.
    own
        A structure of the user's, in place of the one that the file names or composes.

    Raises
    ------
    SettingsError
        If the file has no structure, or names signals or parameters that the structure does not have.
    StructureError
        If the blocks of the file make no structure, or a value does not fit its bounds.
    """
    structure = begun(drive, _structure(drive, own))
    units = SIGNAL_UNITS if structure.name in DRIVES else {}
    _expect_signals(drive, structure)
    structure = structure.of_outputs(*(one.name for one in drive.outputs))
    if units and _goes_straight(drive, units):
        structure, units = along_a_line(structure), {name: unit_along(unit) for name, unit in units.items()}
    for known in drive.known:
        structure = _with_known(drive, structure, known)
    for one in drive.searched:
        _expect_parameter(drive, structure, "searched", one.name)
        structure = structure.free_between(**{one.name: (one.lower, one.upper)})
    for row in drive.per_record:
        if _expect_parameter(drive, structure, "per_record", row.name).held:
            raise SettingsError(
                f"drive {drive.name}, per_record: expected a free parameter, found {row.name}, which is held; free it "
                "with [[searched]], or leave it out of [[known]]."
            )
    wanted = {one.name: units.get(one.name, one.unit) for one in drive.signals}
    return EquippedDrive(
        drive=drive,
        structure=behind_sensors(structure, stated_sensors(drive)),
        priors=MappingProxyType(
            {one.name: Prior(one.value, one.std) for one in drive.known if one.std > 0.0} | priors_of_sensors(drive)
        ),
        factors=MappingProxyType({one.name: _factor(drive, one, wanted[one.name]) for one in drive.signals}),
        units=MappingProxyType(wanted),
    )


def _structure(drive: Drive, own: Structure | None) -> Structure:
    if own is not None:
        if drive.structure is not None or drive.blocks:
            raise SettingsError(
                f"drive {drive.name}: expected one structure, found {own.name} beside the one of the drive file; leave "
                "structure and [[blocks]] out of the file, or --structure."
            )
        return own
    if drive.blocks:
        return composed(drive)
    if drive.structure is None:
        raise SettingsError(
            f"drive {drive.name}, structure: expected one of {', '.join(DRIVES)}, [[blocks]] in the file, or "
            "--structure FILE.py:NAME with the command, found none."
        )
    if drive.structure.upper() not in DRIVES:
        raise SettingsError(
            f"drive {drive.name}, structure: expected one of {', '.join(DRIVES)}, found {drive.structure!r}; one of a "
            f"file of your own comes with the command, --structure FILE.py:NAME.{meant(drive.structure, DRIVES)}"
        )
    return shipped_structure(drive.structure)


def _goes_straight(drive: Drive, units: Mapping[str, str]) -> bool:
    """Return whether the signals of a shipped structure are ways and forces, in place of angles and torques.

    Raises SettingsError if some are and others are not.
    """
    turning = [one for one in drive.signals if unit_along(units[one.name]) != units[one.name]]
    straight = [one for one in turning if unit_factor(one.unit, unit_along(units[one.name])) is not None]
    others = [one for one in turning if one not in straight]
    if straight and others:
        raise SettingsError(
            f"drive {drive.name}: expected ways and forces, or angles and torques, of all signals, found "
            f"{straight[0].name} in {straight[0].unit} and {others[0].name} in {others[0].unit}; convert one of them, "
            "by the pinion or screw between, in the recording."
        )
    return bool(straight)


def _expect_signals(drive: Drive, structure: Structure) -> None:
    given = [one.name for one in drive.inputs]
    if set(given) != set(structure.inputs):
        raise SettingsError(
            f"drive {drive.name}, inputs: expected those of {structure.name}, {', '.join(structure.inputs)}, found "
            f"{', '.join(given)}; name a structure with these inputs, or the channels that hold them."
        )
    for one in drive.outputs:
        if one.name not in structure.outputs:
            raise SettingsError(
                f"drive {drive.name}, outputs: expected outputs of {structure.name}, {', '.join(structure.outputs)}, "
                f"found {one.name}.{meant(one.name, structure.outputs)}"
            )


def _expect_parameter(drive: Drive, structure: Structure, table: str, name: str) -> Parameter:
    for parameter in structure.parameters:
        if parameter.name == name:
            return parameter
    raise SettingsError(
        f"drive {drive.name}, {table}: expected a parameter of {structure.name}, one of {', '.join(structure.names)}, "
        f"found {name}.{meant(name, structure.names)}"
    )


def _with_known(drive: Drive, structure: Structure, known: KnownParameter) -> Structure:
    """Return a structure with a parameter held, or free with bounds that hold what is known."""
    parameter = _expect_parameter(drive, structure, "known", known.name)
    if known.unit is not None and known.unit != parameter.unit:
        raise SettingsError(
            f"drive {drive.name}, known {known.name}: expected a value in {parameter.unit}, found {known.unit}; "
            "convert it."
        )
    lower = min(parameter.lower, known.value - WITHIN * known.std)
    upper = max(parameter.upper, known.value + WITHIN * known.std)
    if parameter.lower >= 0.0 and known.value > 0.0:
        lower = max(lower, 0.0)
    changed = replace(parameter, lower=lower, upper=upper, value=known.value, held=known.std == 0.0)
    others = (changed if one.name == known.name else one for one in structure.parameters)
    return replace(structure, parameters=tuple(others))


def _factor(drive: Drive, signal: Signal, wanted: str) -> float:
    factor = unit_factor(signal.unit, wanted)
    if factor is None:
        raise SettingsError(
            f"drive {drive.name}, {signal.name}: expected a unit that can be converted to {wanted}, found "
            f"{signal.unit!r}."
        )
    return factor
