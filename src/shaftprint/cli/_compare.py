"""``shaftprint compare``: two or more fingerprints beside each other."""

from pathlib import Path

import click

from shaftprint.cli._fingerprint_file import FINGERPRINT, REPORT, fingerprint_at
from shaftprint.cli._numbers import plain
from shaftprint.cli._output_folder import force_option, output_folder
from shaftprint.cli._own_structure import OWN_FILE_HELP, TypedName, chosen_structures
from shaftprint.cli._tables import print_table
from shaftprint.fingerprint import Fingerprint
from shaftprint.report import Difference, change_in_words, differences, render_comparison

FEWEST = 2


@click.command("compare")
@click.argument("fingerprints", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--name",
    "names",
    multiple=True,
    metavar="NAME",
    help="What to call a fingerprint, in their order; by default its file or folder.",
)
@click.option(
    "--structure",
    "own",
    multiple=True,
    metavar="NAME",
    help=f"Structure of a fingerprint that is not a shipped one: {OWN_FILE_HELP}.",
)
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for a report on the comparison.")
@force_option
def command(
    fingerprints: tuple[Path, ...], names: tuple[str, ...], own: tuple[TypedName, ...], output: Path | None, force: bool
) -> None:
    """Say what differs between fingerprints, and whether it is more than chance.

    FINGERPRINTS are two or more JSON files, or the folders in which identify or demo has put them. All are
    compared with the first. --name and --structure may be repeated.
    """
    found = _named(fingerprints, names)
    structures = {structure.name: structure for structure in chosen_structures(own)}
    (first_name, first), *others = found.items()
    if output is not None:
        with output_folder(output, of="compare", force=force) as folder:
            render_comparison(folder, found, structures=structures)
    for name, other in others:
        apart = differences(first, other)
        _print_tables(first_name, name, apart)
        doubtful = [said for said, one in ((first_name, first), (name, other)) if not one.verdict.trustworthy]
        answer = f"It cannot be told: not trustworthy: {', '.join(doubtful)}." if doubtful else change_in_words(apart)
        click.echo(f"Has the ship changed? {answer}")
        _print_left_out(apart)
    if output is not None:
        click.echo(f"Report: {output / REPORT}")


def _named(places: tuple[Path, ...], names: tuple[str, ...]) -> dict[str, Fingerprint]:
    if len(places) < FEWEST:
        raise click.UsageError(f"expected two or more fingerprints, found {len(places)}; name another one.")
    if names and len(names) != len(places):
        raise click.UsageError(f"expected a --name for each of {len(places)} fingerprints, found {len(names)}.")
    called = names or tuple(_name(place) for place in places)
    if len(set(called)) < len(called):
        raise click.UsageError(f"expected different names, found {', '.join(called)}; tell them apart with --name.")
    return {name: fingerprint_at(place) for name, place in zip(called, places, strict=True)}


def _name(place: Path) -> str:
    """Return the name of a folder, or that of a file; of ``fingerprint.json`` that of the folder around it."""
    whole = place.resolve()
    return whole.parent.name if whole.name == FINGERPRINT else whole.name.removesuffix(".json")


def _print_tables(first: str, name: str, found: tuple[Difference, ...]) -> None:
    header = ["quantity", first, name, "difference", "95 % interval", "p-value", "outcome"]
    title = f"{name} compared with {first}"
    print_table(title, header, [_row(one) for one in found if not one.normalised])
    moving = [_row(one) for one in found if one.normalised]
    if moving:
        print_table(f"{title}: normalised numbers, which move with the working point", header, moving)


def _print_left_out(found: tuple[Difference, ...]) -> None:
    """Print which numbers were not compared, and why."""
    for reason in dict.fromkeys(_reason(one) for one in found if one.because):
        names = ", ".join(one.first.name for one in found if one.because and _reason(one) == reason)
        click.echo(f"Not compared, {reason}: {names}.")


def _reason(one: Difference) -> str:
    """Return why a number cannot be compared, without which one to see instead."""
    return one.because.partition(";")[0]


def _row(one: Difference) -> list[str]:
    unit = "" if one.first.unit == "-" else f" {one.first.unit}"
    ends = "-" if one.interval_95 is None else " to ".join(plain(end) for end in one.interval_95)
    probability = "-" if one.p_value is None else f"{one.p_value:.2g}"
    values = [f"{plain(quantity.value)}{unit}" for quantity in (one.first, one.other)]
    return [one.first.name, *values, plain(one.value), ends, probability, one.outcome]
