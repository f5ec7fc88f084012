"""Parameters with a value of their own in each record: the same equations, in which they have other names.

``J`` of a record, or of a group of records, ``brass`` is called ``J(brass)``.
"""

from collections.abc import Mapping, Sequence
from typing import Protocol, TypeVar

from shaftprint.bench._equipped import EquippedDrive
from shaftprint.drive._signals import PerRecord
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._united_parameters import united_parameters
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure


class Named(Protocol):
    """A record, or whatever else stands in for one."""

    @property
    def name(self) -> str:
        """What it is called."""
        ...


OfName = TypeVar("OfName", bound=Named)


def own_name(name: str, label: str) -> str:
    """Return what a parameter is called in a record or group."""
    return f"{name}({label})"


def base_name(name: str) -> str:
    """Return what a parameter is called in the equations."""
    return name.partition("(")[0]


def record_structure(one: EquippedDrive, record: str) -> Structure:
    """Return the structure of a drive for one of its records."""
    names, values = {}, {}
    for row in _rows(one):
        label = row.label(record)
        names[row.name] = own_name(row.name, label)
        if label in row.values:
            values[names[row.name]] = row.values[label]
    return one.structure.renamed(**names).held_at(**values) if names else one.structure


def with_structures(one: EquippedDrive, records: Sequence[OfName]) -> list[tuple[Structure, OfName]]:
    """Return each record with its structure; records of one label share it."""
    made: dict[tuple[str, ...], Structure] = {}
    pairs: list[tuple[Structure, OfName]] = []
    for record in records:
        key = tuple(row.label(record.name) for row in _rows(one))
        if key not in made:
            made[key] = record_structure(one, record.name)
        pairs.append((made[key], record))
    return pairs


def all_parameters(one: EquippedDrive, records: Sequence[Named]) -> tuple[Parameter, ...]:
    """Return the parameters of all records, each once, in the order of a joint fit."""
    return united_parameters([structure for structure, _ in with_structures(one, records)])


def free_parameters(one: EquippedDrive, records: Sequence[Named]) -> tuple[Parameter, ...]:
    """Return those that a joint fit may change."""
    return tuple(parameter for parameter in all_parameters(one, records) if not parameter.held)


def own_priors(one: EquippedDrive, records: Sequence[Named], priors: Mapping[str, Prior]) -> dict[str, Prior]:
    """Return priors, that of a parameter with own values for each of them."""
    called = _names_in_records(one, records)
    free = {parameter.name for parameter in free_parameters(one, records)}
    return {
        name: prior
        for base, prior in priors.items()
        for name in called.get(base, [base])
        if name in free or base not in called
    }


def own_names(one: EquippedDrive, names: set[str], records: Sequence[Named]) -> set[str]:
    """Return names of parameters, those that have own values by each of their names."""
    called = _names_in_records(one, records)
    return {name for base in names for name in called.get(base, [base])}


def _names_in_records(one: EquippedDrive, records: Sequence[Named]) -> dict[str, list[str]]:
    """Return what each parameter with own values is called in the records, each name once."""
    return {
        row.name: list(dict.fromkeys(own_name(row.name, row.label(record.name)) for record in records))
        for row in _rows(one)
    }


def idle_labels(one: EquippedDrive, records: Sequence[Named]) -> tuple[str, ...]:
    """Return, in a sentence each, records that rows of the drive file name and that are not there."""
    sentences = []
    for row in _rows(one):
        labels = {row.label(record.name) for record in records}
        idle = [name for name in dict.fromkeys([*row.values, *row.groups]) if name not in labels]
        if idle:
            sentences.append(f"[[per_record]] {row.name} names {', '.join(idle)}, of which no record was given.")
    return tuple(sentences)


def _rows(one: EquippedDrive) -> list[PerRecord]:
    """Return the rows whose parameter is free: what is held is held in all records alike."""
    free = {parameter.name for parameter in one.structure.free}
    return [row for row in one.drive.per_record if row.name in free]
