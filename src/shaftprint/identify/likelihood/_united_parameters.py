"""The parameters of several structures: those of one name are one parameter."""

from collections.abc import Sequence

from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import IdentificationError
from shaftprint.models._parameter import Parameter
from shaftprint.models._structure import Structure

# Held parameters of these roles belong to the pick-up of an experiment: they may differ from one to the other.
OF_PICK_UP = (ShipRole.PICK_UP_AVERAGE, ShipRole.PICK_UP_HOLD, ShipRole.PICK_UP_DELAY)


def united_parameters(structures: Sequence[Structure]) -> tuple[Parameter, ...]:
    """Return the independent parameters of all structures, each once, those of the first structure first.

    Raises IdentificationError if two structures describe a parameter differently.
    """
    united: dict[str, tuple[Parameter, Structure]] = {}
    for structure in structures:
        for parameter in structure.parameters:
            first, owner = united.setdefault(parameter.name, (parameter, structure))
            if _described(first) != _described(parameter):
                raise IdentificationError(
                    f"joint fit: parameter {first.name} is {_words(first)} in structure {owner.name} and "
                    f"{_words(parameter)} in {structure.name}; describe it alike, or give one of them another name."
                )
    tied = {tie.name: structure for structure in structures for tie in structure.ties}
    both = [name for name in tied if name in united]
    if both:
        raise IdentificationError(
            f"joint fit: parameter {both[0]} is tied to others in structure {tied[both[0]].name} and a parameter of "
            f"its own in {united[both[0]][1].name}; tie it in both, or give one of them another name."
        )
    return tuple(parameter for parameter, _ in united.values())


def _described(parameter: Parameter) -> tuple[object, ...]:
    """Return what must be the same for two parameters to be one."""
    if parameter.held:
        return (parameter.unit, None if parameter.role in OF_PICK_UP else parameter.value)
    return (parameter.unit, parameter.lower, parameter.upper)


def _words(parameter: Parameter) -> str:
    if parameter.held:
        return f"held at {parameter.value} {parameter.unit}"
    return f"free from {parameter.lower} to {parameter.upper} {parameter.unit}"
