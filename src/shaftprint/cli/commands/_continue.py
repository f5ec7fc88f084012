"""``shaftprint continue``: what is known so far of a planned test, and what is still missing."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.choices import SET_POINT_RATE_HZ
from shaftprint.cli._command_group import NOT_REACHED
from shaftprint.cli._options import OWN_FILE_HELP, vessel_option
from shaftprint.cli._terminal import answer, echo, print_findings
from shaftprint.cli.output._fingerprint_file import REPORT
from shaftprint.cli.output._json import give
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.cli.output._tables import print_tables
from shaftprint.late import late

with late():
    from shaftprint.catalogue._own_structure import TypedName, chosen_structures
    from shaftprint.design.files import _plan_folder
    from shaftprint.design.files._plan_folder import write_plan_files
    from shaftprint.design.files._plan_json import read_plan
    from shaftprint.design.standing._standing import Standing
    from shaftprint.rehearsal._continue import standing_after
    from shaftprint.report.plan._plan_page import render_plan
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._trial import load_trial
    from shaftprint.tables._plan import planned_leg_table, standing_leg_table, standing_table


NEXT = "next"
"""Folder for what is missing, in that of the plan."""


@click.command("continue")
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--plan",
    "place",
    required=True,
    type=click.Path(path_type=Path),
    help="Folder of shaftprint plan, or of an earlier continue.",
)
@vessel_option
@click.option("--campaign", help="Campaign that was sailed, where its file is not the one in the folder of the plan.")
@click.option(
    "--structure", "own", metavar="NAME", help=f"Structure of the plan where it is your own: {OWN_FILE_HELP}."
)
@click.option(
    "--rate",
    "rate_hz",
    type=float,
    default=SET_POINT_RATE_HZ,
    show_default=True,
    help="Samples a second of the set point [Hz].",
)
@click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starts.")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help=f"Folder for what is missing; {NEXT} in the folder of the plan when not given.",
)
@force_option
@no_progress_option
@click.pass_context
def command(
    context: click.Context,
    recording: Path,
    place: Path,
    vessel: str,
    campaign: str | None,
    own: TypedName | None,
    rate_hz: float,
    seed: int,
    output: Path | None,
    force: bool,
    no_progress: bool,
) -> None:
    """Say what is known so far of a planned test, and plan what is still missing.

    RECORDING may end anywhere: whole periods count. Wishes are met by the deviations that are predicted with the
    periods that were recorded. Ends with 3 where no further periods of these lines would meet them.
    """
    test = read_plan(place, structure=None if own is None else chosen_structures([own])[0])
    folder = place if place.is_dir() else place.parent
    trial = load_trial(vessel, str(folder / _plan_folder.CAMPAIGN) if campaign is None else campaign)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, progress=steps)
        steps.begin("Fitting what was recorded so far")
        standing = standing_after(test, measurement, trial, seed=seed)
    target = output or folder / NEXT
    if standing.remaining is not None:
        with output_folder(target, of="continue", force=force) as part:
            write_plan_files(standing.remaining, part, rate_hz=rate_hz)
            render_plan(part, standing.remaining)
    print_standing(standing, target)
    if standing.more is None:
        context.exit(NOT_REACHED)


def print_standing(standing: Standing, folder: Path) -> None:
    """Print what is met, what is missing, and where the next leg is."""
    first, *others = standing.sentences
    answer(first)
    echo()
    print_tables([standing_table(standing), standing_leg_table(standing)])
    if others:
        print_findings("What to know of it", others)
    give("met", standing.is_enough)
    give("ratios", standing.ratios)
    give("recorded_periods", standing.recorded)
    give("missing_periods", standing.more)
    give("noise_ratio", standing.noise_ratio)
    give("parameters", standing.fit.parameters)
    give("combinations", standing.fit.combinations)
    if standing.remaining is not None:
        print_tables([planned_leg_table(standing.remaining)])
        echo(f"Page:      {folder / REPORT}")
        echo(f"Campaign:  {folder / _plan_folder.CAMPAIGN}")
