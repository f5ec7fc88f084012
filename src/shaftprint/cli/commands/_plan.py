"""``shaftprint plan``: the strongest test within a time, or the shortest that meets the wishes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import click

from shaftprint.choices import SET_POINT_RATE_HZ, STATED_LIMITS
from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._drive_options import drive_option, expect_not_given, is_given
from shaftprint.cli._drive_plan import plan_on_the_bench
from shaftprint.cli._known_values import by_name, named_value
from shaftprint.cli._next import free, print_next
from shaftprint.cli._option_sections import SectionedCommand
from shaftprint.cli._options import DEFAULT_HELP, OWN_FILE_HELP, vessel_option
from shaftprint.cli._plan_options import limit_of, seconds_of, shares_of, wish_from, wish_of
from shaftprint.cli._ship_options import known_options
from shaftprint.cli._terminal import answer, details, echo, is_detailed, print_findings, say
from shaftprint.cli._vessel_file import checked_vessel
from shaftprint.cli.output._fingerprint_file import REPORT, fingerprint_of
from shaftprint.cli.output._json import give
from shaftprint.cli.output._progress import Steps
from shaftprint.cli.output._results_options import Results, results_options
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.catalogue._own_structure import TypedName
    from shaftprint.design.files import _plan_folder, _plan_json, _set_point_files
    from shaftprint.design.files._plan_folder import write_plan_files
    from shaftprint.design.inputs._stated_limits import StatedLimit
    from shaftprint.design.inputs._wish import Wish
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.design.planning._from_knowledge import plan_test
    from shaftprint.design.views._abort_card import abort_card
    from shaftprint.forecast._knowledge import knowledge_of
    from shaftprint.forecast._ship_before_test import ShipBeforeTest
    from shaftprint.rehearsal._rehearse import rehearse_on_tug
    from shaftprint.report.plan._plan_page import render_plan
    from shaftprint.tables._plan import abort_table, planned_leg_table, predicted_number_table, wish_table
    from shaftprint.vessel._vessel import Vessel


LONGEST_S = 3600.0
_OF_SHIPS = (
    "vessel", "is_shortest", "stairs", "limits", "speeds", "offset_v", "noise_from", "noise_campaign", "rehearsals",
    "name", "seed", "slope_rpm_per_v", "freed",
)  # fmt: skip


@click.command(
    "plan",
    cls=SectionedCommand,
    example="shaftprint plan --vessel mine.toml --within 12min --limit set-point=0.7mA -o my_plan\n"
    "shaftprint plan --vessel mine.toml --within 12min --limit set-point=1.0V --wish t_d=20% --wish K_p=6% -o my_plan",
    sections={
        "Needed (a ship: --vessel and --limit set-point; a drive: --drive)": (
            "--vessel", "--limit", "--output", "--drive",
        ),
        "Test": ("--within", "--wish", "--shortest", "--staircase", "--name"),
        "Lever and limits": ("--rpm-per-volt", "--offset", "--speeds"),
        "What is known of the ship": (
            "--after", "--noise-from", "--noise-campaign", "--structure", "--prior", "--free", "--hold", "--value",
        ),
        "Rehearsal and set-point file": ("--rehearse", "--rate", "--seed"),
        "With --drive": ("--noise", "--at"),
    },
)  # fmt: skip
@drive_option
@vessel_option
@click.option(
    "--structure",
    "structure_name",
    metavar="NAME",
    help=f"Model structure: {OWN_FILE_HELP}. By default that of --after, or {DEFAULT_HELP}.",
)
@click.option(
    "--wish",
    "wishes",
    metavar="NAME=STD",
    type=wish_of,
    multiple=True,
    help="Standard deviation with which a number is to be known, as t_d=10% or, in its own unit, g=0.05; `shaftprint "
    "structures` has the names.",
)
@click.option("--within", "within_s", metavar="TIME", type=seconds_of, help="Length of the test, such as 12min.")
@click.option(
    "--shortest", "is_shortest", is_flag=True, help="Look for the shortest test, of at most --within or an hour."
)
@click.option(
    "--staircase/--no-staircase",
    "stairs",
    default=None,
    help="End with a minute of steps, which validate and limits need; by default a test of 5 min and more does.",
)
@click.option(
    "--limit",
    "limits",
    metavar="NAME=VALUE",
    type=limit_of,
    multiple=True,
    help="Limit, such as set-point=1.0V (or in rpm, or in mA, % or counts of the lever) or rate=600rpm/s; one of "
    f"{', '.join(STATED_LIMITS)}.",
)
@click.option(
    "--speeds",
    metavar="SHARE,...",
    type=shares_of,
    help="Speeds of the legs over that of the working point, such as 1.1,0.8; by default as far apart as limits allow, "
    "within 1.15,0.78.",
)
@click.option("--offset", "offset_v", type=float, help="Set point that asks for the speed of the working point [V].")
@click.option(
    "--after", type=click.Path(path_type=Path), help="Fingerprint of a first test: its values with their covariance."
)
@click.option("--noise-from", type=click.Path(path_type=Path), help="Recording of the ship, for its noise.")
@click.option("--noise-campaign", metavar="CAMPAIGN", help="Campaign of that recording.")
@click.option(
    "--noise",
    "noise",
    metavar="NAME=STD",
    type=named_value,
    multiple=True,
    callback=by_name,
    help="With --drive: noise of one sample of an output; that of --after when not given.",
)
@click.option(
    "--at",
    "at",
    metavar="NAME=VALUE",
    type=named_value,
    multiple=True,
    callback=by_name,
    help="With --drive: middle of the input that is moved, or what another one is held at.",
)
@known_options
@click.option(
    "--rehearse",
    "rehearsals",
    type=click.IntRange(min=0),
    default=0,
    show_default=True,
    help="Simulate so many raw recordings of the assumed ship and identify them: seconds each.",
)
@click.option(
    "--rate",
    "rate_hz",
    type=float,
    default=SET_POINT_RATE_HZ,
    show_default=True,
    help="Samples a second of the set point, or with --drive of the record [Hz].",
)
@click.option("--name", help="Name of the test.")
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of all randomness.")
@results_options("Folder for the plan.")
@click.pass_context
def command(
    context: click.Context,
    drive_file: Path | None,
    vessel: str,
    structure_name: TypedName | None,
    wishes: tuple[tuple[str, float, bool], ...],
    within_s: float | None,
    is_shortest: bool,
    stairs: bool | None,
    limits: tuple[StatedLimit, ...],
    speeds: tuple[float, ...] | None,
    offset_v: float | None,
    after: Path | None,
    noise_from: Path | None,
    noise_campaign: str | None,
    noise: Mapping[str, float],
    at: Mapping[str, float],
    known: ShipBeforeTest,
    rehearsals: int,
    rate_hz: float,
    name: str | None,
    seed: int,
    results: Results,
) -> None:
    """Plan the strongest test within a time, or the shortest that meets your wishes.

    Writes campaign, set point, plan and a page into a folder. Ends with exit code 3 where the wishes cannot be met;
    the best plan that can be reached is written then. --wish, --limit, --prior, --free, --hold and --value may be
    repeated. With --drive, the input of a bench's record is planned, under the limits that stand in the drive file;
    --noise and --at may be repeated.
    """
    wish = wish_from(wishes)
    if drive_file is not None:
        expect_not_given(*_OF_SHIPS)
        rate = rate_hz if is_given("rate_hz") else None
        enough = plan_on_the_bench(
            drive_file, structure_name, wish, known, results,
            within_s=within_s, rate_hz=rate, noise=noise, at=at, after=after,
        )  # fmt: skip
        if not enough:
            context.exit(NOT_REACHED)
        return
    if noise or at:
        raise click.UsageError("--noise and --at need --drive.")
    _expect_a_goal(wish, within_s, is_shortest=is_shortest)
    installation = checked_vessel(vessel)
    ship = replace(
        known,
        vessel=installation,
        first_test=fingerprint_of(installation, after),
        recording=noise_from,
        recorded=noise_campaign,
        offset_v=offset_v,
    )
    with results.folder("plan") as folder, results.progress() as steps:
        planned = plan_test(
            knowledge_of(
                ship, limits=limits, speeds=speeds, structure=structure_name, within_s=within_s, progress=steps
            ),
            wish,
            name=name or f"Planned test of {installation.name}",
            within_s=within_s or LONGEST_S,
            is_shortest=is_shortest,
            stairs=stairs,
            now=datetime.now(UTC).replace(microsecond=0),
            seed=seed,
            tell=lambda words: steps.tell("Planning", words),
        )
        planned = _rehearsed(planned, installation, rehearsals, seed, steps)
        write_plan_files(planned, folder, rate_hz=rate_hz)
        render_plan(folder, planned)
    print_planned_test(planned, results.output)
    # on board the recording of the real test takes the place of the simulated one
    print_next("sail", vessel, results.output / _plan_folder.CAMPAIGN, "-o", free("sailed.nc"), label="Next, tried:")
    if wish.names and not planned.plan.is_enough:
        context.exit(NOT_REACHED)


def _expect_a_goal(wish: Wish, within_s: float | None, *, is_shortest: bool) -> None:
    if within_s is None and not is_shortest:
        raise click.UsageError("expected --within, such as --within 12min, or --shortest with a --wish.")
    if is_shortest and not wish.names:
        raise click.UsageError("--shortest needs a --wish, such as --wish t_d=10%: every longer test knows more.")


def _rehearsed(planned: PlannedTest, vessel: Vessel, count: int, seed: int, steps: Steps) -> PlannedTest:
    if count == 0:
        return planned
    return replace(planned, rehearsal=rehearse_on_tug(planned, vessel, count=count, first_seed=seed, progress=steps))


def print_planned_test(planned: PlannedTest, folder: Path) -> None:
    """Print what a planned test reaches.

    ``planned``: the test. ``folder``: where its files are.
    """
    first, *others = planned.sentences
    answer(first)
    echo()
    card = abort_card(planned)
    print_tables([wish_table(planned), abort_table(card)])
    print_findings("What to know of it", [*others, f"Planned with the {planned.noise_source}."])
    with details():
        print_tables([predicted_number_table(planned), planned_leg_table(planned)])
    if not is_detailed():
        say("What it would tell of each number, and its legs: --verbose, or the page.\n")
    give("duration_s", planned.campaign.duration_s)
    give("rehearsed", planned.rehearsal is not None)
    give("met", planned.plan.is_enough)
    give("predicted", list(planned.plan.promised.values()))
    give("wished_std", planned.plan.targets)
    give("remedies", planned.remedies)
    give("card", card)
    echo(f"Page:      {folder / REPORT}")
    echo(f"Campaign:  {folder / _plan_folder.CAMPAIGN}")
    files = (_set_point_files.CSV, _set_point_files.GENERATOR, _set_point_files.MAT)
    echo(f"Set point: {', '.join(str(folder / name) for name in files)}")
    echo(f"Plan:      {folder / _plan_json.PLAN}")
