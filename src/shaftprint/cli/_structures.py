"""``shaftprint structures``: the model structures that come with the package."""

import click

from shaftprint.cli._tables import print_table
from shaftprint.models import STRUCTURES, Parameter, Structure, structure


@click.command("structures")
@click.argument("names", metavar="[NAME]...", nargs=-1)
def command(names: tuple[str, ...]) -> None:
    """List the model structures with their parameters and bounds.

    With one or more NAMEs only those. Held parameters keep their value unless they are freed.
    """
    for chosen in [structure(name) for name in names or STRUCTURES]:
        print_table(
            f"{chosen.name}: {chosen.title}, {chosen.input} -> {', '.join(chosen.outputs)}",
            ("parameter", "unit", "lower", "upper", "value", "meaning"),
            [_row(parameter) for parameter in chosen.parameters],
            numbers=(2, 3, 4),
            spare=True,
        )
        _print_combinations(chosen)


def _row(parameter: Parameter) -> tuple[str, ...]:
    value = f"{parameter.value:g}, held" if parameter.held else f"{parameter.value:g}"
    lower, upper = f"{parameter.lower:g}", f"{parameter.upper:g}"
    return parameter.name, parameter.unit, lower, upper, value, parameter.meaning


def _print_combinations(chosen: Structure) -> None:
    for combination in chosen.combinations:
        click.echo(f"  {combination.name} [{combination.unit}]: {combination.meaning}")
    if chosen.combinations:
        click.echo()
