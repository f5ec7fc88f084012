"""``shaftprint structures``: the model structures that come with the package, and the user's own."""

from __future__ import annotations

import click

from shaftprint.cli._terminal import echo, say
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_table
from shaftprint.late import late
from shaftprint.plain_table import MEANING, Symbol, Table, numbers, texts

with late():
    from shaftprint.catalogue import _drives, _own_structure, _thesis
    from shaftprint.catalogue._own_structure import chosen_structures
    from shaftprint.models._parameter import Parameter
    from shaftprint.models._structure import Structure


@click.command("structures")
@click.argument("names", metavar="[NAME]...", nargs=-1)
def command(names: tuple[_own_structure.TypedName, ...]) -> None:
    """List the model structures with their parameters, meanings and bounds.

    With one or more NAMEs only those. A NAME such as my_ship.py:my_loop is a structure in a file of your
    own, which is Python and is run. Held parameters keep their value unless they are freed.
    """
    structures = chosen_structures(
        names or tuple(map(_own_structure.TypedName, (*_thesis.STRUCTURES, *_drives.DRIVES)))
    )
    give("parameters", {chosen.name: chosen.parameters for chosen in structures})
    for chosen in structures:
        print_table(_parameter_table(chosen))
        _print_combinations(chosen)


def _parameter_table(chosen: Structure) -> Table:
    return Table(
        title=f"{chosen.name}: {chosen.title}, {', '.join(chosen.inputs)} -> {', '.join(chosen.outputs)}",
        columns=(*texts("parameter", "unit"), *numbers("lower", "upper", "value"), MEANING),
        rows=tuple(_row(parameter) for parameter in chosen.parameters),
    )


def _row(parameter: Parameter) -> tuple[str, ...]:
    value = f"{parameter.value:g}, held" if parameter.held else f"{parameter.value:g}"
    lower, upper = f"{parameter.lower:g}", f"{parameter.upper:g}"
    return Symbol(parameter.name), parameter.unit, lower, upper, value, parameter.meaning


def _print_combinations(chosen: Structure) -> None:
    tied = {tie.name: f"; follows from {', '.join(tie.arguments)}" for tie in chosen.ties}
    for combination in chosen.combinations:
        follows = tied.get(combination.name, "")
        say(f"{combination.name} [{combination.unit}]: {combination.meaning}{follows}", indent="  ")
    if chosen.combinations:
        echo()
