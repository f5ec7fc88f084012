"""``shaftprint limits``: which limits a line has, and how large they are."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._limit_tables import print_limits
from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli.commands import _identify
from shaftprint.cli.output._output_folder import force_option
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    from shaftprint.limits._identify_limits import identify_limits
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._trial import load_trial


@click.command("limits")
@click.argument("recording", type=click.Path(path_type=Path))
@vessel_option
@campaign_option
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    help="Folder for a fingerprint that holds the limits, validated with them, and its report.",
)
@force_option
@no_progress_option
def command(recording: Path, vessel: str, campaign: str, output: Path | None, force: bool, no_progress: bool) -> None:
    """Find which limits a line has, and their levels and rates with uncertainty.

    Looked for are torque limit, motoring limit, smoke limiter, rate limits of rack and set point, deadband, and a set
    point held between messages or rounded to steps. Of what does not act it says up to which level the recording
    excludes it. With --output it is `identify --with limits`: limits and line are one model, which exports take.
    """
    if output is not None:
        flags = [flag for flag, is_set in (("--force", force), ("--no-progress", no_progress)) if is_set]
        files = ("--vessel", vessel, "--campaign", campaign, "--with", "limits", "--output", str(output))
        with _identify.command.make_context("identify", [str(recording), *files, *flags]) as asked:
            _identify.command.invoke(asked)
        return
    trial = load_trial(vessel, campaign)
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode="shaftprint", progress=steps)
        limits = identify_limits(measurement.signals, trial.campaign, trial.vessel, progress=steps.tell)
    print_limits(limits)
