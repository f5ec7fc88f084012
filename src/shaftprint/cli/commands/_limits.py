"""``shaftprint limits``: which limits a line has, and how large they are."""

from __future__ import annotations

from pathlib import Path

import click

from shaftprint.cli._limit_tables import print_limits, print_line
from shaftprint.cli._options import campaign_option, vessel_option
from shaftprint.cli._results import print_paths, write_results
from shaftprint.cli._terminal import say
from shaftprint.cli._validation_tables import print_validation
from shaftprint.cli.output._output_folder import force_option, output_folder
from shaftprint.cli.output._progress import no_progress_option, progress
from shaftprint.late import late

with late():
    import numpy as np

    from shaftprint.limits._identify_limits import identify_limits
    from shaftprint.survey._limits import with_limits
    from shaftprint.survey._measurement import measure
    from shaftprint.survey._survey import judged, run
    from shaftprint.survey._trial import Trial, load_trial


# As for ``identify``.
SEED = 1


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
    excludes it. With --output the line is identified too: limits and line are one model, which exports take.
    """
    trial = load_trial(vessel, campaign)
    if output is not None:
        _identify(recording, trial, output, force=force, no_progress=no_progress)
        return
    with progress(hidden=no_progress) as steps:
        measurement = measure(recording, trial, mode="shaftprint", progress=steps)
        limits = identify_limits(measurement.signals, trial.campaign, trial.vessel, progress=steps.tell)
    print_limits(limits)


def _identify(recording: Path, trial: Trial, output: Path, *, force: bool, no_progress: bool) -> None:
    """Write the fingerprint of a line with its limits, validated with them, and its report."""
    rng = np.random.default_rng(SEED)
    with output_folder(output, of="limits", force=force) as folder:
        with progress(hidden=no_progress) as steps:
            survey = with_limits(
                run(
                    recording, trial.vessel, trial.campaign, sources=trial.sources, rng=rng, judge=False, progress=steps
                ),
                progress=steps,
            )
        if survey.limit_fit is not None:
            print_limits(survey.limit_fit)
        if survey.fingerprint.with_limits is not None:
            print_line(survey.fingerprint.with_limits)
        with progress(hidden=no_progress) as steps:
            survey = judged(survey, rng=rng, progress=steps)
        for remark in survey.remarks:
            say(remark)
        for validation in survey.validations:
            print_validation(validation)
        with progress(hidden=no_progress) as steps:
            write_results(folder, recording, survey, steps=steps)
    print_paths(output)
