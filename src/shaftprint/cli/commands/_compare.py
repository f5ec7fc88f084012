"""``shaftprint compare``: two or more fingerprints beside each other."""

from __future__ import annotations

from pathlib import Path, PurePath

import click

from shaftprint.cli._command_group import end_with_no
from shaftprint.cli._load_option import load_repeatability_option
from shaftprint.cli._options import OWN_FILE_HELP
from shaftprint.cli._terminal import answer, echo, say
from shaftprint.cli.output._fingerprint_file import FINGERPRINT, REPORT, any_fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late
from shaftprint.spelling import listed

with late():
    from shaftprint.catalogue._own_structure import TypedName, chosen_structures
    from shaftprint.drift._differ import differ
    from shaftprint.drift._finding import Finding
    from shaftprint.drift._shared_errors import are_two_lines
    from shaftprint.drift._words import finding_sentences
    from shaftprint.fingerprint._design import differences_of_design, in_short
    from shaftprint.fingerprint._json_file import of_a_ship
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.report._comparison import render_comparison
    from shaftprint.report.comparison._cause_table import cause_table
    from shaftprint.report.comparison._differences import Difference, differences
    from shaftprint.report.comparison._tables import beside_table, difference_table, stated_table
    from shaftprint.report.comparison._vessel_file_words import vessel_file_sentences
    from shaftprint.report.sections._comparison_cover import change_in_words


FEWEST = 2
PERCENT = 100.0


@click.command("compare")
@click.argument("fingerprints", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--name",
    "names",
    multiple=True,
    metavar="NAME",
    help="What to call a fingerprint, in their order; by default its file or folder, and of those alike the path too.",
)
@click.option(
    "--structure",
    "own",
    multiple=True,
    metavar="NAME",
    help=f"Structure of a fingerprint that is not a shipped one: {OWN_FILE_HELP}.",
)
@load_repeatability_option
@click.option("--each-number", is_flag=True, help="Judge each number by itself, not all of them along causes.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="Folder for a report on the comparison.")
@force_option
def command(
    fingerprints: tuple[Path, ...],
    names: tuple[str, ...],
    own: tuple[TypedName, ...],
    load_percent: float,
    each_number: bool,
    output: Path | None,
    force: bool,
) -> None:
    """Compare fingerprints: what differs, and whether by more than chance.

    FINGERPRINTS are two or more JSON files, or the folders in which identify or demo has put them. All are
    compared with the first. --name and --structure may be repeated. Fingerprints of a drive are known as such. Of ships
    of two designs the numbers stand beside each other, without causes, and the code is 3.
    """
    named = _named(fingerprints, names)
    structures = {structure.name: structure for structure in chosen_structures(own)}
    load = load_percent / PERCENT
    (first_name, first), *others = named.items()
    ships = {name: of_a_ship(one, named=name) for name, one in named.items() if one.noun == "ship"}
    if ships and len(ships) < len(named):
        raise click.UsageError("expected fingerprints of ships, or of drives, found both.")
    if output is not None:
        if not ships:
            raise click.UsageError("--output is for ships; fingerprints of a drive are compared on the terminal.")
        with output_folder(output, of="compare", force=force) as folder:
            render_comparison(folder, ships, structures=structures, load_repeatability=load)
    designs = {name: differences_of_design(first.stated_fields, other.stated_fields) for name, other in others}
    apart = {name: differences(first, other, load_repeatability=load) for name, other in others}
    along = {} if each_number else {name: differ(first, other, load_repeatability=load) for name, other in others}
    for name, other in others:
        doubtful = [label for label, one in ((first_name, first), (name, other)) if not one.verdict.trustworthy]
        words = _judged(apart[name], along.get(name), first.noun)
        if designs[name]:
            answer(
                f"{first_name} and {name}: {in_short(designs[name])}: {listed([one.both for one in designs[name]])}. "
                "What differs is their design, and no cause is looked for."
            )
            continue
        if doubtful:
            words = f"It cannot be told: not trustworthy: {', '.join(doubtful)}."
        lines = are_two_lines(first, other)
        two = "" if lines or first.title == other.title else f"Of {first.title} and {other.title}: "
        other_than = f"{'is' if two else 'Is'} {name} other than {first_name}"
        asked = other_than if two or lines else f"Has the {first.noun} changed"
        answer(f"{two}{asked}{f', {name}' if len(others) > 1 else ''}? {words}")
    give("differences", apart)
    give("causes", along)
    give("designs", designs)
    give("conditions", {name: fingerprint.tested for name, fingerprint in named.items()})
    for name, other in others:
        if name in along and not along[name].because:
            print_tables([cause_table(name, along[name])])
        if not designs[name]:
            _print_tables(first_name, name, apart[name])
            for sentence in vessel_file_sentences(first, other):
                say(sentence)
    if any(designs.values()):
        print_tables(beside_table(ships))
    stated = stated_table(ships)
    if stated.rows:
        print_tables([stated])
    if output is not None:
        echo(f"Report: {output / REPORT}")
    if any(designs.values()):
        end_with_no()


def _judged(found: tuple[Difference, ...], finding: Finding | None, noun: str) -> str:
    """Return whether the ship has changed: along causes, or number by number where that was asked for or must do."""
    if finding is None:
        return change_in_words(found)
    if finding.because:
        return f"{change_in_words(found)} Judged number by number: {finding.because}."
    return " ".join(finding_sentences(finding, noun))


def _named(places: tuple[Path, ...], names: tuple[str, ...]) -> dict[str, LineFingerprint]:
    return {name: any_fingerprint_at(path) for name, path in zip(_called(places, names), places, strict=True)}


def _called(places: tuple[Path, ...], names: tuple[str, ...]) -> tuple[str, ...]:
    """Return what fingerprints are called, each by a name of its own."""
    if len(places) < FEWEST:
        raise click.UsageError(f"expected two or more fingerprints, found {len(places)}; name another one.")
    if names and len(names) != len(places):
        raise click.UsageError(f"expected a --name for each of {len(places)} fingerprints, found {len(names)}.")
    called = names or _short_names(places)
    if len(set(called)) < len(called):
        raise click.UsageError(f"expected different names, found {', '.join(called)}; tell them apart with --name.")
    return called


def _short_names(places: tuple[Path, ...]) -> tuple[str, ...]:
    """Return the names of the folders or files, and where they are alike so much of the path that they are not.

    ``fingerprint.json`` is called by the folder around it.
    """
    parts = [_parts(path) for path in places]
    counts = [1] * len(parts)
    while True:
        names = [PurePath(*path_parts[-count:]).as_posix() for path_parts, count in zip(parts, counts, strict=True)]
        rows = zip(names, parts, counts, strict=True)
        alike = [names.count(name) > 1 and count < len(path_parts) for name, path_parts, count in rows]
        if not any(alike):
            return tuple(names)
        counts = [count + more for count, more in zip(counts, alike, strict=True)]


def _parts(place: Path) -> tuple[str, ...]:
    path = place.resolve()
    folder = path.parent if path.name == FINGERPRINT else path.with_name(path.name.removesuffix(".json"))
    return folder.parts


def _print_tables(first: str, name: str, compared: tuple[Difference, ...]) -> None:
    groups = [[one for one in compared if one.normalised == normalised] for normalised in (False, True)]
    print_tables([difference_table(first, name, group) for group in groups if group])
