"""``shaftprint service watch``: whether a line changes from day to day."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._options import vessel_option
from shaftprint.cli._terminal import answer
from shaftprint.cli.output._fingerprint_file import fingerprint_at
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late
from shaftprint.plain_table import Column, Table

with late():
    from shaftprint.fingerprint._design import expect_fingerprint_of
    from shaftprint.service._watch import Along, Watch, watch_folders
    from shaftprint.vessel._vessel import load_vessel


@click.command("watch")
@click.argument("days", nargs=-1, required=True, type=click.Path(path_type=Path))
@vessel_option
@click.option(
    "--against",
    required=True,
    type=click.Path(path_type=Path),
    help="The fingerprint from which the days were fitted; it is of none of them.",
)
@click.option(
    "--alarms",
    type=click.FloatRange(0.01, 50.0),
    default=1.0,
    show_default=True,
    help="False alarms a year that an unchanged line may give, if it is looked at every day.",
)
@click.pass_context
def command(context: click.Context, days: tuple[Path, ...], *, vessel: str, against: Path, alarms: float) -> None:
    """Say whether the line changes from day to day.

    DAYS are folders of `shaftprint service fit --fingerprint F`, in order of time. They are held against that
    fingerprint along what may have changed, as `shaftprint drift` does with tests. Torque of the propeller hangs on
    draught, trim and water, and alone never gives an alarm. A change that counts ends with code 3 and what it most
    likely is.
    """
    installation = load_vessel(vessel)
    known = fingerprint_at(against)
    expect_fingerprint_of(installation, known, str(against))
    found = watch_folders(days, installation, known, a_year=alarms)
    answer(found.headline)
    give("watch", _as_given(found))
    print_tables([_table(found)])
    if found.propeller:
        answer(found.propeller)
    if found.is_alarm:
        context.exit(NOT_REACHED)


def _as_given(found: Watch) -> dict[str, object]:
    return {
        "days": found.days,
        "alarm": found.is_alarm,
        "limit": found.limit,
        "alarms_a_year": found.a_year,
        "first": found.first,
        "causes": [_row(one) for one in found.causes],
        "propeller": found.propeller,
    }


def _row(one: Along) -> dict[str, object]:
    return {
        "cause": one.cause.name,
        "size": one.cause.in_unit(one.size),
        "std": one.cause.in_unit(one.std),
        "unit": one.cause.unit,
        "z": one.z,
        "days": one.days,
    }


def _table(found: Watch) -> Table:
    """Return the largest change along each cause."""
    return Table(
        title=f"Along what may have changed; {found.limit:.2g} deviations count",
        columns=(
            Column("cause"), Column("change", number=True), Column("+/-", number=True), Column("unit"),
            Column("deviations", number=True), Column("since"),
        ),
        rows=tuple(
            (
                one.cause.name, f"{one.cause.in_unit(one.size):+.2g}", f"{one.cause.in_unit(one.std):.2g}",
                one.cause.unit, f"{one.z:+.1f}", found.days[-one.days],
            )
            for one in found.causes
        ),
    )  # fmt: skip
