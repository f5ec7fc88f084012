"""``shaftprint inertia``: inertia and torsional modes by calculation."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._terminal import answer, say
from shaftprint.cli.output._file_to_write import expect_free, expect_no_input
from shaftprint.cli.output._fingerprint_file import fingerprint_at, fingerprint_file
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_table
from shaftprint.digits import plain_letters
from shaftprint.files import written_whole
from shaftprint.late import late

with late():
    from shaftprint.fingerprint._design import expect_fingerprint_of
    from shaftprint.fingerprint._inertia import inertia_beside
    from shaftprint.report.charts._pictures import save_chart
    from shaftprint.report.figures._modes import mode_chart
    from shaftprint.tables._inertia import (
        expected_inertia_table,
        inertia_budget_table,
        mass_table,
        mode_table,
        two_mass_sentence,
        water_table,
    )
    from shaftprint.torsion._expected_inertia import ExpectedInertia, InertiaComparison, expected_inertia
    from shaftprint.torsion._line import torsional_line
    from shaftprint.torsion._modes import Modes, modes
    from shaftprint.torsion._two_masses import two_masses
    from shaftprint.vessel._vessel import Vessel, load_vessel


SUFFIXES = (".svg", ".png", ".pdf")


def picture(context: click.Context, parameter: click.Parameter, path: Path | None) -> Path | None:
    """Return the path of a picture as it was given.

    Raises click.BadParameter if its ending names no kind of picture.
    """
    if path is not None and path.suffix not in SUFFIXES:
        raise click.BadParameter(f"expected a name that ends in {', '.join(SUFFIXES)}, found {path.name}.")
    return path


@click.command("inertia")
@click.argument("vessel")
@click.option(
    "--fingerprint",
    "found",
    type=click.Path(path_type=Path),
    help="A fingerprint of this vessel, or the folder with it, to stand beside the calculation.",
)
@click.option(
    "--modes",
    "drawing",
    type=click.Path(path_type=Path),
    callback=picture,
    help="Where to draw the shapes of the torsional modes: an SVG, PNG or PDF.",
)
@click.option("--force", is_flag=True, help="Replace an earlier picture.")
def command(vessel: str, found: Path | None, drawing: Path | None, force: bool) -> None:
    """Calculate inertia and torsional modes from the vessel file.

    Prints the inertia table referred to the propeller shaft, the sums on either side of the torque gauge, the inertia
    times with where their uncertainty comes from, the entrained water by several methods and, where VESSEL has links
    between its masses, the torsional modes. VESSEL is a path, or the name of a shipped one such as stan-tug-1205.
    """
    if drawing is not None:
        expect_no_input(drawing, Path(vessel), None if found is None else fingerprint_file(found))
        expect_free(drawing, force=force)
    ship = load_vessel(vessel)
    expected, comparisons = _expected(ship, found)
    vibrations = modes(torsional_line(ship)) if ship.links or drawing is not None else None
    if drawing is not None and vibrations is not None:
        _draw(vibrations, drawing)
    _print(ship, expected, comparisons, vibrations)
    if drawing is not None:
        answer(drawing)


def _expected(ship: Vessel, fingerprint_path: Path | None) -> tuple[ExpectedInertia, tuple[InertiaComparison, ...]]:
    if fingerprint_path is None:
        return expected_inertia(ship), ()
    fingerprint = fingerprint_at(fingerprint_path)
    expect_fingerprint_of(ship, fingerprint, str(fingerprint_path))
    if fingerprint.conditions.vessel != ship.name:
        say(f"Mind: the fingerprint is of {fingerprint.conditions.vessel}, the vessel file of {ship.name}.\n")
    return inertia_beside(fingerprint, ship)


def _draw(vibrations: Modes, path: Path) -> None:
    with written_whole(path, overwrite=True) as part:
        save_chart(mode_chart(vibrations), part)


def _print(
    ship: Vessel, expected: ExpectedInertia, comparisons: tuple[InertiaComparison, ...], vibrations: Modes | None
) -> None:
    give("expected", expected)
    give("identified", comparisons)
    tables = (
        mass_table(ship),
        expected_inertia_table(expected, comparisons),
        inertia_budget_table(expected),
        water_table(expected),
    )
    for table in tables:
        if table.rows:
            print_table(table)
    if vibrations is None:
        say("No torsional modes: the vessel file has no [[links]] between its masses.")
        return
    print_table(mode_table(vibrations))
    line = vibrations.line
    if line.gauge is None:
        say("No two masses: the link across the torque gauge is rigid, state the stiffness of the shaft there.")
        return
    driven = line.bodies[int((line.inertia_kg_m2 * (1.0 - line.is_downstream)).argmax())]
    say(f"{plain_letters(two_mass_sentence(two_masses(line, driven=[driven])))}\n")
